//! Kinds of buildings and the robots that drive through them.

use core::f64::consts::TAU;

use ch16_slam2d::local_map::LocalMapConfig;

use super::plan::{BuildingConfig, BuildingPlan, Layout, Rooms};
use super::recording::{Recorder, Recording};
use super::robots::Robot;
use crate::lap::{BuiltInWorld, Drive, DriveConfig, NamedChoice};

/// The building and the scanner of a simulated recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Corridors around a block; half a circle, 361 beams, 80 m.
    Ring,
    /// One corridor with a visit to its rooms; half a circle, 360 beams, 80 m.
    Hallway,
    /// Corridors around a block; the full circle, 360 beams, 30 m.
    Circle,
    /// Corridors around a block of rooms that are all alike; half a circle, 181 beams, 8 m.
    Alike,
    /// The chapter's lap of the Apartment, with its sensor and odometry.
    Lap,
    /// The lap of the ring world, with the same robot.
    RingLap,
}

impl Kind {
    /// Whether it is a lap of the chapter's robot instead of a generated building.
    #[must_use]
    pub fn is_lap(self) -> bool {
        matches!(self, Self::Lap | Self::RingLap)
    }
}

impl NamedChoice for Kind {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::Ring,
            "ring",
            "corridors around a block, 361 beams over half a circle, 80 m",
        ),
        (
            Self::Hallway,
            "hallway",
            "a corridor and its rooms, 360 beams over half a circle, 80 m",
        ),
        (
            Self::Circle,
            "circle",
            "corridors around a block, 360 beams over the full circle, 30 m",
        ),
        (
            Self::Alike,
            "alike",
            "corridors around rooms that are all alike, 181 beams, 8 m",
        ),
        (
            Self::Lap,
            "lap",
            "the chapter's lap of the Apartment, 120 beams over the full circle, 6 m",
        ),
        (
            Self::RingLap,
            "ring-lap",
            "the lap of the ring world, 120 beams over the full circle, 6 m",
        ),
    ];
}

/// Records a drive of the kind's robot through the building of a seed. Returns the defaults for its
/// scanner, too.
#[must_use]
pub fn recorded(kind: Kind, seed: u32) -> (Recording, LocalMapConfig) {
    recorded_by(Robot::Own, kind, seed)
}

/// Like [`recorded`] with another robot; the laps always use the chapter's.
#[must_use]
pub fn recorded_by(driver: Robot, kind: Kind, seed: u32) -> (Recording, LocalMapConfig) {
    let plan = BuildingConfig {
        seed,
        ..BuildingConfig::default()
    };
    let robot = Recorder {
        seed: seed ^ 0x5EED,
        ..Recorder::default()
    };
    let (plan, robot) = match kind {
        Kind::Lap => return with_defaults(lap(BuiltInWorld::Apartment, seed)),
        Kind::RingLap => return with_defaults(lap(BuiltInWorld::Ring, seed)),
        Kind::Ring => (plan, robot),
        Kind::Hallway => (
            BuildingConfig {
                layout: Layout::Hallway,
                extent_m: [38.0, 0.0],
                visited: 0.4,
                ..plan
            },
            Recorder {
                beams: 360,
                ..robot
            },
        ),
        Kind::Circle => (
            plan,
            Recorder {
                beams: 360,
                field_of_view_rad: TAU,
                max_range_m: 30.0,
                ..robot
            },
        ),
        Kind::Alike => (
            BuildingConfig {
                rooms: Rooms::Alike,
                glass: 0.0,
                visited: 0.0,
                ..plan
            },
            Recorder {
                beams: 181,
                max_range_m: 8.0,
                people: 0,
                ..robot
            },
        ),
    };
    with_defaults(Recording::new(
        &BuildingPlan::new(&plan),
        &driver.instead_of(robot),
    ))
}

fn with_defaults(recording: Recording) -> (Recording, LocalMapConfig) {
    // As for recorded logs.
    let config = LocalMapConfig::for_scan(&recording.frames[0].scan);
    (recording, config)
}

/// The drive of `ch16 lap` with this seed.
fn lap(world: BuiltInWorld, seed: u32) -> Recording {
    let drive = DriveConfig {
        seed,
        ..DriveConfig::default()
    };
    Recording::from_drive(&Drive::simulate(&drive.on_course(&world.course())))
}
