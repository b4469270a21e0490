//! The strategy that finds loops.

use pr_optim::OptimizeError;

use super::mapper::{Consistency, Mapper};
use super::snapshot::SnapshotError;
use crate::loops::{LoopVerification, LoopWorkspace, PendingLoop};

/// Attempts to close loops at a keyframe.
#[derive(Clone, Debug, Default)]
pub struct TriedLoops {
    /// In order, accepted or not.
    pub found: Vec<LoopVerification>,
    /// Whether the accepted ones contradict the graph.
    pub consistency: Consistency,
}

/// Proposes loops and verifies them, with its own parameters and memory; it does not change the graph, but for
/// [`link_all`](Self::link_all).
///
/// The chapter's finder tests keyframes near in the graph, one at a time; that for recorded logs registers several
/// keyframes together on submaps.
pub trait LoopFinder: CloneFinder + Send {
    /// A search is due at every this many keyframes.
    fn every_keyframes(&self) -> usize;

    /// Searches for loops at the newest keyframe.
    fn find(&mut self, mapper: &mut Mapper) -> TriedLoops;

    /// Ends the run: searches at the newest keyframe unless that was done, and decides on the pending loops. `None`
    /// if the end of a run changes nothing.
    fn conclude(&mut self, _mapper: &mut Mapper, _is_searched: bool) -> Option<TriedLoops> {
        None
    }

    /// Links all keyframes again with the visits around them, in place of the loops. Returns the links, accepted or
    /// not.
    fn link_all(&mut self, _mapper: &mut Mapper) -> Vec<LoopVerification> {
        Vec::new()
    }

    /// Registers keyframe `new` on the surroundings of keyframe `old` and tests the result.
    ///
    /// # Errors
    /// If the graph has no covariance for the test.
    fn verify(
        &mut self,
        mapper: &mut Mapper,
        old: usize,
        new: usize,
    ) -> Result<LoopVerification, OptimizeError>;

    /// The pending loops, in order.
    fn pending(&self) -> &[PendingLoop] {
        &[]
    }

    /// Continues with the pending loops of a snapshot.
    ///
    /// # Errors
    /// If it keeps none.
    fn restore(&mut self, pending: &[PendingLoop]) -> Result<(), SnapshotError> {
        if pending.is_empty() {
            Ok(())
        } else {
            Err(SnapshotError::Numbers("list of pending loops"))
        }
    }

    /// Handles the removal of a keyframe, which decreases the index of later ones; `path_m` is the path length up to
    /// each remaining one.
    fn remove_keyframe(&mut self, node: usize, path_m: &[f64]);

    /// Submap and pairs of the last attempt, if it keeps them.
    fn workspace(&self) -> Option<&LoopWorkspace> {
        None
    }
}

/// A finder that can be cloned behind its trait; implemented for every `Clone` finder.
pub trait CloneFinder {
    /// A clone of this finder.
    fn clone_finder(&self) -> Box<dyn LoopFinder>;
}

impl<F: LoopFinder + Clone + 'static> CloneFinder for F {
    fn clone_finder(&self) -> Box<dyn LoopFinder> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn LoopFinder> {
    fn clone(&self) -> Self {
        (**self).clone_finder()
    }
}
