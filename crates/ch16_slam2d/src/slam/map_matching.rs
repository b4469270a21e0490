//! The front end for robots: one cost of scan and odometry, and other starts where a scan fits poorly.

use std::sync::Arc;

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::RobotConfig;
use super::front_end::WindowSweep;
use crate::cloud::PointCloud;
use crate::local_map::{
    LocalMap, MapRegistration, MapRegistrationConfig, MotionPrior, PriorTail, RangeProfile,
};
use crate::matching::{MatchStop, MatchSummary};
use crate::scan::PreparedFrame;
use crate::search::SearchWindow;

/// A scan that fits so well needs no other start, 0 to 1.
const GOOD_WITHOUT_WHEELS: f64 = 0.9;
/// Other starts where the prediction is off by more than a registration reaches: along the heading (m) and
/// turned by (rad).
const STARTS: ([f64; 5], [f64; 9]) = (
    [0.0, -0.5, 0.5, -1.0, 1.0],
    [0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9, -1.2, 1.2],
);

/// What registers scans on the last few with the odometry as a prior.
#[derive(Clone)]
pub(super) struct MapMatching {
    config: RobotConfig,
    registration: MapRegistrationConfig,
    map: LocalMap,
    profiles: Vec<Arc<RangeProfile>>,
    /// Whether the window has changed since the map was built.
    is_outdated: bool,
    /// Information of the last scan, body frame.
    known: Matrix3<f64>,
    /// Covariance of the motions since the last keyframe, as the odometry has them.
    driven: Matrix3<f64>,
}

impl MapMatching {
    pub fn new(config: RobotConfig) -> Self {
        Self {
            registration: config.registration(),
            config,
            map: LocalMap::default(),
            profiles: Vec::new(),
            is_outdated: true,
            known: Matrix3::zeros(),
            driven: Matrix3::zeros(),
        }
    }

    /// The points of the local map, world frame.
    pub fn cloud(&self) -> &PointCloud {
        self.map.cloud()
    }

    /// Covariance of the motions since the last keyframe.
    pub fn driven(&self) -> Matrix3<f64> {
        self.driven
    }

    /// Goes on with scans that were taken before.
    pub fn restore(&mut self, scans: &[Arc<PointCloud>], driven: Matrix3<f64>) {
        let profiles = scans.iter().map(|scan| Arc::new(RangeProfile::new(scan)));
        self.profiles = profiles.collect();
        self.driven = driven;
        self.is_outdated = true;
    }

    /// A scan joins the window as the newest; the oldest leaves it where it is full.
    pub fn join(&mut self, scan: &PointCloud, is_full: bool) {
        if is_full {
            self.profiles.remove(0);
        }
        self.profiles.push(Arc::new(RangeProfile::new(scan)));
        self.is_outdated = true;
    }

    /// The window was moved: the map is built again before the next scan.
    pub fn moved(&mut self) {
        self.is_outdated = true;
    }

    /// Information of the edge to a new keyframe: that of the scan and that of the odometry on the way.
    pub fn take_information(&mut self) -> Matrix3<f64> {
        let driven = std::mem::take(&mut self.driven);
        self.known + driven.try_inverse().unwrap_or_default()
    }

    /// Registers the scan of a frame; `before` is the estimate before the motion, and `goes_on` where the
    /// robot would be at its last velocity.
    pub fn register(
        &mut self,
        frame: &PreparedFrame,
        before: &SE2,
        motion: &SE2,
        goes_on: &SE2,
        window: &[WindowSweep],
        scans: &[Arc<PointCloud>],
    ) -> MatchSummary {
        if self.is_outdated {
            let sweeps = window.iter().zip(scans).zip(&self.profiles);
            self.map
                .rebuild(sweeps.map(|((sweep, scan), profile)| (sweep.pose, &**scan, profile)));
            self.is_outdated = false;
        }
        let prior = self.prior(before, motion, frame.odometry.is_some());
        let found = self.best(&frame.cloud, &prior, goes_on);
        let pose = found.registered.pose;
        self.known = found.information();
        let adjoint = motion.inverse().adjoint();
        self.driven = adjoint * self.driven * adjoint.transpose() + prior.covariance(&pose);
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
        let (noise, tail) = if is_measured {
            (&self.config.odometry, PriorTail::Student)
        } else {
            (&self.config.constant_velocity, PriorTail::Normal)
        };
        let (sigma_m, sigma_rad) = noise.deviations(motion);
        MotionPrior {
            pose: *before * *motion,
            sigma_m,
            sigma_rad,
            tail,
        }
    }

    /// The pose of lowest cost among those that registrations from several starts end at.
    fn best(&mut self, scan: &PointCloud, prior: &MotionPrior, goes_on: &SE2) -> MapRegistration {
        let stages = [self.config.reach_m, self.config.fit_m];
        let near = &stages[1..];
        let mut best = self.from(scan, prior, prior.pose, &stages);
        // A registration from afar slides along a wall where the scan fits better at the prediction.
        let predicted = self.map.fit(scan, &prior.pose, &self.registration);
        if predicted.score > best.fit.score {
            best = cheaper(best, self.from(scan, prior, prior.pose, near));
        }
        let is_vague = 2.0 * prior.sigma_m > self.config.reach_m;
        if is_vague && best.fit.score < GOOD_WITHOUT_WHEELS {
            for turn_rad in STARTS.1 {
                for ahead_m in STARTS.0 {
                    let start = prior.pose * SE2::new(ahead_m, 0.0, turn_rad);
                    if prior.cost(&start) < best.cost {
                        best = cheaper(best, self.from(scan, prior, start, &stages));
                    }
                }
            }
        }
        if best.fit.score < self.config.good_score {
            // Wheels may jump farther than the search looks.
            best = cheaper(best, self.from(scan, prior, *goes_on, &stages));
        }
        if best.fit.score < self.config.good_score
            && let Some(start) = self.search(scan, &prior.pose)
        {
            best = cheaper(best, self.from(scan, prior, start, near));
        }
        best
    }

    fn from(
        &mut self,
        scan: &PointCloud,
        prior: &MotionPrior,
        start: SE2,
        reaches_m: &[f64],
    ) -> MapRegistration {
        let config = &self.registration;
        self.map
            .register(scan, start, reaches_m, Some(prior), config)
    }

    /// The best pose of the window around the prediction, by branch and bound.
    fn search(&self, scan: &PointCloud, prediction: &SE2) -> Option<SE2> {
        let (half_m, half_rad) = (self.config.search_m, self.config.search_rad);
        let window = SearchWindow::around(*prediction, half_m, half_rad);
        Some(self.map.search(scan, &window, 0.0)?.best.pose)
    }
}

fn cheaper(one: MapRegistration, other: MapRegistration) -> MapRegistration {
    if other.cost < one.cost { other } else { one }
}

#[cfg(test)]
mod tests {
    use pr_geom::{SE2, math};

    use crate::slam::{Slam, SlamConfig, test_room};

    #[test]
    fn wheels_that_jump_by_five_metres_leave_the_robot_where_it_is() {
        // 5 m and 60°: beyond what the search looks at. Not at the first frames, which have no velocity.
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
                // 5 cm: the noise of the wheels, in a room whose four walls are seen.
                let is_there = math::norm2(off.x(), off.y()) < 0.05 && off.theta().abs() < 0.02;
                assert!(is_there, "{jump:?}, step {step}: {off:?}");
            }
        }
    }
}
