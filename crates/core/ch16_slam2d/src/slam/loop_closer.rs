//! The loop closer: searches for loops at keyframes, if a search is due.

use super::finder::{LoopFinder, TriedLoops};
use super::mapper::Mapper;
use super::snapshot::SnapshotError;
use crate::config::{LoopClosure, SlamConfig};
use crate::loops::PendingLoop;

/// When loops are searched, with the strategy that finds them.
#[derive(Clone)]
pub struct LoopCloser {
    pub(super) finder: Box<dyn LoopFinder>,
    /// The newest node at which loops were searched.
    pub(super) last_attempt_node: Option<usize>,
}

impl LoopCloser {
    pub(super) fn new(finder: Box<dyn LoopFinder>) -> Self {
        Self {
            finder,
            last_attempt_node: None,
        }
    }

    /// Searches for loops at the newest keyframe, if a search is due.
    pub(super) fn find(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> TriedLoops {
        let Some(node) = mapper.newest() else {
            return TriedLoops::default();
        };
        let every = self.finder.every_keyframes();
        let is_early = |last: usize| node - last < every;
        // The first keyframe has no predecessors, and does not count as an attempt.
        if config.loop_closure == LoopClosure::Off
            || node == 0
            || self.last_attempt_node.is_some_and(is_early)
        {
            return TriedLoops::default();
        }
        self.last_attempt_node = Some(node);
        self.finder.find(mapper)
    }

    /// Ends the run.
    pub(super) fn conclude(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> TriedLoops {
        let newest = mapper.newest();
        if config.loop_closure == LoopClosure::Off || newest.is_none_or(|newest| newest == 0) {
            return TriedLoops::default();
        }
        let is_searched = self.last_attempt_node == newest;
        let Some(tried) = self.finder.conclude(mapper, is_searched) else {
            return TriedLoops::default();
        };
        self.last_attempt_node = newest;
        tried
    }

    /// The pending loops, in order.
    #[must_use]
    pub fn pending(&self) -> &[PendingLoop] {
        self.finder.pending()
    }

    /// Continues with the state of a snapshot.
    pub(super) fn restore(
        &mut self,
        last_attempt_node: Option<usize>,
        pending: &[PendingLoop],
    ) -> Result<(), SnapshotError> {
        self.last_attempt_node = last_attempt_node;
        self.finder.restore(pending)
    }

    /// Handles the removal of a keyframe, which decreases the index of later ones; `path_m` is the path
    /// length up to each remaining one.
    pub(super) fn remove_keyframe(&mut self, node: usize, path_m: &[f64]) {
        let moved_up = |known: usize| known - usize::from(known > node);
        self.last_attempt_node = self.last_attempt_node.map(moved_up);
        self.finder.remove_keyframe(node, path_m);
    }
}
