//! The strategies of an estimator.

use super::config::SlamConfig;
use super::finder::LoopFinder;
use super::mapper::LoopOutlierTest;
use super::registrar::ScanRegistrar;
use crate::chapter::ChapterParts;
use crate::graph::PoseGraph;
use crate::local_map::{MapRegistrar, SubmapLoops};

/// The two strategies of an estimator, with their parameters, and its outlier test.
#[derive(Clone)]
pub struct Strategies {
    /// Registers each scan on the last few.
    pub registrar: Box<dyn ScanRegistrar>,
    /// Finds loops.
    pub finder: Box<dyn LoopFinder>,
    /// Runs over all loops once some contradict the graph; without it they stay, and the optimizer's kernel bounds
    /// their weight.
    pub outlier_test: Option<LoopOutlierTest>,
}

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
