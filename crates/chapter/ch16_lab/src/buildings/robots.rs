//! Robots that differ from those of the kinds: another sensor, other odometry, other errors.

use core::f64::consts::{PI, TAU};

use pr_geom::SE2;

use super::recording::{Mounting, Recorder};
use crate::lap::NamedChoice;

/// The robot that drives through a building of some [`Kind`](super::Kind); each but the first differs in one
/// aspect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Robot {
    /// The kind's own robot.
    #[default]
    Own,
    /// 181 beams over half a circle, 80 m.
    Degree,
    /// The same with a range of 8 m.
    Short,
    /// 91 beams over half a circle, 30 m.
    Coarse,
    /// 360 beams over the full circle to 3.5 m, with a range noise of 3 cm.
    Small,
    /// The same with a range of 12 m.
    Spinning,
    /// 682 beams over 240°, 5.6 m.
    Hand,
    /// 1081 beams over 270°, 30 m.
    Fine,
    /// A scan every 3 to 8 cm.
    Often,
    /// A scan every 0.6 to 1 m.
    Seldom,
    /// Odometry with three times the slip and drift.
    Slippery,
    /// Odometry that jumps three times as often.
    Jumpy,
    /// Odometry that drifts by 2° a metre and has no other error.
    Veering,
    /// Odometry that measures 10 % too much.
    Oversized,
    /// A sensor 0.3 m ahead of the axle that looks backwards; the log contains its pose.
    Ahead,
    /// A sensor 0.2 m ahead of the axle; the log lacks its pose.
    UnknownMounting,
    /// One beam in twenty reports a random range in front of the wall.
    Stray,
    /// One beam in five reports 0, NaN or infinity.
    Dropping,
    /// Fifty scans on each spot where the path bends.
    Resting,
    /// Ten people who walk along.
    Crowded,
}

impl NamedChoice for Robot {
    const NAMED: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Own, "own", "the robot of the kind"),
        (Self::Degree, "degree", "181 beams over half a circle, 80 m"),
        (Self::Short, "short", "181 beams over half a circle, 8 m"),
        (Self::Coarse, "coarse", "91 beams over half a circle, 30 m"),
        (
            Self::Small,
            "small",
            "360 beams over the full circle, 3.5 m, off by 3 cm",
        ),
        (
            Self::Spinning,
            "spinning",
            "360 beams over the full circle, 12 m, off by 3 cm",
        ),
        (Self::Hand, "hand", "682 beams over 240°, 5.6 m"),
        (Self::Fine, "fine", "1081 beams over 270°, 30 m"),
        (Self::Often, "often", "a scan every 3 to 8 cm"),
        (Self::Seldom, "seldom", "a scan every 0.6 to 1 m"),
        (
            Self::Slippery,
            "slippery",
            "three times the slip and drift of the odometry",
        ),
        (
            Self::Jumpy,
            "jumpy",
            "odometry that jumps three times as often",
        ),
        (
            Self::Veering,
            "veering",
            "odometry that drifts by 2° a metre, without other errors",
        ),
        (
            Self::Oversized,
            "oversized",
            "odometry that measures 10% too much",
        ),
        (
            Self::Ahead,
            "ahead",
            "a sensor 0.3 m ahead of the axle that looks back",
        ),
        (
            Self::UnknownMounting,
            "untold",
            "a sensor 0.2 m ahead whose pose the log lacks",
        ),
        (
            Self::Stray,
            "stray",
            "one beam in twenty with a random range in front of the wall",
        ),
        (
            Self::Dropping,
            "dropping",
            "one beam in five with 0, NaN or infinity for its range",
        ),
        (
            Self::Resting,
            "resting",
            "fifty scans on each spot where the path bends",
        ),
        (Self::Crowded, "crowded", "ten people who walk along"),
    ];
}

impl Robot {
    /// Changes the recorder of a kind into this robot's.
    #[must_use]
    pub fn instead_of(self, own: Recorder) -> Recorder {
        let sensor = |beams: usize, field_of_view_rad: f64, max_range_m: f64| Recorder {
            beams,
            field_of_view_rad,
            max_range_m,
            ..own
        };
        let noisy = |recorder: Recorder| Recorder {
            range_sigma_m: 0.03,
            ..recorder
        };
        match self {
            Self::Own => own,
            Self::Degree => sensor(181, PI, 80.0),
            Self::Short => sensor(181, PI, 8.0),
            Self::Coarse => sensor(91, PI, 30.0),
            Self::Small => noisy(sensor(360, TAU, 3.5)),
            Self::Spinning => noisy(sensor(360, TAU, 12.0)),
            Self::Hand => sensor(682, TAU * 240.0 / 360.0, 5.6),
            Self::Fine => sensor(1081, 1.5 * PI, 30.0),
            Self::Often => Recorder {
                spacing_m: [0.03, 0.08],
                ..own
            },
            Self::Seldom => Recorder {
                spacing_m: [0.6, 1.0],
                ..own
            },
            Self::Slippery => Recorder {
                slip: 3.0 * own.slip,
                drift_rad: 3.0 * own.drift_rad,
                ..own
            },
            Self::Jumpy => Recorder {
                jumps: 3.0 * own.jumps,
                ..own
            },
            Self::Veering => Recorder {
                slip: 0.0,
                drift_rad: PI / 90.0,
                jumps: 0.0,
                ..own
            },
            Self::Oversized => Recorder {
                wheel_scale: 1.1,
                ..own
            },
            Self::Ahead => Recorder {
                body_from_sensor: SE2::new(0.3, 0.0, PI),
                ..own
            },
            Self::UnknownMounting => Recorder {
                body_from_sensor: SE2::new(0.2, 0.0, 0.0),
                mounting: Mounting::Missing,
                ..own
            },
            Self::Stray => Recorder { stray: 0.05, ..own },
            Self::Dropping => Recorder {
                dropped: 0.2,
                ..own
            },
            Self::Resting => Recorder { rests: 50, ..own },
            Self::Crowded => Recorder { people: 10, ..own },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::buildings::{Kind, recorded, recorded_by};
    use ch16_slam2d::metrics::position_error_m;

    #[test]
    fn each_robot_differs_from_the_kinds_own_and_from_all_others() {
        let own = Recorder::default();
        let recorders: Vec<Recorder> = Robot::all().map(|robot| robot.instead_of(own)).collect();
        assert_eq!(recorders[0], own);
        for (k, recorder) in recorders.iter().enumerate() {
            assert!(!recorders[..k].contains(recorder), "{}", Robot::NAMED[k].1);
        }
    }

    #[test]
    fn a_log_without_mounting_lacks_only_the_pose_of_the_sensor() {
        let (with_mounting, _) = recorded(Kind::Hallway, 1);
        let (without_mounting, _) = recorded_by(Robot::UnknownMounting, Kind::Hallway, 1);
        let sensor = SE2::new(0.2, 0.0, 0.0);
        for (with_mounting, without_mounting) in with_mounting
            .frames
            .iter()
            .zip(&without_mounting.frames)
            .take(20)
        {
            assert_eq!(without_mounting.scan.body_from_sensor, SE2::identity());
            assert_eq!(without_mounting.odometry, with_mounting.odometry);
            assert!(
                position_error_m(&without_mounting.truth, &(with_mounting.truth * sensor)) < 1e-9
            );
        }
    }

    #[test]
    fn one_beam_of_five_is_dropped_and_a_robot_that_rests_stays_where_it_is() {
        let (dropping, _) = recorded_by(Robot::Dropping, Kind::Hallway, 1);
        let scan = &dropping.frames[10].scan;
        let seen = scan
            .ranges_m
            .iter()
            .filter(|range| **range > 0.0 && range.is_finite());
        let share = seen.count() as f64 / scan.ranges_m.len() as f64;
        // 0.2 of 360 beams, with a standard deviation of 0.02.
        assert!((share - 0.8).abs() < 0.08, "{share}");

        let (resting, _) = recorded_by(Robot::Resting, Kind::Hallway, 1);
        let pairs = resting.frames.windows(2);
        let still = pairs.filter(|pair| pair[0].truth == pair[1].truth).count();
        assert!(still >= 50 && still.is_multiple_of(50), "{still}");
    }
}
