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

/// Candidates are verified in order, and the first that passes is closed.
#[derive(Clone)]
pub(super) struct NearbyLoops {
    pub detector: Box<dyn LoopDetector>,
    pub workspace: LoopWorkspace,
}

impl NearbyLoops {
    pub fn new(detector: Box<dyn LoopDetector>, matcher: Box<dyn Matcher>) -> Self {
        Self {
            detector,
            workspace: LoopWorkspace::new(matcher),
        }
    }

    /// The candidates of the newest keyframe that were verified, up to the first that passes.
    pub fn find(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> Vec<LoopVerification> {
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
