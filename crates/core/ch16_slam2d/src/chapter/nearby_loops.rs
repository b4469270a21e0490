//! The chapter's loop closure: a detector proposes, a matcher registers on nearby keyframes, the drift gate tests.

use std::sync::Arc;

use pr_optim::OptimizeError;

use super::ChapterConfig;
use super::drift_gate::gate_information;
use crate::loops::{
    InnovationGate, KeyframeView, LoopCandidate, LoopDetector, LoopVerification, LoopWorkspace,
    verify_loop,
};
use crate::matching::Matcher;
use crate::metrics::position_error_m;
use crate::slam::{LoopFinder, Mapper, TriedLoops};

/// Verifies candidates in order and closes the first that passes.
#[derive(Clone)]
pub(crate) struct NearbyLoops {
    config: ChapterConfig,
    detector: Box<dyn LoopDetector>,
    workspace: LoopWorkspace,
    gate: Option<Arc<dyn InnovationGate>>,
}

impl NearbyLoops {
    pub fn new(
        config: &ChapterConfig,
        detector: Box<dyn LoopDetector>,
        matcher: Box<dyn Matcher>,
        gate: Option<Arc<dyn InnovationGate>>,
    ) -> Self {
        Self {
            config: config.clone(),
            detector,
            workspace: LoopWorkspace::new(matcher),
            gate,
        }
    }

    fn test(
        &mut self,
        mapper: &mut Mapper,
        node: usize,
        candidate: LoopCandidate,
    ) -> LoopVerification {
        let loops = &self.config.loops;
        let gate = gate_information(mapper.graph_mut(), node, candidate.node, loops);
        let view = KeyframeView {
            poses: mapper.poses(),
            keyframes: mapper.keyframes(),
        };
        let frame = self.config.information_frame;
        let workspace = &mut self.workspace;
        let found = verify_loop(view, node, candidate, gate, frame, loops, workspace);
        match &self.gate {
            Some(gate) => found.with_gate_chi2(gate.chi2(&found.innovation, found.gap(), loops)),
            None => found,
        }
    }
}

impl LoopFinder for NearbyLoops {
    fn every_keyframes(&self) -> usize {
        self.config.loops.attempt_every_nodes
    }

    /// Tests the candidates of the newest keyframe, up to the first that passes.
    fn find(&mut self, mapper: &mut Mapper) -> TriedLoops {
        let mut query = mapper.loop_query();
        let node = query.node();
        let mut candidates = self.detector.detect(&mut query);
        candidates.retain(|candidate| candidate.node < node);
        candidates.truncate(self.config.loops.candidates_tried);
        let mut tried = TriedLoops::default();
        for candidate in candidates {
            let found = self.test(mapper, node, candidate);
            tried.found.push(found);
            if found.accepted() {
                break;
            }
        }
        tried
    }

    fn verify(
        &mut self,
        mapper: &mut Mapper,
        old: usize,
        new: usize,
    ) -> Result<LoopVerification, OptimizeError> {
        let candidate = LoopCandidate {
            node: old,
            distance_m: position_error_m(&mapper.poses()[old], &mapper.poses()[new]),
            proposal: None,
        };
        Ok(self.test(mapper, new, candidate))
    }

    fn remove_keyframe(&mut self, node: usize, _: &[f64]) {
        self.detector.remove_keyframe(node);
    }

    fn workspace(&self) -> Option<&LoopWorkspace> {
        Some(&self.workspace)
    }
}
