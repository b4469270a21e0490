//! The loop closer: proposes loops, verifies them, and passes accepted ones to the map.

use super::bundle_loops::BundleLoops;
use super::config::{LoopClosure, SlamConfig};
use super::mapper::{Consistency, Mapper};
use crate::chapter::{NearbyLoops, SlamParts};
use crate::loops::{LoopVerification, LoopWorkspace, PendingLoop};

/// Robots search for loops at every this many keyframes: more often costs time and closes no more.
const EVERY_KEYFRAMES: usize = 3;

/// The kind of loop search.
#[derive(Clone)]
enum Finder {
    /// The chapter's: keyframes near in the graph, one at a time.
    Nearby(Box<NearbyLoops>),
    /// For robots: several keyframes together, on submaps.
    Bundle(Box<BundleLoops>),
}

/// Attempts to close loops at a keyframe.
#[derive(Clone, Debug)]
pub(super) struct TriedLoops {
    /// In order, accepted or not.
    pub found: Vec<LoopVerification>,
    /// Whether the accepted ones contradict the graph.
    pub consistency: Consistency,
}

/// Finds loops at keyframes and keeps the pending ones.
#[derive(Clone)]
pub struct LoopCloser {
    finder: Finder,
    /// The newest node at which loops were searched.
    pub(super) last_attempt_node: Option<usize>,
}

impl LoopCloser {
    pub(super) fn new(config: &SlamConfig, parts: SlamParts) -> Self {
        Self {
            finder: match &config.robot {
                Some(robot) => Finder::Bundle(Box::new(BundleLoops::new(robot))),
                None => Finder::Nearby(Box::new(NearbyLoops::new(parts.detector, parts.loops))),
            },
            last_attempt_node: None,
        }
    }

    /// Searches for loops at the newest keyframe, if a search is due.
    pub(super) fn find(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> TriedLoops {
        let mut tried = TriedLoops {
            found: Vec::new(),
            consistency: Consistency::Expected,
        };
        let node = mapper.keyframes.len() - 1;
        // The first keyframe has no predecessors, and does not count as an attempt.
        if config.loop_closure == LoopClosure::Off || node == 0 {
            return tried;
        }
        let every = match &config.robot {
            Some(_) => EVERY_KEYFRAMES,
            None => config.chapter.loops.attempt_every_nodes,
        };
        if self
            .last_attempt_node
            .is_some_and(|last| node - last < every)
        {
            return tried;
        }
        self.find_now(mapper, config, &mut tried);
        tried
    }

    fn find_now(&mut self, mapper: &mut Mapper, config: &SlamConfig, tried: &mut TriedLoops) {
        self.last_attempt_node = Some(mapper.keyframes.len() - 1);
        match &mut self.finder {
            Finder::Nearby(finder) => tried.found = finder.find(mapper, config),
            Finder::Bundle(finder) => (tried.found, tried.consistency) = finder.find(mapper),
        }
    }

    /// Ends the run: searches for loops at the newest keyframe if that was not done, and accepts the
    /// newest pending loop if no pending loop contradicts the graph.
    pub(super) fn conclude(&mut self, mapper: &mut Mapper, config: &SlamConfig) -> TriedLoops {
        let mut tried = TriedLoops {
            found: Vec::new(),
            consistency: Consistency::Expected,
        };
        let newest = mapper.keyframes.len().checked_sub(1);
        if config.loop_closure == LoopClosure::Off || newest.is_none_or(|newest| newest == 0) {
            return tried;
        }
        if config.robot.is_none() {
            return tried;
        }
        if self.last_attempt_node != newest {
            self.find_now(mapper, config, &mut tried);
        }
        if tried.found.iter().any(LoopVerification::accepted) {
            return tried;
        }
        let Finder::Bundle(finder) = &mut self.finder else {
            return tried;
        };
        let pending = core::mem::take(&mut finder.pending);
        let last = pending.last().filter(|last| last.is_expected);
        let is_alone = pending.iter().all(|other| other.is_expected);
        if let Some(last) = last.filter(|_| is_alone) {
            tried.found.push(last.verification);
        }
        tried
    }

    /// The pending loops, in order.
    #[must_use]
    pub fn pending(&self) -> &[PendingLoop] {
        match &self.finder {
            Finder::Nearby(_) => &[],
            Finder::Bundle(finder) => &finder.pending,
        }
    }

    /// Restores the pending loops of a snapshot.
    pub(super) fn restore(&mut self, last_attempt_node: Option<usize>, pending: &[PendingLoop]) {
        self.last_attempt_node = last_attempt_node;
        if let Finder::Bundle(finder) = &mut self.finder {
            finder.pending = pending.to_vec();
        }
    }

    /// Submap and pairs of the chapter's last attempt; `None` for robots.
    #[must_use]
    pub fn workspace(&self) -> Option<&LoopWorkspace> {
        match &self.finder {
            Finder::Nearby(finder) => Some(&finder.workspace),
            Finder::Bundle(_) => None,
        }
    }

    /// Handles the removal of a keyframe, which decreases the index of later ones; `path_m` is the path
    /// length up to each remaining one.
    pub(super) fn remove_keyframe(&mut self, node: usize, path_m: &[f64]) {
        let moved_up = |known: usize| known - usize::from(known > node);
        self.last_attempt_node = self.last_attempt_node.map(moved_up);
        match &mut self.finder {
            Finder::Nearby(finder) => finder.detector.remove_keyframe(node),
            Finder::Bundle(finder) => finder.remove_keyframe(node, path_m),
        }
    }
}
