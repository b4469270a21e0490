//! The chapter's loop closure: a detector proposes, a matcher registers on nearby keyframes, the drift gate tests.

use super::drift_gate::gate_information;
use crate::loops::{
    KeyframeView, LoopCandidate, LoopDetector, LoopQuery, LoopVerification, LoopWorkspace,
    verify_loop,
};
use crate::matching::Matcher;
use crate::slam::{Mapper, SlamConfig};

/// Verifies candidates in order and closes the first that passes.
#[derive(Clone)]
pub(crate) struct NearbyLoops {
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

    /// Verifies the candidates of the newest keyframe, up to the first that passes.
    pub fn find(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> Vec<LoopVerification> {
        let node = mapper.keyframes.len() - 1;
        let mut query = LoopQuery::new(&mut mapper.graph, &mapper.keyframes);
        let mut candidates = self.detector.detect(&mut query);
        candidates.retain(|candidate| candidate.node < node);
        let mut tried = Vec::new();
        for candidate in candidates
            .into_iter()
            .take(config.chapter.loops.candidates_tried)
        {
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
        let loops = &config.chapter.loops;
        let gate = gate_information(&mut mapper.graph, node, candidate.node, loops);
        let view = KeyframeView {
            poses: mapper.graph.poses(),
            keyframes: &mapper.keyframes,
        };
        let frame = config.chapter.information_frame;
        let workspace = &mut self.workspace;
        verify_loop(view, node, candidate, gate, frame, loops, workspace)
    }
}
