//! The front end: registers each sweep on a map of the last few.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::config::SlamConfig;
use super::drive::Drive;
use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{
    AdaptiveThreshold, INFORMATION_CAP, INFORMATION_RIDGE, Icp, IcpConfig, IcpSummary, IcpVariant,
    IcpWorkspace, Pair, icp_information_along, regularize,
};

/// A sweep of the local map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSweep {
    /// The tick after which it was taken; 0 is the start.
    pub tick: usize,
    /// Where it was taken, by the estimate: `world_from_body`.
    pub pose: SE2,
}

/// What a registration made of one sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registration {
    /// Estimate before it, moved by the wheels: `world_from_body`.
    pub prediction: SE2,
    /// The result, or the prediction where too few pairs were found.
    pub estimate: SE2,
    /// Correspondence threshold τ that was used, m.
    pub tau_m: f64,
    /// τ for the next registration, m: it has seen this one's correction.
    pub next_tau_m: f64,
    /// The registration itself.
    pub icp: IcpSummary,
}

/// Local map, threshold and estimate, with the memory of a registration.
#[derive(Clone)]
pub struct FrontEnd {
    estimate: SE2,
    window: Vec<WindowSweep>,
    threshold: AdaptiveThreshold,
    local_cloud: PointCloud,
    local_map: DenseMap,
    icp: IcpWorkspace,
    pairs: Vec<Pair>,
}

impl FrontEnd {
    /// A front end at the start of the drive, with the first sweep in its window.
    #[must_use]
    pub fn new(config: &SlamConfig) -> Self {
        let start = config.drive.start;
        Self {
            estimate: start,
            window: vec![WindowSweep {
                tick: 0,
                pose: start,
            }],
            threshold: AdaptiveThreshold::new(
                config.threshold.initial_m,
                config.threshold.min_motion_m,
                config.threshold.max_range_m,
            ),
            local_cloud: PointCloud::default(),
            local_map: DenseMap::new(config.local_map.cell_m, config.local_map.max_per_cell),
            icp: IcpWorkspace::new(),
            pairs: Vec::new(),
        }
    }

    /// The estimated pose, `world_from_body`.
    #[must_use]
    pub fn estimate(&self) -> SE2 {
        self.estimate
    }

    /// Correspondence threshold τ for the next registration, m.
    #[must_use]
    pub fn tau_m(&self) -> f64 {
        self.threshold.tau()
    }

    /// The sweeps of the next local map, oldest first.
    #[must_use]
    pub fn window(&self) -> &[WindowSweep] {
        &self.window
    }

    /// The points of the last local map, world frame.
    #[must_use]
    pub fn local_cloud(&self) -> &PointCloud {
        &self.local_cloud
    }

    /// Registers the sweep taken after `tick` ticks and adds it to the window.
    pub fn register(&mut self, drive: &Drive, tick: usize, config: &SlamConfig) -> Registration {
        self.rebuild_local_map(drive);
        let prediction = self.estimate * drive.ticks()[tick - 1].odometry;
        let tau_m = self.threshold.tau();
        let icp = Icp::new(
            &drive.sweep(tick).cloud,
            &self.local_map,
            prediction,
            &registration_config(tau_m, config),
            &mut self.icp,
        )
        .run();
        self.estimate = if icp.inliers >= config.min_inliers {
            icp.pose
        } else {
            prediction
        };
        self.threshold.update(&prediction, &self.estimate);
        if self.window.len() >= config.window_sweeps {
            self.window.remove(0);
        }
        self.window.push(WindowSweep {
            tick,
            pose: self.estimate,
        });
        Registration {
            prediction,
            estimate: self.estimate,
            tau_m,
            next_tau_m: self.threshold.tau(),
            icp,
        }
    }

    /// Information of the last registration in a body frame of heading `body_theta` (rad).
    pub fn information(&mut self, body_theta: f64, config: &SlamConfig) -> Matrix3<f64> {
        self.pairs.clear();
        self.pairs.extend(self.icp.pairs(&self.local_map));
        let information = icp_information_along(
            &self.pairs,
            config.odometry_trust.sigma_m,
            config.odometry_trust.inflate,
            body_theta,
        );
        regularize(information, INFORMATION_RIDGE, INFORMATION_CAP)
    }

    /// Moves the estimate and the window by `correction`, applied on the left: a loop was closed.
    pub fn correct(&mut self, correction: &SE2) {
        self.estimate = *correction * self.estimate;
        for sweep in &mut self.window {
            sweep.pose = *correction * sweep.pose;
        }
    }

    fn rebuild_local_map(&mut self, drive: &Drive) {
        local_cloud_into(&self.window, drive, &mut self.local_cloud);
        self.local_map.rebuild(&self.local_cloud);
    }
}

/// The settings of a registration on the local map.
pub(super) fn registration_config(tau_m: f64, config: &SlamConfig) -> IcpConfig {
    IcpConfig {
        variant: IcpVariant::PointToPoint,
        max_iters: config.max_iterations,
        tau: tau_m,
        ..IcpConfig::default()
    }
}

/// The points of a window in the world frame, oldest sweep first.
pub(super) fn local_cloud_into(window: &[WindowSweep], drive: &Drive, cloud: &mut PointCloud) {
    cloud.clear();
    for sweep in window {
        cloud.extend_transformed(&drive.sweep(sweep.tick).cloud, &sweep.pose);
    }
}
