//! Lifelong mapping: lap after lap with one estimator that prunes its map.
//!
//! Each lap is a separate drive that starts where the last one ended; its noise has the seed of the first lap
//! plus the number of the lap. In the chapter's flat a wardrobe can be moved before a lap.

use ch16_slam2d::metrics::{position_error_m, rms};
use ch16_slam2d::scan::PreparedFrame;
use ch16_slam2d::slam::{MapPruning, MapPruningConfig, Slam, SlamConfig};
use pr_geom::{Point2, SE2};
use pr_sim::{Course, Wall, World};
use serde::Serialize;
use std::sync::Arc;

use crate::lap::{Drive, DriveConfig};

/// The wardrobe's sides, m.
const WARDROBE_M: [f64; 2] = [0.7, 0.5];
/// Its lower left corner before and after the move: behind the doors to D and to E.
const WARDROBE_AT: [[f64; 2]; 2] = [[2.9, 5.7], [7.5, 5.7]];

/// The laps to drive.
#[derive(Clone, Debug, PartialEq)]
pub struct LapsConfig {
    /// The first lap; the next ones start where it ended and follow its waypoints.
    pub drive: DriveConfig,
    /// The estimator.
    pub slam: SlamConfig,
    /// How the map is pruned; `None` lets it grow.
    pub map_pruning: Option<MapPruningConfig>,
    /// The lap, counted from 1, before which the wardrobe is moved; `None` without a wardrobe.
    pub wardrobe: Option<usize>,
}

impl LapsConfig {
    /// Laps of a course with the values for robots.
    #[must_use]
    pub fn new(course: &Course, seed: u32, noise_factor: f64) -> Self {
        let drive = DriveConfig {
            seed,
            noise_factor,
            ..DriveConfig::default().on_course(course)
        };
        // One tick is enough to get the angle between the sensor's beams.
        let first = Drive::simulate(&DriveConfig {
            max_ticks: 1,
            ..drive.clone()
        })
        .frame(0);
        let slam = SlamConfig {
            start: drive.start,
            ..SlamConfig::for_robot(&first.scan)
        };
        Self {
            drive: DriveConfig {
                scan: slam.scan,
                ..drive
            },
            slam,
            map_pruning: Some(MapPruningConfig::default()),
            wardrobe: None,
        }
    }
}

/// The result of one lap.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LapNumbers {
    /// Number of the lap, counted from 1.
    pub lap: usize,
    /// Ticks of it.
    pub ticks: usize,
    /// Nodes of the graph at its end.
    pub nodes: usize,
    /// Edges of the graph at its end.
    pub edges: usize,
    /// Loops that were closed.
    pub loops: usize,
    /// Root mean square error of the estimate over its ticks, m.
    pub rms_m: f64,
    /// Root mean square error of the keyframes in the map at its end, m.
    pub map_rms_m: f64,
    /// Keyframes that were removed.
    pub removed: usize,
    /// Kullback–Leibler divergence of the removal, nats.
    pub divergence: f64,
    /// Points that were dropped because newer beams passed through them.
    pub points_gone: usize,
    /// Points in the map at the wardrobe's first location.
    pub wardrobe_points: usize,
}

/// A lap between two of its ticks.
pub struct LapUnderWay {
    tick: usize,
    loops: usize,
    done: MapPruning,
    errors_m: Vec<f64>,
}

/// Laps under way.
pub struct Laps {
    config: LapsConfig,
    slam: Slam,
    lap: usize,
    truth: SE2,
    stamp_s: f64,
    /// True pose of each frame that the estimator got.
    truths: Vec<SE2>,
}

impl Laps {
    /// Starts before the first lap.
    #[must_use]
    pub fn new(config: LapsConfig) -> Self {
        Self {
            slam: Slam::new(config.slam.clone()),
            truth: config.drive.start,
            lap: 0,
            stamp_s: 0.0,
            truths: Vec::new(),
            config,
        }
    }

    /// The estimator.
    #[must_use]
    pub fn slam(&self) -> &Slam {
        &self.slam
    }

    /// The drive of the next lap.
    #[must_use]
    pub fn drive_config(&self) -> DriveConfig {
        let drive = &self.config.drive;
        let mut world = Arc::clone(&drive.world);
        if let Some(moved) = self.config.wardrobe {
            let at = WARDROBE_AT[usize::from(self.lap + 1 >= moved)];
            world = Arc::new(with_wardrobe(&world, at));
        }
        DriveConfig {
            seed: drive.seed.wrapping_add(self.lap as u32),
            start: self.truth,
            world,
            ..drive.clone()
        }
    }

    /// Simulates the drive of the next lap.
    #[must_use]
    pub fn simulate(&self) -> Drive {
        Drive::simulate(&self.drive_config())
    }

    /// Runs the estimator on a simulated lap.
    ///
    /// # Panics
    /// If the drive is not the one of [`simulate`](Self::simulate).
    pub fn estimate(&mut self, drive: &Drive) -> LapNumbers {
        let mut under_way = self.begin();
        loop {
            if let Some(numbers) = self.step(&mut under_way, drive) {
                return numbers;
            }
        }
    }

    /// Starts the next lap; the estimator has its first frame already, unless it is the first lap.
    #[must_use]
    pub fn begin(&self) -> LapUnderWay {
        LapUnderWay {
            tick: usize::from(self.lap > 0),
            loops: 0,
            done: MapPruning::default(),
            errors_m: Vec::new(),
        }
    }

    /// Processes one tick of a simulated lap. Returns its numbers after the last tick.
    ///
    /// # Panics
    /// If the drive is not the one of [`simulate`](Self::simulate).
    pub fn step(&mut self, lap: &mut LapUnderWay, drive: &Drive) -> Option<LapNumbers> {
        let tick = lap.tick;
        let frame = drive.prepared(tick);
        let stamp_s = self.stamp_s + frame.stamp_s;
        let report = self
            .slam
            .step_prepared(&PreparedFrame { stamp_s, ..frame })
            .expect("a simulated frame is in order");
        self.truths.push(drive.truth(tick));
        lap.errors_m
            .push(position_error_m(&report.estimate, &drive.truth(tick)));
        lap.loops += usize::from(report.closed_loop().is_some());
        if let (Some(_), Some(map_pruning)) = (report.new_keyframe, &self.config.map_pruning) {
            let step = self.slam.prune_map(map_pruning);
            lap.done.removed.extend(step.removed);
            lap.done.divergence += step.divergence;
            lap.done.points_gone += step.points_gone;
        }
        lap.tick += 1;
        (tick >= drive.ticks().len()).then(|| self.end(lap, drive))
    }

    fn end(&mut self, lap: &mut LapUnderWay, drive: &Drive) -> LapNumbers {
        let errors_m = core::mem::take(&mut lap.errors_m);
        let (loops, done) = (lap.loops, core::mem::take(&mut lap.done));
        let ticks = drive.ticks().len();
        self.lap += 1;
        self.truth = drive.truth(ticks);
        self.stamp_s += drive.prepared(ticks).stamp_s;
        let keyframes = self.slam.keyframes().iter().zip(self.slam.graph().poses());
        let map_m = keyframes
            .clone()
            .map(|(keyframe, pose)| position_error_m(pose, &self.truths[keyframe.frame]));
        LapNumbers {
            lap: self.lap,
            ticks,
            nodes: self.slam.graph().node_count(),
            edges: self.slam.graph().edge_count(),
            loops,
            rms_m: rms(errors_m),
            map_rms_m: rms(map_m),
            removed: done.removed.len(),
            divergence: done.divergence,
            points_gone: done.points_gone,
            wardrobe_points: keyframes
                .map(|(keyframe, pose)| {
                    let world = keyframe.scan.iter().map(|point| pose.transform(point));
                    world.filter(is_at_first_wardrobe).count()
                })
                .sum(),
        }
    }
}

/// Whether a point is at the wardrobe's first location; the nearest walls are farther away.
fn is_at_first_wardrobe(point: &Point2<f64>) -> bool {
    let [x, y] = WARDROBE_AT[0];
    let [wide, deep] = WARDROBE_M;
    let margin_m = 0.2;
    (x - margin_m..=x + wide + margin_m).contains(&point.x)
        && (y - margin_m..=y + deep + margin_m).contains(&point.y)
}

/// The corners of the wardrobe before its move and after it, world frame, m.
#[must_use]
pub fn wardrobe_corners() -> [[Point2<f64>; 4]; 2] {
    WARDROBE_AT.map(corners)
}

fn corners([x, y]: [f64; 2]) -> [Point2<f64>; 4] {
    let [wide, deep] = WARDROBE_M;
    [
        Point2::new(x, y),
        Point2::new(x + wide, y),
        Point2::new(x + wide, y + deep),
        Point2::new(x, y + deep),
    ]
}

fn with_wardrobe(world: &World, at: [f64; 2]) -> World {
    let corners = corners(at);
    let sides = (0..4).map(|k| Wall {
        start: corners[k],
        end: corners[(k + 1) % 4],
    });
    let walls = world.walls().iter().copied().chain(sides);
    World::new(world.bounds(), walls.collect())
}
