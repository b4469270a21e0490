//! How probably each cell is occupied, and how a scan lies there.

use nalgebra::{Matrix2, Point2, Vector2};
use pr_geom::{SE2, math};
use pr_grid::{Cell, bresenham, probability_to_log_odds};

use crate::cloud::PointCloud;
use crate::field::{FieldSample, PointScore, PointScores, TiledGrid};

/// Most cells of a grid: 16 MB, 60 m × 60 m at 0.06 m. Scans beyond add nothing.
pub const MAX_GRID_CELLS: usize = 1 << 20;
/// Points farther from the body than so many cells draw no ray: they are nobody's.
const MAX_RAY_CELLS: f64 = 4096.0;

/// Cells of a probability grid, and what a scan says of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridConfig {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// A point with a normal stands for so much wall on either side, m.
    pub wall_m: f64,
    /// Probability of a cell that one scan says is occupied.
    pub hit: f64,
    /// Probability of a cell that one scan looks through.
    pub miss: f64,
    /// Probabilities stay between this and 1 minus this; unknown cells have it.
    pub least: f64,
}

impl Default for GridConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.06,
            wall_m: 0.12,
            hit: 0.65,
            miss: 0.45,
            least: 0.05,
        }
    }
}

/// A cell: its log odds, and the last scan that spoke of it. The default is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct GridCell {
    log_odds: f64,
    scan: u32,
}

/// A grid of probabilities that grows where scans look.
///
/// A scan says of every cell one thing: hit where a wall runs through it, else missed where a ray does.
/// `l ← l + ln(p / (1 − p))`, clamped. A wall is drawn at every point, along its normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbabilityGrid {
    config: GridConfig,
    cells: TiledGrid<GridCell>,
    scans: u32,
}

/// A finished grid: a byte for each cell.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedGrid {
    cells: TiledGrid<u8>,
}

impl ProbabilityGrid {
    /// An unknown grid.
    #[must_use]
    pub fn new(config: GridConfig) -> Self {
        Self {
            config,
            cells: TiledGrid::new(config.cell_m, GridCell::default(), MAX_GRID_CELLS),
            scans: 0,
        }
    }

    /// Scans added.
    #[must_use]
    pub fn scans(&self) -> usize {
        self.scans as usize
    }

    /// Cells that take memory.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// Adds a scan taken at `grid_from_scan`.
    pub fn insert(&mut self, scan: &PointCloud, grid_from_scan: &SE2) {
        self.scans += 1;
        let rotation = grid_from_scan.rotation();
        let origin = self.cells.cell_of(grid_from_scan.position());
        let change = probability_to_log_odds(self.config.hit);
        let is_near = |point: &Point2<f64>| {
            // Also false where it is no number.
            math::norm2(point.x, point.y) < MAX_RAY_CELLS * self.config.cell_m
        };
        let near: Vec<(usize, Point2<f64>)> = scan
            .iter()
            .enumerate()
            .filter(|(_, point)| is_near(point))
            .map(|(index, point)| (index, grid_from_scan.transform(point)))
            .collect();
        // Walls first: what one beam hits, another one beside it does not look through.
        for &(index, at) in &near {
            let (normal_x, normal_y) = scan.raw_normal(index);
            let (x, y) = rotation.rotate(normal_x, normal_y);
            let along = Vector2::new(-y, x) * self.config.wall_m;
            let (from, to) = (
                self.cells.cell_of(at - along),
                self.cells.cell_of(at + along),
            );
            self.update(from, to, change);
        }
        let change = probability_to_log_odds(self.config.miss);
        for &(_, at) in &near {
            let to = self.cells.cell_of(at);
            self.update(origin, to, change);
        }
    }

    /// Whether a point lies in a cell at least so probably occupied.
    #[must_use]
    pub fn is_occupied(&self, point: Point2<f64>, probability: f64) -> bool {
        self.probability(self.cells.get(self.cells.cell_of(point))) >= probability
    }

    /// The centres of the cells that are at least so probably occupied, in the grid's frame.
    #[must_use]
    pub fn occupied(&self, probability: f64) -> PointCloud {
        let log_odds = probability_to_log_odds(probability);
        let cells = self.cells.cells();
        let walls = cells.filter(|(_, cell)| cell.scan > 0 && cell.log_odds >= log_odds);
        walls.map(|(cell, _)| self.cells.center(cell)).collect()
    }

    /// The grid as it is, a byte for each cell.
    #[must_use]
    pub fn finish(&self) -> FinishedGrid {
        let byte = |cell| (255.0 * self.probability(cell) + 0.5) as u8;
        let unknown = byte(GridCell::default());
        let mut cells = TiledGrid::new(self.config.cell_m, unknown, MAX_GRID_CELLS);
        for (place, cell) in self.cells.cells() {
            if let Some(finished) = cells.get_mut(place) {
                *finished = byte(cell);
            }
        }
        FinishedGrid { cells }
    }

    fn probability(&self, cell: GridCell) -> f64 {
        if cell.scan == 0 {
            return self.config.least;
        }
        1.0 / (1.0 + math::exp(-cell.log_odds))
    }

    fn update(&mut self, from: (i32, i32), to: (i32, i32), change: f64) {
        let limit = -probability_to_log_odds(self.config.least);
        let cell = |(column, row): (i32, i32)| Cell { column, row };
        for cell in bresenham(cell(from), cell(to)) {
            if let Some(known) = self.cells.get_mut((cell.column, cell.row))
                && known.scan != self.scans
            {
                known.scan = self.scans;
                known.log_odds = (known.log_odds + change).clamp(-limit, limit);
            }
        }
    }
}

impl FinishedGrid {
    /// The centres of the cells that are at least so probably occupied, in the grid's frame.
    #[must_use]
    pub fn occupied(&self, probability: f64) -> PointCloud {
        let cells = self.cells.cells();
        let walls = cells.filter(|(_, byte)| f64::from(*byte) >= 255.0 * probability);
        walls.map(|(cell, _)| self.cells.center(cell)).collect()
    }

    /// Cells that take memory, a byte each.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }
}

/// `−(1 − M)²`, whose bend is that of Gauss and Newton.
fn misfit(found: FieldSample) -> PointScore {
    let gap = 1.0 - found.value;
    let slope = found.slope;
    PointScore {
        score: -gap * gap,
        slope: slope * (2.0 * gap),
        bend: Matrix2::new(
            slope.x * slope.x,
            slope.x * slope.y,
            slope.x * slope.y,
            slope.y * slope.y,
        ) * 2.0,
    }
}

impl PointScores for ProbabilityGrid {
    fn at(&self, point: Point2<f64>) -> PointScore {
        misfit(self.cells.sample(point, |cell| self.probability(cell)))
    }
}

impl PointScores for FinishedGrid {
    fn at(&self, point: Point2<f64>) -> PointScore {
        misfit(self.cells.sample(point, |byte| f64::from(byte) / 255.0))
    }
}

/// Grids in which a point lies at a wall or not.
pub(super) trait Walls: PointScores {
    /// Whether the cell of a point or one beside it is at least so probably occupied.
    fn is_wall(&self, point: Point2<f64>, probability: f64) -> bool;
}

/// Whether `test` is true of the cell of a point or of one of the eight beside it.
fn around<T: Copy>(cells: &TiledGrid<T>, point: Point2<f64>, test: impl Fn(T) -> bool) -> bool {
    let (column, row) = cells.cell_of(point);
    let near = |center: i32, step: i32| center.saturating_add(step);
    (-1..=1).any(|j| (-1..=1).any(|i| test(cells.get((near(column, i), near(row, j))))))
}

impl Walls for ProbabilityGrid {
    fn is_wall(&self, point: Point2<f64>, probability: f64) -> bool {
        let log_odds = probability_to_log_odds(probability);
        around(&self.cells, point, |cell| {
            cell.scan > 0 && cell.log_odds >= log_odds
        })
    }
}

impl Walls for FinishedGrid {
    fn is_wall(&self, point: Point2<f64>, probability: f64) -> bool {
        around(&self.cells, point, |byte| {
            f64::from(byte) >= 255.0 * probability
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::test_corner::corner;
    use crate::field::{ClimbConfig, ScanClimb};
    use nalgebra::Vector3;

    fn truth() -> SE2 {
        SE2::new(0.3, -0.2, 0.4)
    }

    fn grid() -> ProbabilityGrid {
        let mut grid = ProbabilityGrid::new(GridConfig::default());
        for _ in 0..12 {
            grid.insert(&corner(), &truth());
        }
        grid
    }

    const CLIMB: ClimbConfig = ClimbConfig {
        weight: 1.0,
        max_steps: 60,
        tolerance: 1e-7,
    };

    #[test]
    fn the_gradient_on_the_grid_is_that_of_differences() {
        let (grid, scan) = (grid(), corner());
        let finished = grid.finish();
        let climb = ScanClimb::new(&grid, &scan, SE2::identity(), None, CLIMB);
        let on_bytes = ScanClimb::new(&finished, &scan, SE2::identity(), None, CLIMB);
        for pose in [SE2::new(0.34, -0.17, 0.42), SE2::new(0.25, -0.26, 0.37)] {
            let (_, slope) = climb.objective(&pose);
            assert!(slope.norm() > 1.0);
            // A byte for each cell is off by 1/510.
            assert!((on_bytes.objective(&pose).1 - slope).norm() < 0.03 * slope.norm());
            for k in 0..3 {
                let step = 1e-7;
                let moved = |sign: f64| {
                    let mut delta = Vector3::zeros();
                    delta[k] = sign * step;
                    climb.objective(&pose.boxplus(&delta)).0
                };
                let difference = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                // 1e-5: the second derivative jumps from cell to cell, and 1e-15 · 60 / 1e-7.
                assert!((difference - slope[k]).abs() < 1e-5 * slope.norm(), "{k}");
            }
        }
    }

    #[test]
    fn a_known_shift_is_recovered_on_the_grid_and_on_its_bytes() {
        let (grid, scan) = (grid(), corner());
        let finished = grid.finish();
        for shift in [SE2::new(0.06, -0.05, 0.02), SE2::new(-0.05, 0.06, -0.03)] {
            let start = truth() * shift;
            let found = ScanClimb::new(&grid, &scan, start, None, CLIMB).run();
            let bytes = ScanClimb::new(&finished, &scan, start, None, CLIMB).run();
            for pose in [found.pose, bytes.pose] {
                let error = truth().between(&pose).log();
                // 0.015 m: a quarter of a cell; walls are as sharp as their cells.
                assert!(error.norm() < 0.015, "{error}");
            }
        }
    }

    #[test]
    fn walls_are_occupied_what_was_looked_through_is_free_and_the_rest_unknown() {
        let grid = grid();
        let at = |x: f64, y: f64| truth().transform(Point2::new(x, y));
        assert!(grid.is_occupied(at(-0.02, -1.5), 0.9));
        // Twelve scans of ln(0.45/0.55) each.
        assert!(!grid.is_occupied(at(0.1, -0.8), 0.1));
        // Unknown: the least probability, and no more.
        assert!(grid.is_occupied(at(0.0, -3.0), 0.05) && !grid.is_occupied(at(0.0, -3.0), 0.06));
        let walls = grid.finish().occupied(0.5);
        assert!(walls.len() > 80);
        assert!(walls.iter().all(|point| grid.is_occupied(point, 0.49)));
    }

    #[test]
    fn memory_is_bounded_whatever_comes_in() {
        let mut grid = ProbabilityGrid::new(GridConfig {
            cell_m: 0.01,
            ..GridConfig::default()
        });
        for k in 0..200 {
            let around = (0..40).map(|beam| {
                let (sin, cos) = math::sin_cos(f64::from(beam) * 0.157);
                Point2::new(30.0 * cos, 30.0 * sin)
            });
            grid.insert(
                &around.collect(),
                &SE2::translation(50.0 * f64::from(k), 0.0),
            );
        }
        assert!(grid.cell_count() <= MAX_GRID_CELLS);
        let before = grid.cell_count();
        let far = [(1e300, 0.0), (f64::NAN, 1.0), (f64::INFINITY, -1.0)];
        let far: PointCloud = far.map(|(x, y)| Point2::new(x, y)).into_iter().collect();
        grid.insert(&far, &SE2::identity());
        assert_eq!(grid.cell_count(), before);
    }
}
