//! The search of a whole window as a matcher: converges from any guess whose window contains the pose.

use core::f64::consts::PI;
use std::sync::Arc;

use pr_geom::math;

use super::{
    IcpMatcher, MapConfig, Match, MatchRequest, MatchStop, MatchSummary, Matcher, RunnerUp,
};
use crate::cloud::PointCloud;
use crate::icp::IcpConfig;
use crate::search::{
    LikelihoodConfig, ScanSearch, ScoredPose, SearchMap, SearchNeighborhood, SearchWindow,
};

/// The window of a [`SearchMatcher`], and the refinement of its result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchMatcherConfig {
    /// Cells and blur of the target.
    pub grid: LikelihoodConfig,
    /// Half the window's width around the guess, along x and along y, m.
    pub half_width_m: f64,
    /// Half its range of headings around the guess, rad; π is the full turn.
    pub half_turn_rad: f64,
    /// Poses this near to the best one are not distinct.
    pub neighborhood: SearchNeighborhood,
    /// A best pose with a lower score, 0 to 1, is no match: the result has no pairs then.
    pub min_score: f64,
    /// The registration from the best pose; its τ is used, the number of iterations comes with each request.
    pub refine: IcpConfig,
}

impl Default for SearchMatcherConfig {
    /// ± 3 m and every heading, refined by ICP with a τ of six cells.
    fn default() -> Self {
        Self {
            grid: LikelihoodConfig::default(),
            half_width_m: 3.0,
            half_turn_rad: PI,
            neighborhood: SearchNeighborhood::default(),
            min_score: 0.5,
            refine: IcpConfig {
                tau_m: 0.3,
                ..IcpConfig::default()
            },
        }
    }
}

/// Branch and bound over the window around the guess, then ICP from the best pose.
///
/// The search is as accurate as its cells; ICP refines its result. Both use the target's points, and the fit is
/// measured as for every matcher: by the distance to the nearest point closer than the request's τ. If the target
/// is empty or too large for a grid, the result is the fit at the guess.
#[derive(Clone)]
pub struct SearchMatcher {
    config: SearchMatcherConfig,
    map: Option<Arc<SearchMap>>,
    icp: IcpMatcher,
}

impl SearchMatcher {
    /// A matcher without a target; `map` is that of the points for ICP.
    #[must_use]
    pub fn new(config: SearchMatcherConfig, map: &MapConfig) -> Self {
        Self {
            config,
            map: None,
            icp: IcpMatcher::new(config.refine, map),
        }
    }

    /// The target in the form of the search.
    #[must_use]
    pub fn map(&self) -> Option<&Arc<SearchMap>> {
        self.map.as_ref()
    }

    fn search(&self, source: &PointCloud, request: &MatchRequest) -> Option<ScanSearch> {
        let SearchMatcherConfig {
            half_width_m,
            half_turn_rad,
            neighborhood,
            ..
        } = self.config;
        let window = SearchWindow::around(request.guess, half_width_m, half_turn_rad);
        let search = ScanSearch::new(
            Arc::clone(self.map.as_ref()?),
            source,
            &window,
            &neighborhood,
        );
        let min_score = math::max(self.config.min_score, request.min_score);
        Some(search.ok()?.with_min_score(min_score))
    }
}

impl Matcher for SearchMatcher {
    fn set_target(&mut self, target: &PointCloud) {
        self.map = SearchMap::build(target, self.config.grid)
            .ok()
            .map(Arc::new);
        self.icp.set_target(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match {
        let Some(search) = self.search(source, request) else {
            return not_found(self.icp.fit(source, request.guess, request.tau_m));
        };
        let Some(found) = search.run() else {
            return not_found(self.icp.fit(source, request.guess, 0.0));
        };
        let near = MatchRequest {
            guess: found.best.pose,
            tau_m: self.config.refine.tau_m,
            ..*request
        };
        let refined = self.icp.register(source, &near).summary;
        let mut answer = self.icp.fit(source, refined.pose, request.tau_m);
        answer.summary = MatchSummary {
            iterations: refined.iterations,
            score: Some(found.best.score),
            runner_up: found.runner_up.map(RunnerUp::from),
            stop: MatchStop::Searched {
                poses: found.counts.scored() as usize,
            },
            ..answer.summary
        };
        answer
    }
}

/// The fit at the guess, which no search supports.
fn not_found(mut at_guess: Match) -> Match {
    at_guess.summary.stop = MatchStop::NotFound;
    at_guess
}

impl From<ScoredPose> for RunnerUp {
    fn from(ScoredPose { pose, score }: ScoredPose) -> Self {
        Self { pose, score }
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::{Point2, SE2};

    use super::*;

    const MAP: MapConfig = MapConfig {
        cell_m: 0.25,
        max_per_cell: 8,
    };

    /// Two walls and a post, without rotational symmetry.
    fn corner() -> PointCloud {
        let long = (0..60).map(|k| Point2::new(0.05 * f64::from(k), 0.0));
        let short = (0..30).map(|k| Point2::new(0.0, 0.05 * f64::from(k)));
        let post = [Point2::new(1.2, 0.9), Point2::new(1.25, 0.9)];
        long.chain(short).chain(post).collect()
    }

    #[test]
    fn the_search_converges_from_a_guess_outside_of_icps_basin() {
        let target = corner();
        let truth = SE2::new(1.1, -0.7, 2.4);
        let source = target.transformed(&truth.inverse());
        let request = MatchRequest::new(SE2::identity(), 1.0, 30);
        let mut icp = IcpMatcher::new(IcpConfig::default(), &MAP);
        icp.set_target(&target);
        let lost = truth
            .between(&icp.register(&source, &request).summary.pose)
            .log();
        assert!(lost.norm() > 0.5, "ICP ends {lost} away");

        let mut search = SearchMatcher::new(SearchMatcherConfig::default(), &MAP);
        search.set_target(&target);
        let found = search.register(&source, &request).summary;
        let error = truth.between(&found.pose).log();
        // 0.05: points lie 5 cm apart, and a point may end between two others.
        assert!(error.norm() < 0.05, "{error}");
        assert_eq!(found.inliers, target.len());
        assert!(found.margin().unwrap() > 0.1);
        assert!(matches!(found.stop, MatchStop::Searched { poses } if poses > 0));
    }

    #[test]
    fn a_search_ends_early_if_the_minimum_score_is_unreachable() {
        let target = corner();
        let mut search = SearchMatcher::new(SearchMatcherConfig::default(), &MAP);
        search.set_target(&target);
        // Forty unmapped points of another corner: two thirds of the scan fit.
        let other = target.transformed(&SE2::new(8.0, 5.0, 1.0));
        let scan: PointCloud = target.iter().chain(other.iter().take(40)).collect();
        let request = MatchRequest::new(SE2::new(0.2, 0.1, 0.1), 1.0, 30);
        let found = search.register(&scan, &request).summary;
        let score = found.score.unwrap();
        assert!(score > 0.6 && score < 0.8, "{score}");
        let none = search.register(&scan, &request.with_min_score(0.8)).summary;
        assert_eq!((none.score, none.inliers), (None, 0));
        let same = search.register(&scan, &request.with_min_score(0.6)).summary;
        let answer = |found: &MatchSummary| (found.pose, found.score, found.runner_up);
        assert_eq!(answer(&same), answer(&found));
    }

    #[test]
    fn a_poor_fit_has_no_pairs_and_an_empty_target_returns_the_guess() {
        let request = MatchRequest::new(SE2::new(0.1, 0.2, 0.3), 0.6, 30);
        let mut search = SearchMatcher::new(SearchMatcherConfig::default(), &MAP);
        let alone = search.register(&corner(), &request).summary;
        assert_eq!((alone.pose, alone.inliers), (request.guess, 0));
        assert!(!alone.stop.is_supported());
        search.set_target(&[Point2::new(0.0, 0.0)].into_iter().collect());
        let poor = search.register(&corner(), &request).summary;
        assert_eq!((poor.score, poor.inliers), (None, 0));
        assert_eq!(poor.stop, MatchStop::NotFound);
    }
}
