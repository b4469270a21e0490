//! What of the estimator can be exchanged.

use super::SlamConfig;
use crate::loops::{DetectorKind, LoopDetector, NearbyDetector};
use crate::matching::Matcher;
use crate::places::PlaceDetector;

/// The parts of the estimator that can be exchanged.
#[derive(Clone)]
pub struct SlamParts {
    /// Registers each scan on the local map.
    pub front_end: Box<dyn Matcher>,
    /// Registers a new keyframe on the submap of a loop's candidate.
    pub loops: Box<dyn Matcher>,
    /// Proposes loops.
    pub detector: Box<dyn LoopDetector>,
}

impl SlamParts {
    /// The parts that `config` names.
    #[must_use]
    pub fn of(config: &SlamConfig) -> Self {
        Self {
            front_end: config.matcher.build(&config.local_map),
            loops: config.loops.matcher.build(&config.loops.submap),
            detector: match config.loops.detector {
                DetectorKind::Nearby => Box::new(NearbyDetector::new(config.loops)),
                DetectorKind::Place(places) => Box::new(PlaceDetector::new(places)),
            },
        }
    }
}
