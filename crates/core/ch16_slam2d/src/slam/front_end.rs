//! The front end: registers each scan on a map of the last few.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::registrar::{ExpectedMotion, Registration, ScanRegistrar};
use super::snapshot::{FrontEndSnapshot, SnapshotError};
use super::window::{ScanWindow, WindowScan};
use crate::cloud::PointCloud;
use crate::config::SlamConfig;
use crate::metrics::position_error_m;
use crate::scan::{MovingSweep, PreparedFrame, is_finite};

/// Smallest time between two stamps that determines a velocity, s.
const MIN_INTERVAL_S: f64 = 1e-6;
/// Largest predicted motion by a velocity, m; beyond any map.
const MAX_MOTION_M: f64 = 1e9;

/// Window and estimate, with the strategy that registers scans.
///
/// Its memory is bounded: it holds only the scans of its window.
#[derive(Clone)]
pub struct FrontEnd {
    estimate: SE2,
    velocity: Vector3<f64>,
    /// Duration of the last motion, s.
    last_dt_s: f64,
    window: ScanWindow,
    registrar: Box<dyn ScanRegistrar>,
}

impl FrontEnd {
    /// A front end without scans.
    #[must_use]
    pub fn new(config: &SlamConfig, registrar: Box<dyn ScanRegistrar>) -> Self {
        Self {
            estimate: config.start,
            velocity: Vector3::zeros(),
            last_dt_s: f64::INFINITY,
            window: ScanWindow::default(),
            registrar,
        }
    }

    /// The estimated pose, `world_from_body`.
    #[must_use]
    pub fn estimate(&self) -> SE2 {
        self.estimate
    }

    /// Twist of the last motion, in m/s, m/s, rad/s.
    #[must_use]
    pub fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }

    /// Correspondence threshold τ for the next registration, m; 0 if it does not adapt.
    #[must_use]
    pub fn tau_m(&self) -> f64 {
        self.registrar.tau_m()
    }

    /// The sweeps of the next local map, oldest first.
    #[must_use]
    pub fn window(&self) -> &[WindowScan] {
        self.window.sweeps()
    }

    /// The points of the last local map, world frame.
    #[must_use]
    pub fn local_cloud(&self) -> &PointCloud {
        self.registrar.local_cloud()
    }

    /// Its state between two frames.
    pub(crate) fn snapshot(&self) -> FrontEndSnapshot {
        FrontEndSnapshot {
            estimate: self.estimate,
            velocity: self.velocity,
            last_dt_s: self.last_dt_s,
            window: self.window.sweeps().to_vec(),
            scans: self.window.scans().to_vec(),
            registrar: self.registrar.snapshot(),
        }
    }

    /// Continues from a snapshot; the local map is rebuilt before it is used.
    pub(crate) fn restore(&mut self, snapshot: &FrontEndSnapshot) -> Result<(), SnapshotError> {
        self.registrar.restore(&snapshot.registrar)?;
        self.registrar.window_changed();
        self.estimate = snapshot.estimate;
        self.velocity = snapshot.velocity;
        self.last_dt_s = snapshot.last_dt_s;
        self.window = ScanWindow::new(&snapshot.window, &snapshot.scans);
        Ok(())
    }

    /// Makes a scan taken at the estimate the only one of the window.
    pub(crate) fn start(&mut self, number: usize, scan: Arc<PointCloud>) {
        self.window = ScanWindow::default();
        self.window.push(number, self.estimate, scan);
        self.registrar.window_changed();
    }

    /// Registers the scan of a frame `dt_s` seconds after the last one, deskews it with the velocity that results,
    /// and updates the window.
    pub(crate) fn register(
        &mut self,
        frame: &mut PreparedFrame,
        dt_s: f64,
        number: usize,
        config: &SlamConfig,
    ) -> Registration {
        let before = self.estimate;
        let extrapolated = self.constant_velocity(dt_s, config);
        let motion = frame.odometry.unwrap_or(extrapolated);
        let motion = if is_finite(&(before * motion)) {
            motion
        } else {
            SE2::identity()
        };
        let sweep = frame.sweep.clone();
        let sweep = sweep.as_deref();
        let sweep = sweep.map(|sweep| MovingSweep::new(sweep, before, dt_s.max(MIN_INTERVAL_S)));
        let expected = ExpectedMotion {
            before,
            motion,
            extrapolated,
            velocity: self.velocity,
            is_measured: frame.odometry.is_some(),
            sweep,
        };
        let prediction = expected.prediction();
        let tau_m = self.tau_m();
        let matched = self.registrar.register(frame, &expected, &self.window);
        let accepted = matched.is_supported(config.min_inliers) && is_finite(&matched.pose);
        self.estimate = if accepted { matched.pose } else { prediction };
        self.last_dt_s = dt_s;
        self.velocity = match &sweep {
            Some(moving) => moving.velocity(&self.estimate),
            None => before.between(&self.estimate).log() / dt_s.max(MIN_INTERVAL_S),
        };
        if let Some(moving) = &sweep {
            frame.cloud = Arc::new(moving.sweep.cloud(&self.velocity));
        }
        self.registrar.decided(&expected, &self.estimate, accepted);
        Registration {
            prediction,
            estimate: self.estimate,
            tau_m,
            next_tau_m: self.tau_m(),
            accepted,
            joined_window: self.join_window(frame, number, config),
            matched,
        }
    }

    /// Information of the estimate for the edge from the last keyframe, whose heading is `source_theta`.
    pub(super) fn information(&mut self, source_theta: f64) -> Matrix3<f64> {
        self.registrar
            .edge_information(&self.estimate, source_theta)
    }

    /// Moves the estimate and the window by `correction`, applied on the left, after a loop closure.
    pub(super) fn correct(&mut self, correction: &SE2) {
        self.estimate = *correction * self.estimate;
        self.window.correct(correction);
        self.registrar.window_changed();
    }

    /// The motion with the last velocity, for the limited time of extrapolation.
    fn constant_velocity(&self, dt_s: f64, config: &SlamConfig) -> SE2 {
        let stays_s = dt_s.min(config.extrapolation * self.last_dt_s);
        let motion = SE2::exp(&(self.velocity * stays_s));
        // The velocity of a jump may be arbitrary: then it is ignored.
        if position_error_m(&SE2::identity(), &motion) <= MAX_MOTION_M {
            motion
        } else {
            SE2::identity()
        }
    }

    fn join_window(&mut self, frame: &PreparedFrame, number: usize, config: &SlamConfig) -> bool {
        let sweeps = self.window.sweeps();
        if let Some(newest) = sweeps.last()
            && sweeps.len() >= config.window_scans
        {
            let turn = newest.pose.between(&self.estimate).theta().abs();
            if position_error_m(&newest.pose, &self.estimate) < config.window_distance_m
                && turn < config.window_turn_rad
            {
                return false;
            }
            self.window.drop_oldest();
        }
        self.window
            .push(number, self.estimate, Arc::clone(&frame.cloud));
        self.registrar.window_changed();
        true
    }
}
