//! Maps the first part of a log with and without a repair.
//!
//! Each scan costs what its pose does, in nats: the misfit of the scan on the last few, and the deviation from the pose
//! that odometry predicts, as a negative logarithm of the density. A wrong repair lets every scan fit, but not where
//! odometry puts it: the score alone does not distinguish a mirror image from a room. A repair wins if it makes scans
//! cheaper in both halves of the part, and on the whole by more than chance.

use ch16_slam2d::local_map::{LocalMapConfig, MotionPrior, PriorTail};
use ch16_slam2d::scan::Frame;
use ch16_slam2d::slam::{LoopClosure, Slam, SlamConfig};
use nalgebra::Vector3;
use pr_geom::{SE2, math};

use super::Costs;
use super::repairs::{Repairs, TurnedPath};
use crate::log::LogFrame;
use crate::odometry_poses::OdometryPoses;
use crate::stamps::median;

/// Most scans that are mapped; of more, every n-th is.
const MAX_SCANS: usize = 400;
/// A repair has to make a scan cheaper by this many nats in either half, and by this many standard errors on the whole.
const MIN_NATS: f64 = 0.1;
const MIN_ERRORS: f64 = 2.0;
/// What a single scan counts at most, nats: one that matched a wrong place must not decide.
const MAX_NATS: f64 = 10.0;

/// The part of a log that is mapped in different ways.
pub(super) struct Trial {
    /// The scans after a motion.
    frames: Vec<LogFrame>,
    odometry: OdometryPoses,
}

impl Trial {
    /// The scans of `frames` with these stamps, s.
    pub fn new<'a>(frames: impl IntoIterator<Item = &'a LogFrame>, stamps_s: &[f64]) -> Self {
        let every = stamps_s.len().div_ceil(MAX_SCANS).max(1);
        let mut stamps_s = stamps_s.iter().step_by(every).copied().peekable();
        let mut trial = Self {
            frames: Vec::new(),
            odometry: OdometryPoses::default(),
        };
        for frame in frames {
            if let Some(pose) = frame.odometry {
                trial.odometry.push(frame.stamp_s, pose);
            }
            if stamps_s.next_if_eq(&frame.stamp_s).is_some() {
                trial.frames.push(frame.clone());
            }
        }
        trial
    }

    /// Cost of each scan after these repairs, nats.
    pub fn costs(&self, repairs: &Repairs) -> Vec<f64> {
        let Some(first) = self.frames.first() else {
            return Vec::new();
        };
        let robot = LocalMapConfig::for_scan(&first.scan);
        let mut slam = Slam::new(SlamConfig::from_local_map(robot));
        slam.set_loop_closure(LoopClosure::Off);
        let mut last_odometry = None;
        let mut path = TurnedPath::default();
        let frames = self.frames.iter().map(|frame| {
            let mut frame = frame.clone();
            if let Some(late_s) = repairs.late_s {
                frame.odometry = self.odometry.at(frame.stamp_s + late_s);
            }
            repairs.time_beams(&mut frame.scan);
            if !repairs.drops_odometry {
                let from_s = frame.stamp_s + repairs.late_s.unwrap_or(0.0);
                frame.scan.velocity = self.velocity(repairs, from_s, frame.scan.sweep_s());
            }
            let frame = repairs.apply(frame, &mut path);
            let motion = last_odometry.zip(frame.odometry);
            last_odometry = frame.odometry;
            let frame = Frame {
                stamp_s: frame.stamp_s,
                odometry: motion.map(|(last, now): (SE2, SE2)| last.between(&now)),
                scan: frame.scan,
            };
            posed(&mut slam, &frame, &robot)
        });
        let scans: Vec<Option<PosedScan>> = frames.collect();
        let learned = Spread::learned(scans.iter().flatten(), &robot);
        // A frame that cannot be used costs nothing, in every trial.
        let cost = |scan: &Option<PosedScan>| scan.map_or(0.0, |scan| scan.cost(&learned));
        scans.iter().map(cost).collect()
    }

    /// Velocity of the body during a sweep, by odometry.
    fn velocity(&self, repairs: &Repairs, from_s: f64, sweep_s: f64) -> Option<Vector3<f64>> {
        let ends = [
            self.odometry.at(from_s)?,
            self.odometry.at(from_s + sweep_s)?,
        ];
        (sweep_s > 0.0).then(|| repairs.motion(ends) / sweep_s)
    }

    /// Whether `with` is cheaper than `without`, scan by scan.
    pub fn compare(&self, with: &[f64], without: &[f64]) -> Costs {
        let gains: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
        let clipped = gains.iter().map(|gain| gain.clamp(-MAX_NATS, MAX_NATS));
        let gains: Vec<f64> = clipped.collect();
        let (first, second) = gains.split_at(gains.len() / 2);
        let is_better = |half: &[f64]| mean(half) >= MIN_NATS;
        let wins = is_better(first) && is_better(second) && is_surely_positive(&gains);
        Costs {
            scans: self.frames.len(),
            with: mean(with),
            without: mean(without),
            wins,
        }
    }
}

fn is_surely_positive(gains: &[f64]) -> bool {
    let mean_gain = mean(gains);
    let squares = gains
        .iter()
        .map(|gain| (gain - mean_gain) * (gain - mean_gain));
    let variance = squares.sum::<f64>() / math::max(gains.len() as f64 - 1.0, 1.0);
    let error = math::sqrt(variance / gains.len() as f64);
    mean_gain > MIN_ERRORS * error
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// A scan at its pose.
#[derive(Clone, Copy)]
struct PosedScan {
    /// Cost of its misfit, nats.
    misfit: f64,
    prediction: SE2,
    estimate: SE2,
    /// Spread of the prediction by odometry; `None` if constant velocity predicted it.
    stated: Option<Spread>,
}

/// Standard deviations of predicted poses.
#[derive(Clone, Copy)]
struct Spread {
    sigma_m: f64,
    sigma_rad: f64,
}

impl Spread {
    /// That of constant velocity, which depends on the robot: by the medians over the trial.
    fn learned<'a>(scans: impl Iterator<Item = &'a PosedScan>, robot: &LocalMapConfig) -> Self {
        let predicted = scans.filter(|scan| scan.stated.is_none());
        let off = predicted.map(|scan| scan.prediction.between(&scan.estimate));
        let (off_m, off_rad): (Vec<f64>, Vec<f64>) = off
            .map(|off| (math::norm2(off.x(), off.y()), off.theta().abs()))
            .unzip();
        let sigma = |off: Vec<f64>, median_of_unit: f64, floor: f64| {
            math::max(median(off).unwrap_or_default() / median_of_unit, floor)
        };
        Self {
            // Medians of the length of a normal vector in the plane and of a normal number, both of variance 1.
            sigma_m: sigma(off_m, 1.1774, robot.motion_noise(true).floor_m),
            sigma_rad: sigma(off_rad, 0.6745, robot.motion_noise(true).floor_rad),
        }
    }
}

impl PosedScan {
    fn cost(&self, learned: &Spread) -> f64 {
        let Spread { sigma_m, sigma_rad } = self.stated.unwrap_or(*learned);
        let prior = MotionPrior {
            pose: self.prediction,
            sigma_m,
            sigma_rad,
            tail: PriorTail::Student,
        };
        let spread = 2.0 * math::ln(sigma_m) + math::ln(sigma_rad);
        self.misfit + prior.cost(&self.estimate) + spread
    }
}

/// Takes a frame; `None` if it cannot be used, and for the first one.
fn posed(slam: &mut Slam, frame: &Frame, robot: &LocalMapConfig) -> Option<PosedScan> {
    let before = slam.front_end().estimate();
    let registration = slam.step(frame).ok()?.registration?;
    let motion = before.between(&registration.prediction);
    let stated = frame.odometry.map(|_| {
        let (sigma_m, sigma_rad) = robot.motion_noise(true).deviations(&motion);
        Spread { sigma_m, sigma_rad }
    });
    let score = registration.matched.score.unwrap_or(0.0);
    Some(PosedScan {
        misfit: 4.5 * robot.registration().independent_points * (1.0 - score),
        prediction: registration.prediction,
        estimate: registration.estimate,
        stated,
    })
}
