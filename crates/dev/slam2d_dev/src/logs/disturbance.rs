//! What can be wrong with a recording, made from a good one.

use ch16_slam2d::scan::LaserScan;
use pr_geom::{Rng, SE2, math};
use robot_io::log::LogFrame;
use robot_io::trajectory::{StampedPose, Trajectory};

/// Additional noise per metre: along each axis, m, and of the heading, rad. About as much as the odometry of the
/// given logs has.
const NOISE: (f64, f64) = (0.05, 0.0175);
/// Beams of the narrow field of view lie at most this far from the middle one, rad.
const HALF_VIEW_RAD: f64 = core::f64::consts::FRAC_PI_4;
/// Every beam of this many is kept by the sparse sensor.
const SPARSE: usize = 4;
/// Share of the returns that end before their wall.
const STRAY: f64 = 0.1;

/// A disturbance of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// None: the recording itself.
    Plain,
    /// Without this many scans at the start.
    Later(usize),
    /// Odometry whose lengths are this many times too large.
    Wheels(f64),
    /// Odometry with noise added: about twice the log's.
    Noisy,
    /// Every second scan.
    EverySecond,
    /// 90° of the field of view.
    Narrow,
    /// Every fourth beam.
    Sparse,
    /// The last scan first.
    Reversed,
    /// A tenth of the beams end anywhere before their wall.
    Stray,
    /// Scans without odometry.
    ScansAlone,
}

impl Disturbance {
    /// All, in the order of the table.
    pub const ALL: [Self; 13] = [
        Self::Plain,
        Self::Later(1),
        Self::Later(2),
        Self::Later(5),
        Self::Wheels(1.05),
        Self::Wheels(0.95),
        Self::Noisy,
        Self::EverySecond,
        Self::Narrow,
        Self::Sparse,
        Self::Reversed,
        Self::Stray,
        Self::ScansAlone,
    ];

    /// Name in the table.
    pub fn name(self) -> String {
        let fixed = match self {
            Self::Later(1) => return "starts 1 scan later".to_owned(),
            Self::Later(scans) => return format!("starts {scans} scans later"),
            Self::Wheels(scale) => return format!("wheels {:+.0} %", 100.0 * (scale - 1.0)),
            Self::Plain => "none",
            Self::Noisy => "noise of the wheels × 2",
            Self::EverySecond => "every second scan",
            Self::Narrow => "90° of view",
            Self::Sparse => "every fourth beam",
            Self::Reversed => "reversed",
            Self::Stray => "10 % outlier beams",
            Self::ScansAlone => "scans alone",
        };
        fixed.to_owned()
    }

    /// Whether the log starts at another scan, and is otherwise the same.
    pub fn is_start(self) -> bool {
        matches!(self, Self::Plain | Self::Later(_))
    }

    /// The disturbed recording; the noise is that of the seed.
    pub fn frames(self, frames: &[LogFrame], seed: u32) -> Vec<LogFrame> {
        let scans = |change: &mut dyn FnMut(&mut LaserScan)| {
            let mut changed = frames.to_vec();
            for frame in &mut changed {
                change(&mut frame.scan);
            }
            changed
        };
        match self {
            Self::Plain => frames.to_vec(),
            Self::ScansAlone => frames
                .iter()
                .cloned()
                .map(|frame| LogFrame {
                    odometry: None,
                    ..frame
                })
                .collect(),
            Self::Later(skipped) => frames.iter().skip(skipped).cloned().collect(),
            Self::Wheels(scale) => worse_odometry(frames, scale, 0.0, seed),
            Self::Noisy => worse_odometry(frames, 1.0, 1.0, seed),
            Self::EverySecond => frames.iter().step_by(2).cloned().collect(),
            Self::Narrow => scans(&mut narrow),
            Self::Sparse => scans(&mut sparse),
            Self::Reversed => {
                let mirror = Mirror::of(frames);
                let backward = frames.iter().rev().cloned();
                backward
                    .map(|frame| LogFrame {
                        stamp_s: mirror.stamp_s(frame.stamp_s),
                        ..frame
                    })
                    .collect()
            }
            Self::Stray => {
                let mut rng = Rng::new(seed);
                scans(&mut |scan| stray(scan, STRAY, &mut rng))
            }
        }
    }

    /// The stamp in the recording for a stamp of the disturbed one.
    pub fn recorded_stamp_s(self, frames: &[LogFrame], stamp_s: f64) -> f64 {
        match self {
            Self::Reversed => Mirror::of(frames).stamp_s(stamp_s),
            _ => stamp_s,
        }
    }

    /// The trajectory of the disturbed recording, at the stamps of the recording.
    pub fn as_recorded(self, frames: &[LogFrame], trajectory: &Trajectory) -> Trajectory {
        let mut poses: Vec<StampedPose> = trajectory
            .poses()
            .iter()
            .map(|at| StampedPose {
                stamp_s: self.recorded_stamp_s(frames, at.stamp_s),
                ..*at
            })
            .collect();
        if self == Self::Reversed {
            poses.reverse();
        }
        Trajectory::new(poses)
    }
}

/// Time that runs backward between the first and the last scan.
pub(super) struct Mirror {
    first_s: f64,
    last_s: f64,
}

impl Mirror {
    pub(super) fn of(frames: &[LogFrame]) -> Self {
        let stamp_s = |frame: Option<&LogFrame>| frame.map_or(0.0, |frame| frame.stamp_s);
        Self {
            first_s: stamp_s(frames.first()),
            last_s: stamp_s(frames.last()),
        }
    }

    pub(super) fn stamp_s(&self, stamp_s: f64) -> f64 {
        self.first_s + (self.last_s - stamp_s)
    }

    /// Time from the first to the last scan, s.
    pub(super) fn lasts_s(&self) -> f64 {
        self.last_s - self.first_s
    }
}

/// The same scans with odometry that is `scale` times too long, and `noise` times as noisy again.
pub fn worse_odometry(frames: &[LogFrame], scale: f64, noise: f64, seed: u32) -> Vec<LogFrame> {
    let mut worn = WornOdometry::new(scale, noise, seed);
    let mut worsened = frames.to_vec();
    for frame in &mut worsened {
        frame.odometry = frame.odometry.map(|measured| worn.next(measured));
    }
    worsened
}

/// Makes worse odometry of measured one, pose by pose.
pub(super) struct WornOdometry {
    scale: f64,
    noise: f64,
    rng: Rng,
    /// The last measured pose, and the worse one.
    last: Option<(SE2, SE2)>,
}

impl WornOdometry {
    pub(super) fn new(scale: f64, noise: f64, seed: u32) -> Self {
        Self {
            scale,
            noise,
            rng: Rng::new(seed),
            last: None,
        }
    }

    pub(super) fn next(&mut self, measured: SE2) -> SE2 {
        let worse = self.last.map_or(measured, |(before, worse)| {
            let motion = before.between(&measured);
            let driven_m = self.noise * math::norm2(motion.x(), motion.y());
            let (across_m, turned_rad) = (NOISE.0 * driven_m, NOISE.1 * driven_m);
            worse
                * SE2::new(
                    self.scale * motion.x() + self.rng.normal(0.0, across_m),
                    self.scale * motion.y() + self.rng.normal(0.0, across_m),
                    motion.theta() + self.rng.normal(0.0, turned_rad),
                )
        });
        self.last = Some((measured, worse));
        worse
    }
}

/// Keeps the beams about the middle one.
fn narrow(scan: &mut LaserScan) {
    let beams = scan.ranges_m.len();
    let middle_rad = scan.first_angle_rad + 0.5 * beams as f64 * scan.angle_step_rad;
    let is_kept = |beam: &usize| (scan.bearing_rad(*beam) - middle_rad).abs() <= HALF_VIEW_RAD;
    let kept: Vec<usize> = (0..beams).filter(is_kept).collect();
    let Some((&first, &last)) = kept.first().zip(kept.last()) else {
        return;
    };
    scan.first_angle_rad = scan.bearing_rad(first);
    scan.ranges_m = scan.ranges_m[first..=last].to_vec();
}

/// Keeps every fourth beam.
fn sparse(scan: &mut LaserScan) {
    scan.angle_step_rad *= SPARSE as f64;
    scan.beam_interval_s *= SPARSE as f64;
    scan.ranges_m = scan.ranges_m.iter().copied().step_by(SPARSE).collect();
}

/// Shortens this share of the returns.
pub(super) fn stray(scan: &mut LaserScan, share: f64, rng: &mut Rng) {
    for beam in 0..scan.ranges_m.len() {
        let range_m = scan.ranges_m[beam];
        if scan.is_return(range_m) && rng.unit() < share {
            scan.ranges_m[beam] = rng.uniform(scan.range_min_m, range_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(scans: u32) -> Vec<LogFrame> {
        let frame = |k: u32| LogFrame {
            stamp_s: 100.0 + f64::from(k * k),
            odometry: Some(SE2::from_xy(0.1 * f64::from(k), 0.0)),
            scan: LaserScan {
                first_angle_rad: -core::f64::consts::FRAC_PI_2,
                angle_step_rad: core::f64::consts::PI / 180.0,
                ranges_m: vec![4.0; 181],
                ..LaserScan::default()
            },
        };
        (0..scans).map(frame).collect()
    }

    #[test]
    fn worse_odometry_is_three_percent_too_long_and_the_same_for_the_same_seed() {
        let frames = line(2000);
        let worse = worse_odometry(&frames, 1.03, 1.0, 7);
        let steps = worse.windows(2).filter_map(|two| {
            let (from, to) = (two[0].odometry?, two[1].odometry?);
            Some(from.between(&to).x())
        });
        let path_m: f64 = steps.sum();
        // 200 m, 3 % and the noise of 2,000 steps, 5 mm each: 0.2 m.
        assert!((path_m - 1.03 * 199.9).abs() < 1.0, "{path_m}");
        assert_eq!(worse, worse_odometry(&frames, 1.03, 1.0, 7));
    }

    #[test]
    fn a_reversed_recording_has_rising_stamps_that_map_back() {
        let frames = line(30);
        let reversed = Disturbance::Reversed.frames(&frames, 1);
        assert!(reversed.is_sorted_by(|one, next| one.stamp_s < next.stamp_s));
        for (one, back) in frames.iter().zip(reversed.iter().rev()) {
            assert_eq!(one.odometry, back.odometry);
            let stamp_s = Disturbance::Reversed.recorded_stamp_s(&frames, back.stamp_s);
            // 1e-9 s: two roundings of stamps below 10³ s.
            assert!((stamp_s - one.stamp_s).abs() < 1e-9);
        }
    }

    #[test]
    fn the_beams_that_are_kept_keep_their_bearings() {
        let frames = line(1);
        let bearings = |scan: &LaserScan| -> Vec<f64> {
            let beams = 0..scan.ranges_m.len();
            beams.map(|k| scan.bearing_rad(k).to_degrees()).collect()
        };
        let narrow = &Disturbance::Narrow.frames(&frames, 1)[0].scan;
        let [first, last] = [0, narrow.ranges_m.len() - 1].map(|k| bearings(narrow)[k]);
        // The 90° about straight ahead, to a beam.
        assert!(
            (first + 45.0).abs() < 1.01 && (last - 45.0).abs() < 1.01,
            "{first} to {last}"
        );
        let sparse = &Disturbance::Sparse.frames(&frames, 1)[0].scan;
        assert_eq!(sparse.ranges_m.len(), 46);
        assert!((bearings(sparse)[45] - 90.0).abs() < 1e-9);
    }

    #[test]
    fn a_tenth_of_the_beams_end_before_their_wall() {
        let strayed = Disturbance::Stray.frames(&line(20), 3);
        let ranges: Vec<f64> = strayed
            .into_iter()
            .flat_map(|frame| frame.scan.ranges_m)
            .collect();
        let shorter = ranges.iter().filter(|range_m| **range_m < 4.0).count();
        // 3,620 beams: four standard deviations of a share of 0.1 are 0.02.
        let share = shorter as f64 / ranges.len() as f64;
        assert!((share - 0.1).abs() < 0.02, "{share}");
    }
}
