//! Loops between a keyframe and a finished submap.

use std::sync::Arc;

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use pr_optim::OptimizeError;

use super::finished::wall_pairs;
use super::{FinishedSubmap, SubmapConfig};
use crate::cloud::PointCloud;
use crate::field::ScanClimb;
use crate::icp::{INFORMATION_CAP, INFORMATION_RIDGE, Pair, regularize};
use crate::loops::{LoopCandidate, LoopConfig, LoopVerification, chi_squared_gate, rejection};
use crate::matching::{MatchRequest, MatchSummary, Matcher, MatcherKind, match_information};
use crate::metrics::position_error_m;
use crate::search::{
    LikelihoodConfig, ScanSearch, SearchMap, SearchNeighborhood, SearchResult, SearchWindow,
};

/// The finished submaps, and the memory of searching them.
///
/// A submap costs a byte for each cell; only the few that were searched last are kept ready.
#[derive(Clone)]
pub struct SubmapLoops {
    config: SubmapConfig,
    finished: Vec<FinishedSubmap>,
    ready: Vec<Ready>,
    pairs: Vec<Pair>,
}

/// A submap made ready to be searched.
#[derive(Clone)]
struct Ready {
    submap: usize,
    map: Option<Arc<SearchMap>>,
    nearest: Box<dyn Matcher>,
}

impl SubmapLoops {
    /// No submap is finished yet.
    #[must_use]
    pub fn new(config: SubmapConfig) -> Self {
        Self {
            config,
            finished: Vec::new(),
            ready: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// The finished submaps in the order of their anchors.
    #[must_use]
    pub fn finished(&self) -> &[FinishedSubmap] {
        &self.finished
    }

    /// Submaps that are kept ready to be searched.
    #[must_use]
    pub fn ready_count(&self) -> usize {
        self.ready.len()
    }

    /// Takes a submap that was finished.
    pub fn add(&mut self, submap: FinishedSubmap) {
        self.finished.push(submap);
    }

    /// The finished submaps that keyframe `node` may be found on, the nearest first: those with a
    /// keyframe within `radius_m` and none younger than `min_gap_nodes`. `poses` are the graph's.
    #[must_use]
    pub fn candidates(
        &self,
        poses: &[SE2],
        node: usize,
        radius_m: f64,
        min_gap_nodes: usize,
    ) -> Vec<(usize, LoopCandidate)> {
        let here = poses[node];
        let mut near = Vec::new();
        for (index, submap) in self.finished.iter().enumerate() {
            let youngest = submap.nodes.iter().copied().max().unwrap_or(submap.anchor);
            if youngest + min_gap_nodes > node {
                continue;
            }
            let distances = submap.nodes.iter();
            let distance_m = distances
                .map(|&old| position_error_m(&poses[old], &here))
                .fold(f64::INFINITY, math::min);
            if distance_m <= radius_m {
                let candidate = LoopCandidate {
                    node: submap.anchor,
                    distance_m,
                    proposal: None,
                };
                near.push((index, candidate));
            }
        }
        near.sort_by(|a, b| a.1.distance_m.total_cmp(&b.1.distance_m));
        near
    }

    /// Looks for a scan on finished submap `index` and tests what is found.
    ///
    /// All poses around the belief that the gate lets pass are searched; the best one climbs on the
    /// grid. `belief` is `submap_from_scan` by the graph.
    #[must_use]
    pub fn verify(
        &mut self,
        index: usize,
        (node, scan): (usize, &PointCloud),
        (candidate, belief): (LoopCandidate, SE2),
        gate_information: Result<Matrix3<f64>, OptimizeError>,
        loops: &LoopConfig,
    ) -> LoopVerification {
        let assumed = gate_information.unwrap_or_default();
        let found = self
            .window(&assumed, belief, loops)
            .and_then(|window| self.search(index, scan, &window));
        let summary = self.fit(index, scan, belief, found.as_ref(), loops);
        let information = match_information(&self.pairs, &summary.pose, &loops.trust);
        let innovation = belief.between(&summary.pose).log();
        let gate = chi_squared_gate(&innovation, &assumed, loops.gate_chi2);
        let limits = LoopConfig {
            min_score: math::max(loops.min_score, self.config.min_score),
            ..*loops
        };
        LoopVerification {
            from_node: node,
            candidate,
            belief,
            initial: found.map_or(belief, |found| found.best.pose),
            registered: summary.pose,
            rmse_m: summary.rmse_m,
            inliers: summary.inliers,
            iterations: summary.iterations,
            score: summary.score,
            margin: summary.margin(),
            innovation,
            gate_information: assumed,
            gate,
            information: regularize(information, INFORMATION_RIDGE, INFORMATION_CAP),
            rejection: rejection(&summary, gate, &limits).or(gate_information
                .err()
                .map(crate::loops::LoopRejection::NoCovariance)),
        }
    }

    /// What of the surroundings of the belief the gate lets pass; none where it has no bounds.
    fn window(
        &self,
        information: &Matrix3<f64>,
        belief: SE2,
        loops: &LoopConfig,
    ) -> Option<SearchWindow> {
        let covariance = information.try_inverse()?;
        let reach = |variance: f64| math::sqrt(loops.gate_chi2 * math::max(variance, 0.0));
        let half_m = reach(math::max(covariance.m11, covariance.m22));
        let most_m = 2.0 * loops.radius_m;
        let half_rad = math::min(reach(covariance.m33), self.config.max_turn_rad);
        Some(SearchWindow::around(
            belief,
            math::min(half_m, most_m),
            half_rad,
        ))
    }

    fn search(
        &mut self,
        index: usize,
        scan: &PointCloud,
        window: &SearchWindow,
    ) -> Option<SearchResult> {
        let min_score = 0.5 * self.config.min_score;
        let map = Arc::clone(self.ready(index).map.as_ref()?);
        let neighborhood = SearchNeighborhood::default();
        let search = ScanSearch::new(map, scan, window, &neighborhood).ok()?;
        search.with_min_score(min_score).run()
    }

    /// The climb from the best pose, and its fit with the ruler of every loop: distances to walls.
    fn fit(
        &mut self,
        index: usize,
        scan: &PointCloud,
        belief: SE2,
        found: Option<&SearchResult>,
        loops: &LoopConfig,
    ) -> MatchSummary {
        let grid = Arc::clone(&self.finished[index].grid);
        let (occupied, climb) = (self.config.occupied, self.config.climb);
        let (pose, steps) = match found {
            Some(found) => {
                let climbed = ScanClimb::new(&*grid, scan, found.best.pose, None, climb).run();
                (climbed.pose, climbed.steps)
            }
            None => (belief, 0),
        };
        let tau_m = if found.is_some() {
            loops.min_tau_m
        } else {
            0.0
        };
        let request = MatchRequest::new(pose, tau_m, 0);
        let fit = self.ready(index).nearest.register(scan, &request);
        wall_pairs(&*grid, scan, &pose, occupied, &mut self.pairs);
        MatchSummary {
            pose,
            iterations: steps,
            score: Some(self.pairs.len() as f64 / scan.len().max(1) as f64),
            runner_up: found.and_then(|found| found.runner_up).map(Into::into),
            ..fit
        }
    }

    /// A submap ready to be searched; the one that was searched longest ago makes room.
    fn ready(&mut self, index: usize) -> &mut Ready {
        let known = self.ready.iter().position(|ready| ready.submap == index);
        let ready = match known {
            Some(known) => self.ready.remove(known),
            None => {
                if self.ready.len() >= self.config.ready.max(1) {
                    self.ready.remove(0);
                }
                self.make_ready(index)
            }
        };
        self.ready.push(ready);
        let newest = self.ready.len() - 1;
        &mut self.ready[newest]
    }

    fn make_ready(&self, index: usize) -> Ready {
        let walls = self.finished[index].grid.occupied(self.config.occupied);
        let cell_m = self.config.grid.cell_m;
        let likelihood = LikelihoodConfig {
            cell_m,
            sigma_m: 1.5 * cell_m,
        };
        let map = crate::matching::MapConfig {
            cell_m: 4.0 * cell_m,
            max_per_cell: 16,
        };
        let mut nearest = MatcherKind::PointToPoint.build(&map);
        nearest.set_target(&walls);
        Ready {
            submap: index,
            map: SearchMap::build(&walls, likelihood).ok().map(Arc::new),
            nearest,
        }
    }
}
