//! The strategies of an estimator.

use super::finder::LoopFinder;
use super::mapper::LoopOutlierTest;
use super::registrar::ScanRegistrar;

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
