//! NDT as a matcher: registration on Gaussians, fit measured on points.

use super::{IcpMatcher, MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher};
use crate::cloud::PointCloud;
use crate::icp::IcpVariant;
use crate::ndt::{NdtAlign, NdtConfig, NdtMap};

/// The cells and the solver of an [`NdtMatcher`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NdtMatcherConfig {
    /// Width of a cell, m: about the width of the basin of convergence.
    pub cell_m: f64,
    /// Smallest number of points of a cell.
    pub min_points: usize,
    /// Damping and tolerance; the number of iterations comes with each request.
    pub solver: NdtConfig,
}

impl Default for NdtMatcherConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.6,
            min_points: 4,
            solver: NdtConfig::default(),
        }
    }
}

/// NDT on the Gaussians of the target.
///
/// The score alone does not measure the fit, because it grows with the number of points. The fit is
/// therefore measured as for ICP, by the distance to the nearest point closer than τ, and the tests of
/// a loop are comparable between matchers.
#[derive(Clone)]
pub struct NdtMatcher {
    config: NdtMatcherConfig,
    gaussians: Option<NdtMap>,
    ruler: IcpMatcher,
}

impl NdtMatcher {
    /// A matcher without a target; `map` is that of the points for measuring the fit.
    #[must_use]
    pub fn new(config: NdtMatcherConfig, map: &MapConfig) -> Self {
        Self {
            config,
            gaussians: None,
            ruler: IcpMatcher::with_variant(IcpVariant::PointToPoint, map),
        }
    }
}

impl Matcher for NdtMatcher {
    fn set_target(&mut self, target: &PointCloud) {
        let NdtMatcherConfig {
            cell_m, min_points, ..
        } = self.config;
        self.gaussians = Some(NdtMap::build(target, cell_m, min_points));
        self.ruler.set_target(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match {
        let Some(gaussians) = &self.gaussians else {
            return self.ruler.fit(source, request.guess, request.tau_m);
        };
        let solver = NdtConfig {
            max_iterations: request.max_iterations,
            ..self.config.solver
        };
        let mut registration = NdtAlign::new(source, gaussians, request.guess, &solver);
        let (found, stop) = loop {
            let step = registration.step();
            if let Some(stop) = step.stop {
                break (step, stop);
            }
        };
        let mut answer = self.ruler.fit(source, found.pose, request.tau_m);
        answer.summary = MatchSummary {
            iterations: registration.iterations(),
            score: Some(found.score),
            stop: MatchStop::Ndt(stop),
            ..answer.summary
        };
        answer
    }
}
