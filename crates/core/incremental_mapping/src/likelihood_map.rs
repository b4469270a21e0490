//! A map of all scans as a likelihood field: distance to the nearest wall, and which cells were observed.

use nalgebra::{Matrix2, Point2, Vector2};
use pr_geom::{SE2, math};
use pr_grid::{Cell, bresenham};

use crate::field::{FieldTiles, PointScore, PointScores};
use ch16_slam2d::cloud::PointCloud;

/// Largest number of cells of a map: 64 MB, 120 m × 120 m at 0.06 m if all of it is walls.
pub const MAX_MAP_CELLS: usize = 1 << 22;
/// Points farther from the body than this many cells are ignored.
const MAX_RAY_CELLS: f64 = 4096.0;
/// The field ends at this many standard deviations from a wall.
const REACH_SIGMAS: f64 = 3.0;
/// Resolution of the table of likelihoods for particles, in steps of the squared distance.
const TABLE_STEPS: usize = 512;

/// Cells and shape of a likelihood field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodMapConfig {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Standard deviation of a point's distance from its wall, m.
    pub sigma_m: f64,
    /// Half length of the wall segment drawn at a point with a normal, m.
    pub wall_m: f64,
    /// Likelihood of a point far from all walls, relative to 1 at a wall.
    pub floor: f64,
    /// Likelihood of a point in unseen space.
    pub unseen: f64,
}

impl LikelihoodMapConfig {
    /// The field for clouds with points `cell_m` apart.
    #[must_use]
    pub fn from_cell_size(cell_m: f64) -> Self {
        Self {
            cell_m: 0.5 * cell_m,
            sigma_m: 0.6 * cell_m,
            wall_m: cell_m,
            floor: 0.05,
            unseen: 0.3,
        }
    }

    fn far2_m2(&self) -> f64 {
        let far_m = REACH_SIGMAS * self.sigma_m;
        far_m * far_m
    }
}

/// State of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MapCell {
    /// Squared distance of its centre from the nearest wall, m², clamped at the field's end.
    distance2_m2: f64,
    /// Whether a ray has passed it.
    is_seen: bool,
}

/// The likelihood field of scans, `p(d) = exp(−d²/(2σ²)) + ε` at the distance d from a wall.
///
/// A wall segment is drawn at every point, perpendicular to its normal if it has one, so that
/// a scan can slide along. The squared distance is interpolated between the cells; the score of a
/// point is `ln p`.
#[derive(Clone, Debug)]
pub struct LikelihoodMap {
    config: LikelihoodMapConfig,
    cells: FieldTiles<MapCell>,
    /// Logarithms of likelihood ratios, by squared distance in steps of the field's end.
    log_ratios: Vec<f64>,
}

/// A likelihood field of the map, possibly with a smaller standard deviation.
#[derive(Clone, Copy, Debug)]
pub struct LikelihoodField<'a> {
    map: &'a LikelihoodMap,
    sigma_m: f64,
}

impl LikelihoodMap {
    /// An empty map.
    #[must_use]
    pub fn new(config: LikelihoodMapConfig) -> Self {
        let unknown = MapCell {
            distance2_m2: config.far2_m2(),
            is_seen: false,
        };
        Self {
            config,
            cells: FieldTiles::new(config.cell_m, unknown, MAX_MAP_CELLS),
            log_ratios: (0..=TABLE_STEPS)
                .map(|k| {
                    let distance2_m2 = config.far2_m2() * k as f64 / TABLE_STEPS as f64;
                    let hit = math::exp(-distance2_m2 / (2.0 * config.sigma_m * config.sigma_m));
                    math::ln((hit + config.floor) / config.unseen)
                })
                .collect(),
        }
    }

    /// The field with a custom standard deviation, at most the map's, m.
    #[must_use]
    pub fn field(&self, sigma_m: f64) -> LikelihoodField<'_> {
        LikelihoodField { map: self, sigma_m }
    }

    /// Removes all scans.
    pub fn clear(&mut self) {
        self.cells.clear();
    }

    /// Cell size and shape of the field.
    #[must_use]
    pub fn config(&self) -> &LikelihoodMapConfig {
        &self.config
    }

    /// Number of allocated cells.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// Adds a scan taken at `map_from_scan`: its walls, and the rays to them.
    pub fn insert(&mut self, scan: &PointCloud, map_from_scan: &SE2) {
        let rotation = map_from_scan.rotation();
        let origin = self.cells.cell_of(map_from_scan.position());
        for (index, point) in scan.iter().enumerate() {
            let at = map_from_scan.transform(point);
            let reach_m = math::norm2(point.x, point.y);
            // False for NaN, too.
            if reach_m < MAX_RAY_CELLS * self.config.cell_m {
                self.mark_seen(origin, self.cells.cell_of(at));
                let normal = scan.normal(index).unwrap_or_default();
                let (x, y) = rotation.rotate(normal.x, normal.y);
                self.draw_wall(at, Vector2::new(x, y));
            }
        }
    }

    /// Whether a ray has passed the cell of a point, or it lies at a wall.
    #[must_use]
    pub fn is_known(&self, point: Point2<f64>) -> bool {
        self.cells.get(self.cells.cell_of(point)).is_seen || self.is_at_a_wall(point)
    }

    /// Whether a point lies within two standard deviations of a wall.
    #[must_use]
    pub fn is_at_a_wall(&self, point: Point2<f64>) -> bool {
        let near_m = 2.0 * self.config.sigma_m;
        self.cells.get(self.cells.cell_of(point)).distance2_m2 < near_m * near_m
    }

    /// Log-likelihood ratio of a point to unseen space, at the nearest cell.
    #[must_use]
    pub fn log_ratio(&self, point: Point2<f64>) -> f64 {
        let cell = self.cells.get(self.cells.cell_of(point));
        let step = cell.distance2_m2 / self.config.far2_m2() * TABLE_STEPS as f64;
        let ratio = self.log_ratios[(step as usize).min(TABLE_STEPS)];
        // The back of a wall is never seen, but a point there is near it all the same.
        if cell.is_seen {
            ratio
        } else {
            math::max(ratio, 0.0)
        }
    }

    fn mark_seen(&mut self, from: (i32, i32), to: (i32, i32)) {
        let cell = |(column, row): (i32, i32)| Cell { column, row };
        for cell in bresenham(cell(from), cell(to)) {
            if let Some(cell) = self.cells.get_mut((cell.column, cell.row)) {
                cell.is_seen = true;
            }
        }
    }

    /// Lowers the distances of all cells around a wall segment.
    fn draw_wall(&mut self, at: Point2<f64>, normal: Vector2<f64>) {
        let has_normal = normal != Vector2::zeros();
        let half_m = if has_normal { self.config.wall_m } else { 0.0 };
        let along = Vector2::new(-normal.y, normal.x);
        let far_m = REACH_SIGMAS * self.config.sigma_m;
        let reach = Vector2::new(
            far_m + half_m * along.x.abs(),
            far_m + half_m * along.y.abs(),
        );
        let (first, last) = (
            self.cells.cell_of(at - reach),
            self.cells.cell_of(at + reach),
        );
        for row in first.1..=last.1 {
            for column in first.0..=last.0 {
                let gap = self.cells.center((column, row)) - at;
                let beyond_m = math::max(gap.dot(&along).abs() - half_m, 0.0);
                let distance2_m2 = if has_normal {
                    let across_m = gap.dot(&normal);
                    across_m * across_m + beyond_m * beyond_m
                } else {
                    gap.norm_squared()
                };
                if distance2_m2 < self.config.far2_m2()
                    && let Some(cell) = self.cells.get_mut((column, row))
                {
                    cell.distance2_m2 = math::min(cell.distance2_m2, distance2_m2);
                }
            }
        }
    }
}

impl PointScores for LikelihoodField<'_> {
    fn at(&self, point: Point2<f64>) -> PointScore {
        let sigma2 = self.sigma_m * self.sigma_m;
        let floor = self.map.config.floor;
        let found = self.map.cells.sample(point, |cell| cell.distance2_m2);
        let (q, slope) = (found.value, found.slope);
        let hit = math::exp(-q / (2.0 * sigma2));
        let share = hit / (hit + floor);
        // As a function of the distance d = √q the score has the curvature share/σ² along ∇d = ∇q/(2d).
        let steepness = share / (4.0 * sigma2 * math::max(q, 0.01 * sigma2));
        PointScore {
            score: math::ln(hit + floor),
            slope: slope * (-share / (2.0 * sigma2)),
            bend: Matrix2::new(
                slope.x * slope.x,
                slope.x * slope.y,
                slope.x * slope.y,
                slope.y * slope.y,
            ) * steepness,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::test_corner::corner;
    use crate::field::{ClimbConfig, ScanClimb};

    fn map() -> LikelihoodMap {
        let mut map = LikelihoodMap::new(LikelihoodMapConfig::from_cell_size(0.12));
        map.insert(&corner(), &SE2::new(0.3, -0.2, 0.4));
        map
    }

    const CLIMB: ClimbConfig = ClimbConfig {
        weight: 1.0,
        max_steps: 60,
        tolerance: 1e-7,
    };

    #[test]
    fn the_gradient_of_the_likelihood_agrees_with_finite_differences() {
        let (map, scan) = (map(), corner());
        let field = map.field(0.07);
        let climb = ScanClimb::new(&field, &scan, SE2::identity(), None, CLIMB);
        for pose in [SE2::new(0.35, -0.12, 0.45), SE2::new(0.2, -0.3, 0.33)] {
            let (value, slope) = climb.objective(&pose);
            assert!(value.is_finite() && slope.norm() > 1.0);
            for k in 0..3 {
                let step = 1e-6;
                let moved = |sign: f64| {
                    let mut delta = nalgebra::Vector3::zeros();
                    delta[k] = sign * step;
                    climb.objective(&pose.boxplus(&delta)).0
                };
                let difference = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                // 1e-4 of some hundreds: the second derivative jumps from cell to cell.
                assert!(
                    (difference - slope[k]).abs() < 1e-4 * slope.norm(),
                    "{k}: {difference} {}",
                    slope[k]
                );
            }
        }
    }

    #[test]
    fn a_known_shift_is_recovered_by_climbing() {
        let (map, scan) = (map(), corner());
        let truth = SE2::new(0.3, -0.2, 0.4);
        for shift in [SE2::new(0.1, -0.08, 0.03), SE2::new(-0.12, 0.1, -0.04)] {
            let found = ScanClimb::new(&map.field(0.07), &scan, truth * shift, None, CLIMB).run();
            let error = truth.between(&found.pose).log();
            // 0.005: a twelfth of a cell; the field is interpolated between centres.
            assert!(error.norm() < 0.005, "{error}");
        }
    }

    #[test]
    fn unseen_space_is_neutral_and_free_space_lowers_the_likelihood() {
        let map = map();
        let pose = SE2::new(0.3, -0.2, 0.4);
        let at = |x: f64, y: f64| map.log_ratio(pose.transform(Point2::new(x, y)));
        assert_eq!(at(0.0, -3.0), 0.0);
        assert!(at(0.0, -1.5) > 0.5);
        assert!(at(0.1, -0.8) < -1.0);
        assert!(map.is_known(pose.transform(Point2::new(0.1, -0.8))));
        assert!(map.is_at_a_wall(pose.transform(Point2::new(0.1, -1.6))));
    }

    #[test]
    fn overflowing_points_are_ignored() {
        let mut map = map();
        let before = map.cell_count();
        let far = [(1e300, 0.0), (f64::NAN, 1.0), (f64::INFINITY, -1.0)];
        let far: PointCloud = far.map(|(x, y)| Point2::new(x, y)).into_iter().collect();
        map.insert(&far, &SE2::identity());
        assert_eq!(map.cell_count(), before);
    }
}
