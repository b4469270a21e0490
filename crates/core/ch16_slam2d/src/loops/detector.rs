//! The interface for place recognition of any kind.

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::OptimizeError;

use super::{LoopCandidate, LoopConfig, detect_loop_candidates};
use crate::cloud::PointCloud;
use crate::graph::{Keyframe, PoseGraph};

/// Input of a detector.
pub struct LoopQuery<'a> {
    graph: &'a mut PoseGraph,
    keyframes: &'a [Keyframe],
}

impl<'a> LoopQuery<'a> {
    /// The graph and its keyframes; node k is keyframe k.
    #[must_use]
    pub fn new(graph: &'a mut PoseGraph, keyframes: &'a [Keyframe]) -> Self {
        Self { graph, keyframes }
    }

    /// The node for which loops are searched: the newest.
    #[must_use]
    pub fn node(&self) -> usize {
        self.keyframes.len().saturating_sub(1)
    }

    /// Poses of all keyframes in the graph, `world_from_body`.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        self.graph.poses()
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        self.keyframes
    }

    /// The thinned scan of a keyframe with its normals, body frame.
    ///
    /// # Panics
    /// If the keyframe does not exist.
    #[must_use]
    pub fn scan(&self, node: usize) -> &PointCloud {
        &self.keyframes[node].scan
    }

    /// Exact covariance of the pose of `new` in the frame of `old`; see [`PoseGraph::relative_covariance`].
    /// Computed on demand.
    ///
    /// # Errors
    /// If the graph has none.
    ///
    /// # Panics
    /// If a node does not exist.
    pub fn relative_covariance(
        &mut self,
        old: usize,
        new: usize,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        self.graph.relative_covariance(old, new)
    }
}

/// Proposes old keyframes that may show the same location as the newest.
///
/// A proposal is not yet a loop: every candidate is registered and gated.
pub trait LoopDetector: CloneDetector + Send {
    /// Candidates for the newest keyframe, best first.
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate>;

    /// Handles the removal of a keyframe, which decreases the index of later ones. A detector that
    /// stores keyframes by index has to remove it.
    fn remove_keyframe(&mut self, _node: usize) {}
}

/// A detector that can be cloned behind its trait; implemented for every `Clone` detector.
pub trait CloneDetector {
    /// A clone of this detector.
    fn clone_detector(&self) -> Box<dyn LoopDetector>;
}

impl<D: LoopDetector + Clone + 'static> CloneDetector for D {
    fn clone_detector(&self) -> Box<dyn LoopDetector> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn LoopDetector> {
    fn clone(&self) -> Self {
        (**self).clone_detector()
    }
}

/// The chapter's detector: old keyframes that are near in the graph, see [`detect_loop_candidates`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearbyDetector {
    config: LoopConfig,
}

impl NearbyDetector {
    /// A detector with the radius and the gap of `config`.
    #[must_use]
    pub fn new(config: LoopConfig) -> Self {
        Self { config }
    }
}

impl LoopDetector for NearbyDetector {
    fn detect(&mut self, query: &mut LoopQuery<'_>) -> Vec<LoopCandidate> {
        detect_loop_candidates(query.poses(), query.node(), &self.config)
    }
}
