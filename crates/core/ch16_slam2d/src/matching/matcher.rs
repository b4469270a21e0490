//! The matcher interface.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::{TrustConfig, match_information};
use crate::cloud::PointCloud;
use crate::icp::{Pair, StopReason};
use crate::ndt::NdtStop;

/// How a map of some sweeps is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapConfig {
    /// Side of a cell in metres.
    pub cell_m: f64,
    /// Points kept in a cell.
    pub max_per_cell: usize,
}

/// A request for one registration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchRequest {
    /// Initial guess: `target_from_source`.
    pub guess: SE2,
    /// Points farther than this from the target are not paired, m.
    pub tau_m: f64,
    /// Largest number of iterations.
    pub max_iterations: usize,
    /// Smallest useful score, 0 to 1: a matcher may stop early if it cannot be reached.
    pub min_score: f64,
}

impl MatchRequest {
    /// A registration from `guess` with this threshold (m) and limit.
    #[must_use]
    pub fn new(guess: SE2, tau_m: f64, max_iterations: usize) -> Self {
        Self {
            guess,
            tau_m,
            max_iterations,
            min_score: 0.0,
        }
    }

    /// The same request with this smallest useful score.
    #[must_use]
    pub fn with_min_score(self, min_score: f64) -> Self {
        Self { min_score, ..self }
    }
}

/// Why a matcher stopped, with the measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MatchStop {
    /// Stop reason of ICP.
    Icp(StopReason),
    /// Stop reason of NDT.
    Ndt(NdtStop),
    /// The whole window was searched.
    Searched {
        /// Number of scored poses.
        poses: usize,
    },
    /// No pose of the window reaches the smallest score, or the target has no grid to search: the pose is the guess.
    NotFound,
    /// Stop reason of a custom matcher.
    Other(&'static str),
}

impl MatchStop {
    /// Whether the pose is a result of the scan in any direction; otherwise it is the guess.
    #[must_use]
    pub fn is_supported(&self) -> bool {
        match self {
            Self::Icp(stop) => stop.is_supported(),
            Self::Ndt(stop) => stop.is_supported(),
            Self::Searched { .. } | Self::Other(_) => true,
            Self::NotFound => false,
        }
    }
}

impl core::fmt::Display for MatchStop {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Icp(stop) => write!(f, "ICP: {stop}"),
            Self::Ndt(stop) => write!(f, "NDT: {stop}"),
            Self::Searched { poses } => write!(f, "the window was searched: {poses} poses scored"),
            Self::NotFound => write!(f, "no pose of the window fits"),
            Self::Other(stop) => write!(f, "{stop}"),
        }
    }
}

/// The best pose that is distinct from the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunnerUp {
    /// `target_from_source`.
    pub pose: SE2,
    /// Its score, in the unit of [`MatchSummary::score`].
    pub score: f64,
}

/// Result of a registration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchSummary {
    /// `target_from_source`.
    pub pose: SE2,
    /// Root mean square residual of the pairs, m; infinite without pairs.
    pub rmse_m: f64,
    /// Points of the scan with a partner in the target.
    pub inliers: usize,
    /// Iterations made.
    pub iterations: usize,
    /// Score of the pose, larger is better, if the matcher has one.
    pub score: Option<f64>,
    /// The best distinct pose, if the matcher searched for one.
    pub runner_up: Option<RunnerUp>,
    /// Why it stopped.
    pub stop: MatchStop,
}

impl MatchSummary {
    /// Whether the pose is a result of the scan, with at least this number of inliers.
    #[must_use]
    pub fn is_supported(&self, min_inliers: usize) -> bool {
        self.inliers >= min_inliers && self.stop.is_supported()
    }

    /// Margin of the score to the runner-up.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        Some(self.score? - self.runner_up?.score)
    }
}

/// Result of a matcher with its pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// Pose, fit and reason to stop.
    pub summary: MatchSummary,
    /// The pairs at that pose, in the target's frame.
    pub pairs: Vec<Pair>,
}

impl Match {
    /// Information of the pairs about the pose: 3×3, translation first, in its tangent space, about the body's
    /// origin, without ridge and cap. See [`match_information`].
    #[must_use]
    pub fn information(&self, trust: &TrustConfig) -> Matrix3<f64> {
        match_information(&self.pairs, &self.summary.pose, trust)
    }
}

/// Registers scans on a target, which stays until the next [`set_target`](Matcher::set_target).
///
/// A matcher gives the same bits for the same calls, on every machine.
pub trait Matcher: CloneMatcher + Send {
    /// Takes the points of `target`, with their normals, as the map.
    fn set_target(&mut self, target: &PointCloud);

    /// Finds the pose of `source` on the target.
    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match;
}

/// A matcher that can be cloned behind its trait; implemented for every `Clone` matcher.
pub trait CloneMatcher {
    /// A clone of this matcher.
    fn clone_matcher(&self) -> Box<dyn Matcher>;
}

impl<M: Matcher + Clone + 'static> CloneMatcher for M {
    fn clone_matcher(&self) -> Box<dyn Matcher> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Matcher> {
    fn clone(&self) -> Self {
        (**self).clone_matcher()
    }
}
