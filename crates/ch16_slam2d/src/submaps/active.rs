//! The two submaps that scans are added to.

use std::sync::Arc;

use nalgebra::Matrix3;
use pr_geom::{SE2, math};

use super::finished::wall_pairs;
use super::{FinishedSubmap, ProbabilityGrid, SubmapConfig};
use crate::cloud::PointCloud;
use crate::field::{PosePrior, ScanClimb};
use crate::icp::Pair;
use crate::matching::{MatchRequest, MatchStop, MatchSummary};
use crate::metrics::position_error_m;
use crate::search::{LikelihoodConfig, ScanSearch, SearchMap, SearchNeighborhood, SearchWindow};

/// A submap that scans are added to.
#[derive(Clone, Debug)]
pub struct ActiveSubmap {
    anchor: usize,
    nodes: Vec<usize>,
    /// Where its frame is by the front end: `world_from_submap`.
    pose: SE2,
    grid: ProbabilityGrid,
}

impl ActiveSubmap {
    /// The keyframe whose frame is the submap's.
    #[must_use]
    pub fn anchor(&self) -> usize {
        self.anchor
    }

    /// Where its frame is: `world_from_submap`.
    #[must_use]
    pub fn pose(&self) -> SE2 {
        self.pose
    }

    /// Its grid, in its own frame.
    #[must_use]
    pub fn grid(&self) -> &ProbabilityGrid {
        &self.grid
    }
}

/// At most two submaps that overlap: scans are registered against the older one and added to both.
///
/// Its memory is bounded by that of two grids.
#[derive(Clone, Debug)]
pub struct ActiveSubmaps {
    config: SubmapConfig,
    submaps: Vec<ActiveSubmap>,
    last_scan: Option<SE2>,
    finished: Option<FinishedSubmap>,
    pairs: Vec<Pair>,
}

impl ActiveSubmaps {
    /// No submap yet.
    #[must_use]
    pub fn new(config: SubmapConfig) -> Self {
        Self {
            config,
            submaps: Vec::new(),
            last_scan: None,
            finished: None,
            pairs: Vec::new(),
        }
    }

    /// The submaps, the older one first.
    #[must_use]
    pub fn submaps(&self) -> &[ActiveSubmap] {
        &self.submaps
    }

    /// Points of the last registration that lie at walls, world frame, with their normals.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Registers a scan against the older submap from the request's guess, `world_from_scan`, held
    /// there by `believed`, the information of the guess, 3×3. A step that climbs costs less than an
    /// iteration that looks for pairs, so there may be twice as many.
    ///
    /// Its score is the share of the scan that lies at walls; its fit is that in probability, as a part
    /// of the width of a wall, m.
    pub fn register(
        &mut self,
        scan: &PointCloud,
        request: &MatchRequest,
        believed: Option<Matrix3<f64>>,
    ) -> MatchSummary {
        let Some(submap) = self.submaps.first() else {
            return MatchSummary {
                pose: request.guess,
                rmse_m: f64::INFINITY,
                inliers: 0,
                iterations: 0,
                score: Some(0.0),
                runner_up: None,
                stop: MatchStop::Other("no submap"),
            };
        };
        let start = submap.pose.between(&request.guess);
        let prior = believed.map(|information| PosePrior {
            pose: start,
            information,
        });
        let mut climb = self.config.climb;
        climb.max_steps = climb.max_steps.min(2 * request.max_iterations);
        let mut found = ScanClimb::new(&submap.grid, scan, start, prior, climb).run();
        let occupied = self.config.occupied;
        wall_pairs(&submap.grid, scan, &found.pose, occupied, &mut self.pairs);
        let points = scan.len().max(1) as f64;
        if climb.max_steps > 0
            && (self.pairs.len() as f64) < self.config.good_score * points
            && let Some(elsewhere) = search(submap, scan, start, &self.config)
        {
            let second = ScanClimb::new(&submap.grid, scan, elsewhere, prior, climb).run();
            let mut pairs = Vec::with_capacity(self.pairs.len());
            wall_pairs(&submap.grid, scan, &second.pose, occupied, &mut pairs);
            if pairs.len() > self.pairs.len() {
                (found, self.pairs) = (second, pairs);
            }
        }
        for pair in &mut self.pairs {
            let at = submap.pose.transform(pair.source);
            (pair.source, pair.target) = (at, at);
            pair.normal = pair.normal.map(|normal| {
                let (x, y) = submap.pose.rotation().rotate(normal.x, normal.y);
                pr_geom::Vector2::new(x, y)
            });
        }
        let misfit = ScanClimb::new(&submap.grid, scan, found.pose, None, climb);
        let share = -misfit.objective(&found.pose).0 / (climb.weight * points);
        MatchSummary {
            pose: submap.pose * found.pose,
            rmse_m: 1.5 * self.config.grid.cell_m * math::sqrt(math::max(share, 0.0)),
            inliers: self.pairs.len(),
            iterations: found.steps,
            score: Some(self.pairs.len() as f64 / points),
            runner_up: None,
            stop: MatchStop::Other("climbed on the submap"),
        }
    }

    /// Adds a scan at `world_from_scan` to both submaps where it is far enough from the last one;
    /// whether it was. The older submap is finished by its last scan once there is a newer one.
    pub fn insert(
        &mut self,
        scan: &PointCloud,
        world_from_scan: &SE2,
        distance_m: f64,
        turn_rad: f64,
    ) -> bool {
        if let Some(last) = &self.last_scan
            && position_error_m(last, world_from_scan) < distance_m
            && last.between(world_from_scan).theta().abs() < turn_rad
        {
            return false;
        }
        self.last_scan = Some(*world_from_scan);
        for submap in &mut self.submaps {
            let grid_from_scan = submap.pose.between(world_from_scan);
            submap.grid.insert(scan, &grid_from_scan);
        }
        self.finish_the_older();
        true
    }

    /// Ties a keyframe to the submaps, and begins a new one there where the newest is half full;
    /// returns the anchors that it is tied to with the keyframe's pose in each one's frame.
    pub fn tie(&mut self, node: usize, scan: &PointCloud, pose: &SE2) -> Vec<(usize, SE2)> {
        let mut ties = Vec::with_capacity(2);
        for submap in &mut self.submaps {
            submap.nodes.push(node);
            ties.push((submap.anchor, submap.pose.between(pose)));
        }
        let half = self.config.scans.div_ceil(2);
        let newest = self.submaps.last();
        if newest.is_none_or(|newest| newest.grid.scans() >= half) && self.submaps.len() < 2 {
            let mut grid = ProbabilityGrid::new(self.config.grid);
            grid.insert(scan, &SE2::identity());
            self.submaps.push(ActiveSubmap {
                anchor: node,
                nodes: vec![node],
                pose: *pose,
                grid,
            });
            self.finish_the_older();
        }
        ties
    }

    /// The submap that was finished since this was asked last.
    pub fn take_finished(&mut self) -> Option<FinishedSubmap> {
        self.finished.take()
    }

    /// Moves everything by `correction`, applied on the left: a loop was closed.
    pub fn correct(&mut self, correction: &SE2) {
        for submap in &mut self.submaps {
            submap.pose = *correction * submap.pose;
        }
        self.last_scan = self.last_scan.map(|pose| *correction * pose);
    }

    fn finish_the_older(&mut self) {
        if self.submaps.len() < 2 || self.submaps[0].grid.scans() < self.config.scans {
            return;
        }
        let older = self.submaps.remove(0);
        self.finished = Some(FinishedSubmap {
            anchor: older.anchor,
            nodes: older.nodes,
            scans: older.grid.scans(),
            grid: Arc::new(older.grid.finish()),
        });
    }
}

/// The best pose around `start`, `submap_from_scan`, where the climb has ended on the wrong hill.
fn search(
    submap: &ActiveSubmap,
    scan: &PointCloud,
    start: SE2,
    config: &SubmapConfig,
) -> Option<SE2> {
    let walls = submap.grid.occupied(config.occupied);
    let cell_m = 2.0 * config.grid.cell_m;
    let likelihood = LikelihoodConfig {
        cell_m,
        sigma_m: cell_m,
    };
    let map = Arc::new(SearchMap::build(&walls, likelihood).ok()?);
    let window = SearchWindow::around(start, config.search_m, config.search_rad);
    let search = ScanSearch::new(map, scan, &window, &SearchNeighborhood::default()).ok()?;
    let found = search.with_min_score(0.5 * config.good_score).run()?;
    Some(found.best.pose)
}
