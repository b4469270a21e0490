//! ICP as a matcher: a dense map of the target and a workspace, kept between calls.

use pr_geom::SE2;

use super::{MapConfig, MatchRequest, MatchStop, MatchSummary, Matcher};
use crate::cloud::{DenseMap, PointCloud};
use crate::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace, Pair};

/// ICP on a [`DenseMap`], point to point or point to plane.
#[derive(Clone)]
pub struct IcpMatcher {
    config: IcpConfig,
    map: DenseMap,
    workspace: IcpWorkspace,
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
        }
    }

    /// A matcher of this variant with the chapter's settings.
    #[must_use]
    pub fn of(variant: IcpVariant, map: &MapConfig) -> Self {
        let config = IcpConfig {
            variant,
            ..IcpConfig::default()
        };
        Self::new(config, map)
    }

    /// The settings of a registration that is asked for by `request`.
    #[must_use]
    pub fn settings(&self, request: &MatchRequest) -> IcpConfig {
        IcpConfig {
            max_iters: request.max_iterations,
            tau: request.tau_m,
            ..self.config
        }
    }

    /// The map of the target.
    #[must_use]
    pub fn map(&self) -> &DenseMap {
        &self.map
    }

    /// Mean over the source of `min(d², τ²)` at the last answer, m².
    pub(super) fn truncated_cost_m2(&self) -> f64 {
        let last = self.workspace.trace().last();
        last.map_or(f64::INFINITY, |trace| trace.truncated_cost_m2)
    }

    /// Forgets the last source: another one follows.
    pub(super) fn forget(&mut self) {
        self.workspace.forget();
    }

    /// [`Matcher::register`] for the source and the target of the last registration, from another guess
    /// or with another τ; for any source after [`forget`](Self::forget).
    pub(super) fn register_again(
        &mut self,
        source: &PointCloud,
        request: &MatchRequest,
    ) -> MatchSummary {
        let settings = self.settings(request);
        let found = Icp::again(
            source,
            &self.map,
            request.guess,
            &settings,
            &mut self.workspace,
        )
        .run();
        MatchSummary {
            pose: found.pose,
            rmse_m: found.rmse,
            inliers: found.inliers,
            iterations: found.iterations,
            score: None,
            runner_up: None,
            stop: MatchStop::Icp(found.stop),
        }
    }

    /// The pairs of `source` at `target_from_source`, counted as a registration counts them.
    pub(super) fn fit(&mut self, source: &PointCloud, at: SE2, tau_m: f64) -> MatchSummary {
        self.forget();
        self.fit_again(source, at, tau_m)
    }

    /// [`fit`](Self::fit) for the source of the last registration.
    pub(super) fn fit_again(&mut self, source: &PointCloud, at: SE2, tau_m: f64) -> MatchSummary {
        self.register_again(source, &MatchRequest::new(at, tau_m, 0))
    }
}

impl Matcher for IcpMatcher {
    fn set_target(&mut self, target: &PointCloud) {
        self.map.rebuild(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> MatchSummary {
        self.forget();
        self.register_again(source, request)
    }

    fn pairs(&self, pairs: &mut Vec<Pair>) {
        pairs.clear();
        pairs.extend(self.workspace.pairs(&self.map));
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::Point2;

    use super::*;

    #[test]
    fn what_is_remembered_of_neighbours_changes_no_bit() {
        // A wall with a bay, seen from within; points on either side of a cell's edge.
        let wall = (0..240).map(|k| {
            let along = 0.03 * f64::from(k);
            let bay = if (80..150).contains(&k) { 0.6 } else { 0.0 };
            Point2::new(along, 1.4 + bay)
        });
        let mut map: PointCloud = wall.collect();
        map.estimate_normals(0.2);
        let scan = map.transformed(&SE2::new(-3.0, 0.1, 0.2));
        let settings = MapConfig {
            cell_m: 0.135,
            max_per_cell: 6,
        };
        let mut fresh = IcpMatcher::of(IcpVariant::PointToPlane, &settings);
        let mut again = fresh.clone();
        fresh.set_target(&map);
        again.set_target(&map);
        let guess = SE2::new(3.1, 0.1, -0.3);
        let requests = [
            (guess, 0.6, 10),
            (guess, 0.15, 10),
            (SE2::new(2.0, -0.4, 0.1), 0.3, 4),
            (SE2::new(40.0, 0.0, 0.0), 0.6, 10),
            (guess, 0.6, 0),
            (guess, 2.0, 25),
        ];
        for (guess, tau_m, max_iterations) in requests {
            let request = MatchRequest::new(guess, tau_m, max_iterations);
            let expected = fresh.register(&scan, &request);
            assert_eq!(again.register_again(&scan, &request), expected);
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            again.pairs(&mut ours);
            fresh.pairs(&mut theirs);
            assert_eq!(ours, theirs);
            assert_eq!(again.truncated_cost_m2(), fresh.truncated_cost_m2());
        }
        assert!(again.fit_again(&scan, guess, 0.6).inliers > 100);
    }
}
