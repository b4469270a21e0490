//! The exchangeable parts of the estimator.

use super::WindowRegistrar;
use crate::loops::{DetectorKind, LoopDetector, NearbyDetector};
use crate::matching::Matcher;
use crate::places::PlaceDetector;
use crate::slam::{MapMatching, ScanRegistrar, SlamConfig};

/// The exchangeable parts of the estimator.
#[derive(Clone)]
pub struct SlamParts {
    /// Registers each scan on the local map.
    pub front_end: Box<dyn Matcher>,
    /// Registers a new keyframe on the submap of a loop candidate.
    pub loops: Box<dyn Matcher>,
    /// Proposes loops.
    pub detector: Box<dyn LoopDetector>,
}

impl SlamParts {
    /// The parts that `config` selects.
    #[must_use]
    pub fn from_config(config: &SlamConfig) -> Self {
        let chapter = &config.chapter;
        Self {
            front_end: chapter.matcher.build(&chapter.local_map),
            loops: chapter.loops.matcher.build(&chapter.loops.submap),
            detector: match chapter.loops.detector {
                DetectorKind::Nearby => Box::new(NearbyDetector::new(chapter.loops)),
                DetectorKind::Place(places) => Box::new(PlaceDetector::new(places)),
            },
        }
    }

    /// The registrar of `config`, with this matcher if it uses one.
    pub(crate) fn registrar(&self, config: &SlamConfig) -> Box<dyn ScanRegistrar> {
        match &config.robot {
            Some(robot) => Box::new(MapMatching::new(*robot)),
            None => Box::new(WindowRegistrar::new(
                &config.chapter,
                self.front_end.clone(),
            )),
        }
    }
}
