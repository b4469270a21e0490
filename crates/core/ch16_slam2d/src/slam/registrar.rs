//! The strategy that registers a scan on the last few.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::snapshot::{NamedNumbers, SnapshotError};
use super::window::ScanWindow;
use crate::cloud::PointCloud;
use crate::matching::MatchSummary;
use crate::scan::{MovingSweep, PreparedFrame};

/// Result of registering one scan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Registration {
    /// Estimate before it, moved by the odometry or by the last velocity: `world_from_body`.
    pub prediction: SE2,
    /// The result, or the prediction if too few pairs were found.
    pub estimate: SE2,
    /// Correspondence threshold τ that was used, m.
    pub tau_m: f64,
    /// τ for the next registration, m, adapted to this one's correction.
    pub next_tau_m: f64,
    /// Whether the result was accepted.
    pub accepted: bool,
    /// Whether the scan joined the window of the next local map.
    pub joined_window: bool,
    /// The registration itself.
    pub matched: MatchSummary,
}

/// The motion to a scan before it is registered.
#[derive(Clone, Copy, Debug)]
pub struct ExpectedMotion<'a> {
    /// The estimate before the motion: `world_from_body`.
    pub before: SE2,
    /// The motion by odometry, or with the last velocity if there is none.
    pub motion: SE2,
    /// The motion with the last velocity.
    pub extrapolated: SE2,
    /// Twist of the last motion, in m/s, m/s, rad/s.
    pub velocity: Vector3<f64>,
    /// Whether odometry measured the motion.
    pub is_measured: bool,
    /// The sweep of the scan, if its beams differ in time.
    pub sweep: Option<MovingSweep<'a>>,
}

impl ExpectedMotion<'_> {
    /// The estimate after the motion: `world_from_body`.
    #[must_use]
    pub fn prediction(&self) -> SE2 {
        self.before * self.motion
    }
}

/// Registers scans on the window, with its own parameters and memory.
///
/// The chapter's registrar starts a matcher at the prediction; that for recorded logs minimizes one cost of scan
/// and motion.
pub trait ScanRegistrar: CloneRegistrar + Send {
    /// Registers the scan of a frame on the window, together with its velocity if its beams differ in time.
    fn register(
        &mut self,
        frame: &PreparedFrame,
        expected: &ExpectedMotion<'_>,
        window: &ScanWindow,
    ) -> MatchSummary;

    /// Handles the decision on the last registration: `estimate` is its pose if it was accepted, otherwise the
    /// prediction.
    fn decided(&mut self, _expected: &ExpectedMotion<'_>, _estimate: &SE2, _accepted: bool) {}

    /// Handles a change of the window: a scan joined it, or its poses moved.
    fn window_changed(&mut self) {}

    /// Information of `estimate` for the edge from the last keyframe, whose heading is `source_theta`; called once
    /// for each new keyframe.
    fn edge_information(&mut self, estimate: &SE2, source_theta: f64) -> Matrix3<f64>;

    /// The points of the last local map, world frame.
    fn local_cloud(&self) -> &PointCloud;

    /// Correspondence threshold τ for the next registration, m; 0 if it does not adapt.
    fn tau_m(&self) -> f64 {
        0.0
    }

    /// Its state between two frames, without the window.
    fn snapshot(&self) -> NamedNumbers;

    /// Continues from a snapshot.
    ///
    /// # Errors
    /// If a number is missing or impossible.
    fn restore(&mut self, snapshot: &NamedNumbers) -> Result<(), SnapshotError>;
}

/// A registrar that can be cloned behind its trait; implemented for every `Clone` registrar.
pub trait CloneRegistrar {
    /// A clone of this registrar.
    fn clone_registrar(&self) -> Box<dyn ScanRegistrar>;
}

impl<R: ScanRegistrar + Clone + 'static> CloneRegistrar for R {
    fn clone_registrar(&self) -> Box<dyn ScanRegistrar> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn ScanRegistrar> {
    fn clone(&self) -> Self {
        (**self).clone_registrar()
    }
}
