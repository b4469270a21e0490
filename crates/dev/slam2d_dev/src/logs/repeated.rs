//! `slam2d-dev logs FOLDER --repeat N`: each log driven forward and back without a pause, N times, as a robot on patrol.

use bench_support::timed;
use pr_geom::Rng;
use rayon::prelude::*;
use robot_io::log::LogFrame;
use robot_io::run::LogRun;
use robot_io::trajectory::{StampedPose, Trajectory};
use serde::Serialize;

use super::disturbance::{Mirror, WornOdometry, stray};
use super::{Bench, SLACK_S};

/// Noise of the returns of a noisy patrol, m.
const RANGE_SIGMA_M: f64 = 0.02;
/// Share of its returns that end before their wall.
const STRAY: f64 = 0.05;
/// Share of its scans that are lost.
const LOST: f64 = 0.3;
/// Scale and noise of its odometry: about twice the log's noise.
const ODOMETRY: (f64, f64) = (1.0, 1.0);
/// The mean time per scan is over this share of the scans, at the start and at the end.
const PART: usize = 10;

/// How a log is driven again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Drive {
    /// Forward and back over the very same scans.
    Retraced,
    /// With new noise in every scan, lost scans and worse odometry.
    Noisy,
}

/// Result for a log that is driven repeatedly.
#[derive(Clone, Debug, Serialize)]
pub(super) struct RepeatedResult {
    log: String,
    drive: Drive,
    drives: usize,
    scans: usize,
    /// CPU time with the end of the run, s.
    cpu_s: f64,
    /// CPU time of the slowest scan, ms.
    worst_ms: f64,
    /// Mean CPU time of a scan in the first and in the last tenth, ms.
    mean_ms: [f64; 2],
    keyframes: usize,
    edges: usize,
    /// Error of the kind of the log's reference over the first and over the last drive, m; null if nothing can be compared.
    error_m: [Option<f64>; 2],
}

/// Maps every log once and `drives` times, retraced and noisy.
pub(super) fn outcomes(benches: &[Bench], drives: usize, seed: u32) -> Vec<RepeatedResult> {
    let of_log = |bench: &Bench| {
        [Drive::Retraced, Drive::Noisy]
            .into_iter()
            .flat_map(|drive| [1, drives].map(|drives| bench.repeated(drive, drives, seed)))
            .collect::<Vec<_>>()
    };
    let of_logs: Vec<_> = benches.par_iter().map(of_log).collect();
    of_logs.concat()
}

impl Bench {
    fn repeated(&self, drive: Drive, drives: usize, seed: u32) -> RepeatedResult {
        let patrol = Patrol::new(&self.frames);
        let mut run = LogRun::default();
        let mut scans_ms = Vec::new();
        let mut noise = Noise::new(seed);
        for frame in (0..drives).flat_map(|number| patrol.drive(number)) {
            let frame = match drive {
                Drive::Retraced => Some(frame),
                Drive::Noisy => noise.on(frame),
            };
            if let Some(frame) = frame {
                scans_ms.push(timed(|| run.step(frame)).1);
            }
        }
        let end_ms = timed(|| run.finish()).1;
        let trajectory = run.trajectory();
        let error_m = |number: usize| self.error_m(&patrol.as_recorded(number, &trajectory));
        let part = scans_ms.len().div_ceil(PART).max(1);
        let mean_ms = |scans: &[f64]| scans.iter().sum::<f64>() / scans.len().max(1) as f64;
        let slam = run.slam_mut();
        RepeatedResult {
            log: self.name.clone(),
            drive,
            drives,
            scans: scans_ms.len(),
            cpu_s: 1e-3 * (scans_ms.iter().sum::<f64>() + end_ms),
            worst_ms: scans_ms.iter().copied().fold(0.0, f64::max),
            mean_ms: [
                mean_ms(&scans_ms[..part.min(scans_ms.len())]),
                mean_ms(&scans_ms[scans_ms.len().saturating_sub(part)..]),
            ],
            keyframes: slam.as_ref().map_or(0, |slam| slam.keyframes().len()),
            edges: slam.map_or(0, |slam| slam.graph().edge_count()),
            error_m: [error_m(0), error_m(drives - 1)],
        }
    }
}

/// A log driven forward, back, forward, …: a scan of a later drive has a later stamp, and the odometry continues.
struct Patrol<'a> {
    frames: &'a [LogFrame],
    mirror: Mirror,
    /// From the start of a drive to that of the next, s.
    period_s: f64,
}

impl<'a> Patrol<'a> {
    fn new(frames: &'a [LogFrame]) -> Self {
        let mirror = Mirror::of(frames);
        let lasts_s = mirror.lasts_s();
        Self {
            frames,
            mirror,
            period_s: lasts_s + lasts_s / frames.len().saturating_sub(1).max(1) as f64,
        }
    }

    /// The scans of drive `number` in order.
    fn drive(&self, number: usize) -> impl Iterator<Item = LogFrame> {
        let count = self.frames.len();
        (0..count).map(move |k| {
            let k = if number.is_multiple_of(2) {
                k
            } else {
                count - 1 - k
            };
            let frame = self.frames[k].clone();
            LogFrame {
                stamp_s: self.stamp_s(number, frame.stamp_s),
                ..frame
            }
        })
    }

    fn stamp_s(&self, number: usize, recorded_s: f64) -> f64 {
        self.turned_s(number, recorded_s) + number as f64 * self.period_s
    }

    /// The stamp on the way of drive `number`: time runs backward on every second one.
    fn turned_s(&self, number: usize, stamp_s: f64) -> f64 {
        if number.is_multiple_of(2) {
            stamp_s
        } else {
            self.mirror.stamp_s(stamp_s)
        }
    }

    /// The trajectory of drive `number`, at the stamps of the recording.
    fn as_recorded(&self, number: usize, trajectory: &Trajectory) -> Trajectory {
        let first_s = self.frames.first().map_or(0.0, |frame| frame.stamp_s);
        let mut poses: Vec<StampedPose> = trajectory
            .poses()
            .iter()
            .map(|at| StampedPose {
                stamp_s: at.stamp_s - number as f64 * self.period_s,
                ..*at
            })
            .filter(|at| {
                at.stamp_s >= first_s - SLACK_S
                    && at.stamp_s <= first_s + self.mirror.lasts_s() + SLACK_S
            })
            .map(|at| StampedPose {
                stamp_s: self.turned_s(number, at.stamp_s),
                ..at
            })
            .collect();
        if !number.is_multiple_of(2) {
            poses.reverse();
        }
        Trajectory::new(poses)
    }
}

/// Noise that is new in every scan.
struct Noise {
    rng: Rng,
    odometry: WornOdometry,
}

impl Noise {
    fn new(seed: u32) -> Self {
        Self {
            rng: Rng::new(seed),
            odometry: WornOdometry::new(ODOMETRY.0, ODOMETRY.1, seed),
        }
    }

    /// The scan with noise; `None` if it is lost.
    fn on(&mut self, mut frame: LogFrame) -> Option<LogFrame> {
        frame.odometry = frame.odometry.map(|measured| self.odometry.next(measured));
        if self.rng.unit() < LOST {
            return None;
        }
        stray(&mut frame.scan, STRAY, &mut self.rng);
        for beam in 0..frame.scan.ranges_m.len() {
            let range_m = frame.scan.ranges_m[beam];
            if frame.scan.is_return(range_m) {
                let noisy_m = range_m + self.rng.normal(0.0, RANGE_SIGMA_M);
                frame.scan.ranges_m[beam] =
                    noisy_m.clamp(frame.scan.range_min_m, frame.scan.range_max_m);
            }
        }
        Some(frame)
    }
}

/// The rows in Markdown; the CPU time of many drives is also given as a multiple of that of as many single ones.
pub(super) fn table(rows: &[RepeatedResult]) -> String {
    let mut lines = vec![
        "| log | drives | scans | CPU, s | per single drive | worst scan, ms | mean scan, first to last tenth, ms | keyframes | error of the first drive, m | of the last |".to_owned(),
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |".to_owned(),
    ];
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.3}"));
    for pair in rows.chunks(2) {
        for row in pair {
            let single_s = pair[0].cpu_s * row.drives as f64;
            let name = match row.drive {
                Drive::Retraced => row.log.clone(),
                Drive::Noisy => format!("{}, noisy", row.log),
            };
            lines.push(format!(
                "| {name} | {} | {} | {:.1} | {:.2} | {:.0} | {:.2} to {:.2} | {} | {} | {} |",
                row.drives,
                row.scans,
                row.cpu_s,
                row.cpu_s / single_s,
                row.worst_ms,
                row.mean_ms[0],
                row.mean_ms[1],
                row.keyframes,
                number(row.error_m[0]),
                number(row.error_m[1]),
            ));
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::scan::LaserScan;
    use pr_geom::SE2;

    fn line(scans: u32) -> Vec<LogFrame> {
        let frame = |k: u32| LogFrame {
            stamp_s: 100.0 + f64::from(k * k),
            odometry: Some(SE2::from_xy(0.1 * f64::from(k), 0.0)),
            scan: LaserScan {
                ranges_m: vec![4.0; 181],
                ..LaserScan::default()
            },
        };
        (0..scans).map(frame).collect()
    }

    #[test]
    fn later_drives_have_later_stamps_that_map_back() {
        let frames = line(20);
        let patrol = Patrol::new(&frames);
        let driven: Vec<LogFrame> = (0..4).flat_map(|number| patrol.drive(number)).collect();
        assert!(driven.is_sorted_by(|one, next| one.stamp_s < next.stamp_s));
        let poses = driven.iter().filter_map(|frame| {
            Some(StampedPose {
                stamp_s: frame.stamp_s,
                pose: frame.odometry?,
            })
        });
        let trajectory = Trajectory::new(poses.collect());
        for number in 0..4 {
            let back = patrol.as_recorded(number, &trajectory);
            assert_eq!(back.poses().len(), frames.len());
            for (at, frame) in back.poses().iter().zip(&frames) {
                assert_eq!(Some(at.pose), frame.odometry);
                // 1e-9 s: a few roundings of stamps below 10⁴ s.
                assert!((at.stamp_s - frame.stamp_s).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_noisy_drive_loses_scans_and_repeats_no_noise() {
        let frames = line(400);
        let patrol = Patrol::new(&frames);
        let mut noise = Noise::new(5);
        let mut noisy = || -> Vec<LogFrame> {
            patrol
                .drive(0)
                .filter_map(|frame| noise.on(frame))
                .collect()
        };
        let (first, second) = (noisy(), noisy());
        for driven in [&first, &second] {
            // Four standard deviations of 400 losses with a probability of 0.3 are 37.
            assert!(driven.len().abs_diff(280) < 37, "{}", driven.len());
        }
        assert_ne!(first[0].scan.ranges_m, second[0].scan.ranges_m);
    }
}
