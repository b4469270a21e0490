//! The front end for robots: one cost of scan and odometry on the last few scans.

use nalgebra::{Matrix3, Vector2};
use pr_geom::SE2;

use super::{
    LocalMap, LocalMapConfig, MapRegistrationConfig, MotionPrior, PriorTail, ScanProfiles,
};
use crate::cloud::PointCloud;
use crate::matching::{MatchStop, MatchSummary};
use crate::scan::PreparedFrame;
use crate::slam::{ExpectedMotion, NamedNumbers, ScanRegistrar, ScanWindow, SnapshotError};

/// Name of the covariance of the motions since the last keyframe in a snapshot.
const MOTION_COVARIANCE: &str = "motion covariance";

/// Registers scans on the last few with the odometry as a prior.
#[derive(Clone)]
pub(crate) struct MapRegistrar {
    config: LocalMapConfig,
    registration: MapRegistrationConfig,
    map: LocalMap,
    profiles: ScanProfiles,
    /// Whether the window has changed since the map was built.
    is_outdated: bool,
    /// Information of the last scan, body frame.
    scan_information: Matrix3<f64>,
    /// Covariance of the motions since the last keyframe, by odometry.
    motion_covariance: Matrix3<f64>,
}

impl MapRegistrar {
    pub fn new(config: LocalMapConfig) -> Self {
        Self {
            registration: config.registration(),
            config,
            map: LocalMap::default(),
            profiles: ScanProfiles::default(),
            is_outdated: true,
            scan_information: Matrix3::zeros(),
            motion_covariance: Matrix3::zeros(),
        }
    }

    fn rebuild(&mut self, window: &ScanWindow) {
        let profiles: Vec<_> = window
            .scans()
            .iter()
            .map(|scan| self.profiles.of(scan))
            .collect();
        let posed = window.posed_scans().zip(&profiles);
        self.map
            .rebuild(posed.map(|((pose, scan), profile)| (*pose, &**scan, profile)));
        self.profiles.keep_only(window.scans());
        self.is_outdated = false;
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

impl ScanRegistrar for MapRegistrar {
    fn register(
        &mut self,
        frame: &PreparedFrame,
        expected: &ExpectedMotion<'_>,
        window: &ScanWindow,
    ) -> MatchSummary {
        if self.is_outdated {
            self.rebuild(window);
        }
        let (before, motion) = (&expected.before, &expected.motion);
        let prior = self.prior(before, motion, expected.is_measured);
        let starts = [*before * expected.extrapolated];
        let config = &self.registration;
        let mut found = self.map.locate(&frame.cloud, &prior, &starts, config);
        if let Some(sweep) = &expected.sweep {
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

    /// The map is rebuilt before the next scan.
    fn window_changed(&mut self) {
        self.is_outdated = true;
    }

    /// That of the scan plus that of the odometry since the last keyframe.
    fn edge_information(&mut self, _: &SE2, _: f64) -> Matrix3<f64> {
        let motion_covariance = std::mem::take(&mut self.motion_covariance);
        self.scan_information + motion_covariance.try_inverse().unwrap_or_default()
    }

    fn local_cloud(&self) -> &PointCloud {
        self.map.cloud()
    }

    fn snapshot(&self) -> NamedNumbers {
        NamedNumbers::default().with(MOTION_COVARIANCE, self.motion_covariance.as_slice())
    }

    fn restore(&mut self, snapshot: &NamedNumbers) -> Result<(), SnapshotError> {
        self.motion_covariance = Matrix3::from_column_slice(&snapshot.get::<9>(MOTION_COVARIANCE)?);
        Ok(())
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
