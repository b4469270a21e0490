//! Whether a scan continues a run: by the odometry, or because it fits where the robot was.

use std::sync::Arc;

use nalgebra::Vector3;
use pr_geom::{SE2, math};

use super::LogFrame;
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, RangeProfile};
use crate::metrics::position_error_m;
use crate::scan::ScanPreparer;
use crate::slam::Slam;

/// A shorter time between two scans needs no explanation, s.
const GAP_S: f64 = 10.0;
/// Odometry is not followed, and a robot need not stand where it stood, over a longer time, s.
const LONG_GAP_S: f64 = 120.0;
/// Odometry within this of zero may have started again, m and rad.
const ZERO: (f64, f64) = (0.5, 0.3);
/// Odometry that moved by more measured a motion during the gap, m and rad.
const MOVED: (f64, f64) = (0.3, 0.2);
/// Fastest plausible motion, m/s.
const MAX_SPEED: f64 = 3.0;
/// Keyframes for the test: their largest distance, m, and their number.
const NEAR: (f64, usize) = (4.0, 12);
/// A scan with at least this score fits, 0 to 1.
const FITS: f64 = 0.7;
/// Largest share of points in observed free space of a scan that fits.
const MAX_CONTRADICTING: f64 = 0.05;
/// Largest correction of a scan that fits, m and rad.
const SHIFT: (f64, f64) = (0.5, 0.35);

/// What the odometry says of the time between two scans.
enum Odometry {
    /// It moved by this, and did not start again.
    Moved,
    /// It stood still, and did not start again.
    Still,
    /// There is none, it may have started again, or its motion is not plausible.
    Unknown,
}

impl Odometry {
    fn between(last: Option<SE2>, now: Option<SE2>, gap_s: f64) -> Self {
        let (Some(last), Some(now)) = (last, now) else {
            return Self::Unknown;
        };
        let is_within = |pose: &SE2, (m, rad): (f64, f64)| {
            math::norm2(pose.x(), pose.y()) <= m && pose.theta().abs() <= rad
        };
        let motion = last.between(&now);
        if is_within(&now, ZERO) || position_error_m(&last, &now) > MAX_SPEED * gap_s {
            return Self::Unknown;
        }
        if is_within(&motion, MOVED) {
            Self::Still
        } else {
            Self::Moved
        }
    }
}

/// Whether a valid scan, `gap_s` seconds after the last one, continues the run.
///
/// After a gap without explanation the robot may have been carried, or it may be another day.
pub(super) fn continues(
    slam: &Slam,
    last_odometry: Option<SE2>,
    recorded: &LogFrame,
    gap_s: f64,
) -> bool {
    if gap_s <= GAP_S {
        return true;
    }
    let odometry = Odometry::between(last_odometry, recorded.odometry, gap_s);
    let is_long = gap_s > LONG_GAP_S;
    match odometry {
        Odometry::Moved if !is_long => return true,
        Odometry::Unknown if is_long => return false,
        _ => {}
    }
    let motion = match (odometry, last_odometry, recorded.odometry) {
        (Odometry::Moved, Some(last), Some(now)) => last.between(&now),
        _ => SE2::identity(),
    };
    let here = slam.front_end().estimate() * motion;
    // The motion during the gap does not skew the sweep.
    let cloud = ScanPreparer::new().prepare(&recorded.scan, &Vector3::zeros(), &slam.config().scan);
    fits(slam, &cloud, here)
}

/// Whether a scan fits on the keyframes around a pose, there.
fn fits(slam: &Slam, scan: &PointCloud, pose: SE2) -> bool {
    let poses = slam.graph().poses();
    let mut near: Vec<(f64, usize)> = poses
        .iter()
        .zip(0..)
        .map(|(at, node)| (position_error_m(at, &pose), node))
        .filter(|(away_m, _)| *away_m <= NEAR.0)
        .collect();
    pr_geom::sort_ranked(&mut near);
    near.truncate(NEAR.1);
    let scans = near.iter().map(|&(_, node)| &slam.keyframes()[node].scan);
    let profiles: Vec<Arc<RangeProfile>> = scans
        .map(|scan| Arc::new(RangeProfile::new(scan)))
        .collect();
    let mut map = LocalMap::default();
    map.rebuild(
        near.iter()
            .zip(&profiles)
            .map(|(&(_, node), profile)| (poses[node], &*slam.keyframes()[node].scan, profile)),
    );
    let settings = slam.config().local_map.unwrap_or_default().registration();
    let stages = [settings.max_correspondence_m, settings.inlier_distance_m];
    let found = map.register(scan, pose, &stages, None, &settings);
    let shift = pose.between(&found.registered.pose);
    math::norm2(shift.x(), shift.y()) <= SHIFT.0
        && shift.theta().abs() <= SHIFT.1
        && found.fit.score >= FITS
        && found.fit.contradicting as f64 <= MAX_CONTRADICTING * scan.len() as f64
}
