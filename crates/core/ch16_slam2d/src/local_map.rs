//! The surroundings of a robot: a few scans in one frame, as target of registrations and to score poses.
//!
//! [`LocalMap::register`] minimizes one cost from a start, the chapter's `p(z|s) p(s|u, ŝ)`: the squared
//! point-to-plane distances with Huber's kernel, and the motion prior of the odometry. Normals are
//! estimated from the points of all scans, on demand: with normals from single scans, whose beams are
//! a degree apart, the heading drifts twice as much.
//!
//! [`LocalMap::fit`] is the score for comparing poses. A point costs its squared distance to
//! the map, truncated at a miss. Free space counts as well: a point behind everything that was seen costs less
//! than one in space that a scan has observed as free.

mod linking;
mod locate;
mod pairwise_consistency;
mod prior;
mod range_profile;
mod registrar;
mod registration;
mod scan_profiles;
mod submap_loops;
mod submaps;
mod walls;

use core::ops::Range;
use std::sync::Arc;

use nalgebra::{Point2, Vector2};
use pr_geom::{SE2, math};

pub use prior::{MotionPrior, PriorTail};
pub use range_profile::RangeProfile;
pub(crate) use registrar::MapRegistrar;
pub use registration::{MapRegistration, Registered};
pub use scan_profiles::ScanProfiles;
pub(crate) use submap_loops::SubmapLoops;

use crate::cloud::{DenseMap, MAX_FLATNESS, MIN_NEIGHBORS, NearestMap, PointCloud};
use crate::config::tuning;
pub use crate::config::{LocalMapConfig, MapRegistrationConfig, OdometryNoise, SubmapLoopConfig};
use crate::search::{
    LikelihoodConfig, ScanSearch, SearchMap, SearchNeighborhood, SearchResult, SearchWindow,
};

/// Side of a cell, m, and points that it keeps: twice as many do not reduce the error.
const CELLS: (f64, usize) = (0.135, 8);

/// Cells and blur of a search, m; registration refines its result.
const SEARCH_GRID: LikelihoodConfig = LikelihoodConfig {
    cell_m: 0.1,
    sigma_m: 0.1,
};
/// Smallest score of a search result, 0 to 1: unseen space counts as a miss there.
pub(crate) const MIN_SEARCH_SCORE: f64 = 0.4;

/// A point's normal, computed when a registration needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Normal {
    Unknown,
    Estimated(Option<Vector2<f64>>),
}

/// Fit of a scan at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapFit {
    /// 1 if every point lies on the map, 0 if every point is a miss in free space.
    pub score: f64,
    /// Points closer to the map than a miss.
    pub inliers: usize,
    /// Points in space that a scan has observed as free.
    pub contradicting: usize,
    /// Root mean square distance of those, m; infinite without any.
    pub rmse_m: f64,
}

/// Points of a few scans with their normals, and the free space of the scans.
#[derive(Clone, Debug)]
pub struct LocalMap {
    cloud: PointCloud,
    points: DenseMap,
    normals: Vec<Normal>,
    views: Vec<View>,
    /// The points and the walls through them, built when they are needed.
    walls: Option<DenseMap>,
}

/// A scan of the map.
#[derive(Clone, Debug)]
struct View {
    body_from_map: SE2,
    profile: Arc<RangeProfile>,
    /// Indices of its points in the cloud.
    points: Range<usize>,
}

impl Default for LocalMap {
    fn default() -> Self {
        Self {
            cloud: PointCloud::default(),
            points: DenseMap::new(CELLS.0, CELLS.1),
            normals: Vec::new(),
            views: Vec::new(),
            walls: None,
        }
    }
}

impl LocalMap {
    /// Replaces the contents by these scans, each with its `map_from_body`, and keeps the memory.
    pub fn rebuild<'a>(
        &mut self,
        scans: impl IntoIterator<Item = (SE2, &'a PointCloud, &'a Arc<RangeProfile>)>,
    ) {
        self.cloud.clear();
        self.views.clear();
        for (map_from_body, scan, profile) in scans {
            let first = self.cloud.len();
            self.cloud.extend_transformed(scan, &map_from_body);
            self.views.push(View {
                body_from_map: map_from_body.inverse(),
                profile: Arc::clone(profile),
                points: first..self.cloud.len(),
            });
        }
        self.points.rebuild(&self.cloud);
        self.walls = None;
        self.normals.clear();
        self.normals.resize(self.points.len(), Normal::Unknown);
    }

    /// All points of the scans, map frame.
    #[must_use]
    pub fn cloud(&self) -> &PointCloud {
        &self.cloud
    }

    /// The fit of `scan` at `map_from_scan`.
    #[must_use]
    pub fn fit(
        &self,
        scan: &PointCloud,
        map_from_scan: &SE2,
        config: &MapRegistrationConfig,
    ) -> MapFit {
        self.fit_on(&self.points, scan, map_from_scan, config)
    }

    /// The fit of `scan` at `map_from_scan` on the walls through the points.
    ///
    /// At a grazing angle the returns of a scan are far apart. Along a corridor, a scan meets those of the last one where
    /// that was taken, and falls between them where it was taken itself, so [`LocalMap::fit`] favours a robot at rest.
    pub(crate) fn fit_on_walls(
        &mut self,
        scan: &PointCloud,
        map_from_scan: &SE2,
        config: &MapRegistrationConfig,
    ) -> MapFit {
        let walls = self.walls.take().unwrap_or_else(|| self.build_walls());
        let fit = self.fit_on(&walls, scan, map_from_scan, config);
        self.walls = Some(walls);
        fit
    }

    fn build_walls(&self) -> DenseMap {
        let mut points = self.cloud.clone();
        for view in &self.views {
            let scan = view.points.clone().map(|index| self.cloud.point(index));
            let body_from_map = &view.body_from_map;
            let mut between = PointCloud::default();
            walls::add_between(scan.map(|at| body_from_map.transform(at)), &mut between);
            points.extend_transformed(&between, &body_from_map.inverse());
        }
        DenseMap::from_cloud(&points, CELLS.0, CELLS.1)
    }

    fn fit_on(
        &self,
        points: &DenseMap,
        scan: &PointCloud,
        map_from_scan: &SE2,
        config: &MapRegistrationConfig,
    ) -> MapFit {
        let miss_m2 = config.inlier_distance_m * config.inlier_distance_m;
        let (mut cost, mut squares_m2) = (0.0, 0.0);
        let (mut inliers, mut contradicting) = (0_usize, 0_usize);
        let mut last_found = None;
        for point in scan.iter() {
            let at = map_from_scan.transform(point);
            match points.neighbor_from(at, config.inlier_distance_m, last_found) {
                Some(nearest) => {
                    squares_m2 += nearest.distance_squared_m2;
                    inliers += 1;
                    last_found = Some(nearest.index);
                }
                None if self.is_free(at) => contradicting += 1,
                None => cost += config.unseen_cost,
            }
        }
        cost += contradicting as f64 + squares_m2 / miss_m2;
        let rmse_m = if inliers == 0 {
            f64::INFINITY
        } else {
            math::sqrt(squares_m2 / inliers as f64)
        };
        MapFit {
            score: 1.0 - cost / scan.len().max(1) as f64,
            inliers,
            contradicting,
            rmse_m,
        }
    }

    /// The best pose of `scan` in a window, by branch and bound, and the best distinct one if its score is lower
    /// by at most `margin`, 0 to 1; `None` if no pose fits, or if the points need too large a grid.
    #[must_use]
    pub fn search(
        &self,
        scan: &PointCloud,
        window: &SearchWindow,
        margin: f64,
    ) -> Option<SearchResult> {
        let map = Arc::new(SearchMap::build(&self.cloud, SEARCH_GRID).ok()?);
        let search = ScanSearch::new(map, scan, window, &SearchNeighborhood::default()).ok()?;
        let search = search.with_min_score(MIN_SEARCH_SCORE);
        search.with_margin(margin).run()
    }

    /// Whether any scan has observed a point as free, newest scans first.
    fn is_free(&self, at: Point2<f64>) -> bool {
        let mut views = self.views.iter().rev();
        views.any(|view| {
            let seen = view.body_from_map.transform(at);
            view.profile.sees_through(seen)
        })
    }

    /// The normal of point `index`, estimated on first use.
    fn normal(&mut self, index: usize, radius_m: f64) -> Option<Vector2<f64>> {
        match self.normals[index] {
            Normal::Estimated(normal) => normal,
            Normal::Unknown => {
                let normal = self.estimate_normal(index, radius_m);
                self.normals[index] = Normal::Estimated(normal);
                normal
            }
        }
    }

    /// The direction of least scatter of the points around one; `None` if they are not a wall.
    fn estimate_normal(&self, index: usize, radius_m: f64) -> Option<Vector2<f64>> {
        let center = self.points.point(index);
        let (xs, ys) = (self.points.xs(), self.points.ys());
        let (mut count, mut sum) = (0.0, Vector2::<f64>::zeros());
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        self.points.for_each_within(center, radius_m, |near| {
            let (dx, dy) = (xs[near] - center.x, ys[near] - center.y);
            count += 1.0;
            sum += Vector2::new(dx, dy);
            xx += dx * dx;
            xy += dx * dy;
            yy += dy * dy;
        });
        if count < MIN_NEIGHBORS as f64 {
            // A far wall of few beams: the normal of its own scan used a larger radius.
            return self.points.normal(index);
        }
        xx -= sum.x * sum.x / count;
        xy -= sum.x * sum.y / count;
        yy -= sum.y * sum.y / count;
        let (middle, half_gap) = (0.5 * (xx + yy), math::norm2(0.5 * (xx - yy), xy));
        let (across, along) = (middle - half_gap, middle + half_gap);
        if along <= 0.0 || across > MAX_FLATNESS * along {
            return None;
        }
        // The direction of most scatter is half the angle of (xx − yy, 2 xy).
        let (sin, cos) = math::sin_cos(0.5 * math::atan2(2.0 * xy, xx - yy));
        Some(Vector2::new(-sin, cos))
    }
}

#[cfg(test)]
mod tests;
