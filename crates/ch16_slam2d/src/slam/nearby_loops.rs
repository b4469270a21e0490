//! The chapter's loops: a detector proposes, a matcher registers on the keyframes around, the drift decides.

use nalgebra::Matrix3;
use pr_optim::OptimizeError;

use super::config::SlamConfig;
use super::mapper::Mapper;
use crate::graph::PoseGraph;
use crate::loops::{
    GateModel, KeyframeView, LoopCandidate, LoopConfig, LoopDetector, LoopQuery, LoopVerification,
    LoopWorkspace, marginal_information, path_information, verify_loop,
};
use crate::matching::Matcher;
use crate::submaps::{FinishedSubmap, FrontEndKind, SubmapLoops};

/// Candidates are verified in order, and the first that passes is closed.
#[derive(Clone)]
pub(super) struct NearbyLoops {
    pub detector: Box<dyn LoopDetector>,
    pub workspace: LoopWorkspace,
    /// The finished submaps, where the front end makes some.
    pub submaps: Option<SubmapLoops>,
}

impl NearbyLoops {
    pub fn new(
        config: &SlamConfig,
        detector: Box<dyn LoopDetector>,
        matcher: Box<dyn Matcher>,
    ) -> Self {
        Self {
            detector,
            workspace: LoopWorkspace::new(matcher),
            submaps: match config.front_end {
                FrontEndKind::Window => None,
                FrontEndKind::Submaps(submaps) => Some(SubmapLoops::new(submaps)),
            },
        }
    }

    /// Keeps a submap that the front end has finished.
    pub fn keep(&mut self, finished: Option<FinishedSubmap>) {
        if let (Some(submaps), Some(finished)) = (&mut self.submaps, finished) {
            submaps.add(finished);
        }
    }

    /// The candidates of the newest keyframe that were verified, up to the first that passes.
    pub fn find(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> Vec<LoopVerification> {
        if self.submaps.is_some() {
            return self.find_on_submaps(mapper, &config.loops);
        }
        let node = mapper.keyframes.len() - 1;
        let mut query = LoopQuery::new(&mut mapper.graph, &mapper.keyframes);
        let mut candidates = self.detector.detect(&mut query);
        candidates.retain(|candidate| candidate.node < node);
        let mut tried = Vec::new();
        for candidate in candidates.into_iter().take(config.loops.candidates_tried) {
            let found = self.verify(mapper, node, candidate, config);
            tried.push(found);
            if found.accepted() {
                break;
            }
        }
        tried
    }

    fn verify(
        &mut self,
        mapper: &mut Mapper,
        node: usize,
        candidate: LoopCandidate,
        config: &SlamConfig,
    ) -> LoopVerification {
        let gate = gate_information(&mut mapper.graph, node, candidate.node, &config.loops);
        let view = KeyframeView {
            poses: mapper.graph.poses(),
            keyframes: &mapper.keyframes,
        };
        let frame = config.information_frame;
        let workspace = &mut self.workspace;
        verify_loop(view, node, candidate, gate, frame, &config.loops, workspace)
    }

    /// Looks for the newest keyframe on the finished submaps around it, the nearest first.
    fn find_on_submaps(
        &mut self,
        mapper: &mut Mapper,
        loops: &LoopConfig,
    ) -> Vec<LoopVerification> {
        let mut tried = Vec::new();
        let Some(submaps) = &mut self.submaps else {
            return tried;
        };
        let node = mapper.keyframes.len() - 1;
        let poses = mapper.graph.poses();
        let candidates = submaps.candidates(poses, node, loops.radius_m, loops.min_gap_nodes);
        for (index, candidate) in candidates.into_iter().take(loops.candidates_tried) {
            let gate = gate_information(&mut mapper.graph, node, candidate.node, loops);
            let poses = mapper.graph.poses();
            let belief = poses[candidate.node].between(&poses[node]);
            let scan = &*mapper.keyframes[node].scan;
            let found = submaps.verify(index, (node, scan), (candidate, belief), gate, loops);
            tried.push(found);
            if found.accepted() {
                break;
            }
        }
        tried
    }
}

/// The S⁻¹ of the gate between two nodes.
fn gate_information(
    graph: &mut PoseGraph,
    node: usize,
    candidate: usize,
    loops: &LoopConfig,
) -> Result<Matrix3<f64>, OptimizeError> {
    match loops.gate_model {
        GateModel::PathApproximation => Ok(path_information(node - candidate, loops)),
        GateModel::ExactMarginal => marginal_information(graph, candidate, node),
    }
}
