//! ICP as a matcher: a dense map of the target and a workspace, reused between calls.

use std::sync::Arc;

use pr_geom::SE2;

use super::{MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher};
use crate::cloud::{DenseMap, PointCloud};
use crate::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace, Increment, PairRejection};

/// ICP on a [`DenseMap`], point to point or point to plane.
#[derive(Clone)]
pub struct IcpMatcher {
    config: IcpConfig,
    map: DenseMap,
    workspace: IcpWorkspace,
    increment: Option<Arc<dyn Increment>>,
    rejection: Option<Arc<dyn PairRejection>>,
}

impl IcpMatcher {
    /// A matcher with the variant, tolerance, trimming and kernel of `config`; τ and the number of
    /// iterations come with each request.
    #[must_use]
    pub fn new(config: IcpConfig, map: &MapConfig) -> Self {
        Self {
            config,
            map: DenseMap::new(map.cell_m, map.max_per_cell),
            workspace: IcpWorkspace::new(),
            increment: None,
            rejection: None,
        }
    }

    /// A matcher of this variant with the chapter's settings.
    #[must_use]
    pub fn with_variant(variant: IcpVariant, map: &MapConfig) -> Self {
        let config = IcpConfig {
            variant,
            ..IcpConfig::default()
        };
        Self::new(config, map)
    }

    /// The same matcher with custom increments.
    #[must_use]
    pub fn with_increment(mut self, rule: Arc<dyn Increment>) -> Self {
        self.increment = Some(rule);
        self
    }

    /// The same matcher with only the pairs that a rule accepts.
    #[must_use]
    pub fn with_rejection(mut self, rule: Arc<dyn PairRejection>) -> Self {
        self.rejection = Some(rule);
        self
    }

    /// The settings for the registration of `request`.
    #[must_use]
    pub fn settings(&self, request: &MatchRequest) -> IcpConfig {
        IcpConfig {
            max_iterations: request.max_iterations,
            tau_m: request.tau_m,
            ..self.config
        }
    }

    /// The map of the target.
    #[must_use]
    pub fn map(&self) -> &DenseMap {
        &self.map
    }

    /// The pairs of `source` at `target_from_source`, by the rules of a registration.
    pub(super) fn fit(&mut self, source: &PointCloud, at: SE2, tau_m: f64) -> Match {
        self.register(source, &MatchRequest::new(at, tau_m, 0))
    }
}

impl Matcher for IcpMatcher {
    fn set_target(&mut self, target: &PointCloud) {
        self.map.rebuild(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match {
        let settings = self.settings(request);
        let Self {
            map,
            workspace,
            increment,
            rejection,
            ..
        } = self;
        let mut icp = Icp::new(source, map, request.guess, &settings, workspace);
        if let Some(rule) = increment {
            icp = icp.with_increment(&**rule);
        }
        if let Some(rule) = rejection {
            icp = icp.with_rejection(&**rule);
        }
        let found = icp.run();
        Match {
            summary: MatchSummary {
                pose: found.pose,
                rmse_m: found.rmse_m,
                inliers: found.inliers,
                iterations: found.iterations,
                score: None,
                runner_up: None,
                stop: MatchStop::Icp(found.stop),
            },
            pairs: workspace.pairs(map).collect(),
        }
    }
}
