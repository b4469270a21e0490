//! Builds an estimator from its parameters: the one file that knows the strategies of both systems.

use crate::chapter::ChapterParts;
use crate::config::SlamConfig;
use crate::graph::PoseGraph;
use crate::local_map::{MapRegistrar, SubmapLoops};
use crate::slam::{Slam, SlamSnapshot, SnapshotError, Strategies};

impl Strategies {
    /// The strategies that `config` selects: those for recorded logs, or the chapter's.
    #[must_use]
    pub fn from_config(config: &SlamConfig) -> Self {
        match &config.local_map {
            Some(robot) => Self {
                registrar: Box::new(MapRegistrar::new(*robot)),
                finder: Box::new(SubmapLoops::new(robot)),
                outlier_test: Some(PoseGraph::inlier_edges),
            },
            None => ChapterParts::from_config(&config.chapter).into_strategies(&config.chapter),
        }
    }
}

impl Slam {
    /// An estimator without frames, with the strategies that `config` selects.
    #[must_use]
    pub fn new(config: SlamConfig) -> Self {
        let strategies = Strategies::from_config(&config);
        Self::with(config, strategies)
    }

    /// The chapter's estimator with custom matchers and a custom loop detector.
    #[must_use]
    pub fn with_parts(config: SlamConfig, parts: ChapterParts) -> Self {
        let strategies = parts.into_strategies(&config.chapter);
        Self::with(config, strategies)
    }

    /// An estimator that continues from a snapshot, with the strategies of its parameters.
    ///
    /// # Errors
    /// If the snapshot is inconsistent.
    pub fn restore(snapshot: &SlamSnapshot) -> Result<Self, SnapshotError> {
        Self::restore_with(snapshot, Strategies::from_config(&snapshot.config))
    }
}
