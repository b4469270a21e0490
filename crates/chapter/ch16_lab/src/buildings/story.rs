//! A mapped building as plain data, for the picture with which the page of the reader's own robot opens.

use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::slam::{LoopClosure, Slam};
use pr_geom::SE2;
use serde::Serialize;

use super::kinds::{Kind, recorded};
use super::recording::Recording;
use super::trial::estimator;

/// Beams of a scan that the picture keeps.
const BEAMS: usize = 36;
/// Every second keyframe is kept; one follows another after 0.65 m or a turn.
const KEPT: usize = 2;
/// Longer ranges are left out: few walls, and long lines when the pose is wrong.
const RANGE_M: f64 = 12.0;

/// The keyframes of one drive as odometry, scan matching and loops place them.
///
/// Poses are `[x cm, y cm, heading mrad]` in the world's frame, and every estimate starts at the true pose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BuildingStory {
    /// By dead reckoning.
    pub wheels: Vec<[i32; 3]>,
    /// By the front end alone.
    pub walls: Vec<[i32; 3]>,
    /// In the final graph.
    pub loops: Vec<[i32; 3]>,
    /// Largest position error of a keyframe by each of the three, cm.
    pub worst_cm: [i32; 3],
    /// Bearing of the first kept beam and from one to the next, body frame, mrad.
    pub beams_mrad: [i32; 2],
    /// Ranges of each, cm; 0 is no return.
    pub ranges_cm: Vec<Vec<u16>>,
}

impl BuildingStory {
    /// The building of the page: corridors around a block, seed 1.
    #[must_use]
    pub fn for_page() -> Self {
        let (recording, robot) = recorded(Kind::Ring, 1);
        Self::new(&recording, &robot)
    }

    /// Maps the recording twice, without and with loops.
    ///
    /// # Panics
    /// If the recording has no frame.
    #[must_use]
    pub fn new(recording: &Recording, robot: &LocalMapConfig) -> Self {
        let frames = &recording.frames;
        let (slam, _) = map(recording, robot, LoopClosure::On);
        let (_, alone) = map(recording, robot, LoopClosure::Off);
        let kept = slam
            .keyframes()
            .iter()
            .zip(slam.graph().poses())
            .step_by(KEPT);
        let (taken, loops): (Vec<usize>, Vec<SE2>) =
            kept.map(|(keyframe, pose)| (keyframe.frame, *pose)).unzip();
        let odometry = |k: usize| frames[0].truth * frames[0].odometry.between(&frames[k].odometry);
        let wheels: Vec<SE2> = taken.iter().map(|&k| odometry(k)).collect();
        let walls: Vec<SE2> = taken.iter().map(|&k| alone[k]).collect();
        let worst = |poses: &[SE2]| {
            let errors = poses.iter().zip(&taken);
            let errors = errors.map(|(pose, &k)| position_error_m(pose, &frames[k].truth));
            hundredths(errors.fold(0.0, f64::max))
        };
        let scan = &frames[0].scan;
        let every = scan.ranges_m.len() / BEAMS;
        let mrad = |angle: f64| (1000.0 * angle).round() as i32;
        Self {
            worst_cm: [worst(&wheels), worst(&walls), worst(&loops)],
            wheels: wheels.iter().map(short).collect(),
            walls: walls.iter().map(short).collect(),
            loops: loops.iter().map(short).collect(),
            beams_mrad: [
                mrad(scan.first_angle_rad + scan.body_from_sensor.theta()),
                mrad(scan.angle_step_rad * every as f64),
            ],
            ranges_cm: taken
                .iter()
                .map(|&k| ranges(&frames[k].scan.ranges_m, every))
                .collect(),
        }
    }
}

/// The estimator after the last scan, and its pose at every frame.
fn map(recording: &Recording, robot: &LocalMapConfig, closure: LoopClosure) -> (Slam, Vec<SE2>) {
    let frames = &recording.frames;
    let mut slam = estimator(recording, *robot);
    slam.set_loop_closure(closure);
    let mut poses = Vec::with_capacity(frames.len());
    for number in 0..frames.len() {
        let before = poses.last().copied().unwrap_or(frames[0].truth);
        let report = slam.step(&recording.frame(number, true));
        poses.push(report.map_or(before, |report| report.estimate));
    }
    if closure == LoopClosure::On {
        slam.conclude();
    }
    (slam, poses)
}

fn ranges(ranges_m: &[f64], every: usize) -> Vec<u16> {
    let kept = ranges_m.iter().step_by(every);
    kept.map(|&range| {
        if range < RANGE_M {
            hundredths(range) as u16
        } else {
            0
        }
    })
    .collect()
}

fn short(pose: &SE2) -> [i32; 3] {
    [
        hundredths(pose.x()),
        hundredths(pose.y()),
        (1000.0 * pose.theta()).round() as i32,
    ]
}

fn hundredths(metres: f64) -> i32 {
    (100.0 * metres).round() as i32
}
