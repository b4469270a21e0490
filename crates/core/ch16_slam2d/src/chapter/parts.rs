//! The exchangeable parts of the chapter's estimator.

use std::sync::Arc;

use super::{ChapterConfig, DetectorKind, NearbyLoops, WindowRegistrar};
use crate::loops::{InnovationGate, LoopDetector, NearbyDetector};
use crate::matching::Matcher;
use crate::places::PlaceDetector;
use crate::slam::Strategies;

/// The exchangeable parts of the chapter's estimator.
#[derive(Clone)]
pub struct ChapterParts {
    /// Registers each scan on the local map.
    pub front_end: Box<dyn Matcher>,
    /// Registers a new keyframe on the submap of a loop candidate.
    pub loops: Box<dyn Matcher>,
    /// Proposes loops.
    pub detector: Box<dyn LoopDetector>,
    /// Tests the innovation of a loop in place of the drift gate.
    pub gate: Option<Arc<dyn InnovationGate>>,
}

impl ChapterParts {
    /// The parts that `config` selects.
    #[must_use]
    pub fn from_config(config: &ChapterConfig) -> Self {
        Self {
            front_end: config.matcher.build(&config.local_map),
            loops: config.loops.matcher.build(&config.loops.submap),
            detector: match config.detector {
                DetectorKind::Nearby => Box::new(NearbyDetector::new(config.loops)),
                DetectorKind::Place(places) => Box::new(PlaceDetector::new(places)),
            },
            gate: None,
        }
    }

    /// The chapter's strategies with these parts.
    #[must_use]
    pub fn into_strategies(self, config: &ChapterConfig) -> Strategies {
        Strategies {
            registrar: Box::new(WindowRegistrar::new(config, self.front_end)),
            finder: Box::new(NearbyLoops::new(
                config,
                self.detector,
                self.loops,
                self.gate,
            )),
            outlier_test: None,
        }
    }
}
