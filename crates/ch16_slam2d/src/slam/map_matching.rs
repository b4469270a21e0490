//! The front end for robots: one cost of scan and odometry on the last few scans.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector2};
use pr_geom::SE2;

use super::RobotConfig;
use super::front_end::WindowSweep;
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, MapRegistrationConfig, MotionPrior, PriorTail, RangeProfile};
use crate::matching::{MatchStop, MatchSummary};
use crate::scan::{MovingSweep, PreparedFrame};

/// The motion up to a frame, before its scan is registered.
pub(super) struct FrameMotion<'a> {
    /// Estimate before it.
    pub before: SE2,
    /// The motion by odometry, or else by constant velocity.
    pub motion: SE2,
    /// The motion by constant velocity.
    pub extrapolated: SE2,
    /// The sweep of the frame, if its beams differ in time.
    pub sweep: Option<MovingSweep<'a>>,
}

/// Registers scans on the last few with the odometry as a prior.
#[derive(Clone)]
pub(super) struct MapMatching {
    config: RobotConfig,
    registration: MapRegistrationConfig,
    map: LocalMap,
    profiles: Vec<Arc<RangeProfile>>,
    /// Whether the window has changed since the map was built.
    is_outdated: bool,
    /// Information of the last scan, body frame.
    scan_information: Matrix3<f64>,
    /// Covariance of the motions since the last keyframe, by odometry.
    motion_covariance: Matrix3<f64>,
}

impl MapMatching {
    pub fn new(config: RobotConfig) -> Self {
        Self {
            registration: config.registration(),
            config,
            map: LocalMap::default(),
            profiles: Vec::new(),
            is_outdated: true,
            scan_information: Matrix3::zeros(),
            motion_covariance: Matrix3::zeros(),
        }
    }

    /// The points of the local map, world frame.
    pub fn cloud(&self) -> &PointCloud {
        self.map.cloud()
    }

    /// Covariance of the motions since the last keyframe.
    pub fn motion_covariance(&self) -> Matrix3<f64> {
        self.motion_covariance
    }

    /// Continues with the scans of a snapshot.
    pub fn restore(&mut self, scans: &[Arc<PointCloud>], motion_covariance: Matrix3<f64>) {
        let profiles = scans.iter().map(|scan| Arc::new(RangeProfile::new(scan)));
        self.profiles = profiles.collect();
        self.motion_covariance = motion_covariance;
        self.is_outdated = true;
    }

    /// Adds a scan to the window as the newest; drops the oldest if the window is full.
    pub fn add_scan(&mut self, scan: &PointCloud, is_full: bool) {
        if is_full {
            self.profiles.remove(0);
        }
        self.profiles.push(Arc::new(RangeProfile::new(scan)));
        self.is_outdated = true;
    }

    /// Marks the window as moved: the map is rebuilt before the next scan.
    pub fn mark_moved(&mut self) {
        self.is_outdated = true;
    }

    /// Information of the edge to a new keyframe: that of the scan plus that of the odometry since the last one.
    pub fn take_information(&mut self) -> Matrix3<f64> {
        let motion_covariance = std::mem::take(&mut self.motion_covariance);
        self.scan_information + motion_covariance.try_inverse().unwrap_or_default()
    }

    /// Registers the scan of a frame after a motion, and its velocity if its beams differ in time.
    pub fn register(
        &mut self,
        frame: &PreparedFrame,
        moved: &FrameMotion<'_>,
        window: &[WindowSweep],
        scans: &[Arc<PointCloud>],
    ) -> MatchSummary {
        if self.is_outdated {
            let sweeps = window.iter().zip(scans).zip(&self.profiles);
            self.map
                .rebuild(sweeps.map(|((sweep, scan), profile)| (sweep.pose, &**scan, profile)));
            self.is_outdated = false;
        }
        let FrameMotion { before, motion, .. } = moved;
        let prior = self.prior(before, motion, frame.odometry.is_some());
        let starts = [*before * moved.extrapolated];
        let config = &self.registration;
        let mut found = self.map.locate(&frame.cloud, &prior, &starts, config);
        if let Some(sweep) = &moved.sweep {
            let start = found.registered.pose;
            found = self
                .map
                .register_sweep(&frame.cloud, sweep, start, &prior, config);
        }
        let pose = found.registered.pose;
        self.scan_information = found.information();
        let adjoint = motion.inverse().adjoint();
        self.motion_covariance = adjoint * self.motion_covariance * adjoint.transpose()
            + motion_covariance(motion, &prior, &pose);
        MatchSummary {
            pose,
            rmse_m: found.fit.rmse_m,
            inliers: found.fit.inliers,
            iterations: found.registered.iterations,
            score: Some(found.fit.score),
            runner_up: None,
            stop: MatchStop::Other("registered on the local map"),
        }
    }

    fn prior(&self, before: &SE2, motion: &SE2, is_measured: bool) -> MotionPrior {
        let tail = if is_measured {
            PriorTail::Student
        } else {
            PriorTail::Normal
        };
        let noise = self.config.motion_noise(is_measured);
        let (sigma_m, sigma_rad) = noise.deviations(motion);
        MotionPrior {
            pose: *before * *motion,
            sigma_m,
            sigma_rad,
            tail,
        }
    }
}

/// Covariance of a motion in the frame at its end. A heading error that accumulates evenly along the motion also moves its
/// end sideways, which matters after metres without a scan.
fn motion_covariance(motion: &SE2, prior: &MotionPrior, pose: &SE2) -> Matrix3<f64> {
    let mut covariance = prior.covariance(pose);
    let (x, y) = motion.rotation().unrotate(-motion.y(), motion.x());
    let sideways = Vector2::new(x, y);
    let heading = covariance.m33;
    let mut position = covariance.fixed_view_mut::<2, 2>(0, 0);
    position += sideways * sideways.transpose() * (heading / 3.0);
    let cross = sideways * (heading / 2.0);
    covariance.fixed_view_mut::<2, 1>(0, 2).copy_from(&cross);
    covariance
        .fixed_view_mut::<1, 2>(2, 0)
        .copy_from(&cross.transpose());
    covariance
}

#[cfg(test)]
mod tests {
    use pr_geom::{SE2, math};

    use crate::slam::{Slam, SlamConfig, test_room};

    #[test]
    fn an_odometry_jump_of_five_metres_is_rejected() {
        // 5 m and 60°: beyond the search window. Not at the first frames, which have no velocity.
        for jump in [
            SE2::new(5.0, 0.0, 0.0),
            SE2::new(-3.0, 4.0, 1.0),
            SE2::new(0.0, 0.0, 2.5),
        ] {
            let config = SlamConfig::for_robot(&test_room::frame(0).scan);
            let mut slam = Slam::new(config);
            let start = test_room::truth(0);
            for step in 0..20 {
                let mut frame = test_room::frame(step);
                if step == 12 {
                    frame.odometry = frame.odometry.map(|motion| motion * jump);
                }
                let report = slam.step(&frame).unwrap();
                let truth = start.between(&test_room::truth(step));
                let off = truth.between(&report.estimate);
                // 5 cm: the noise of the odometry, in a room whose four walls are seen.
                let is_there = math::norm2(off.x(), off.y()) < 0.05 && off.theta().abs() < 0.02;
                assert!(is_there, "{jump:?}, step {step}: {off:?}");
            }
        }
    }
}
