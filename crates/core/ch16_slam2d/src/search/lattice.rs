//! The poses of a window on a lattice.

use core::f64::consts::{PI, TAU};

use pr_geom::{SE2, math, sort_numbers};

use super::{LikelihoodGrid, SearchError, SearchNeighborhood, SearchWindow};
use crate::cloud::PointCloud;

/// One point in this many may lie beyond the reach that determines the angular step.
const POINTS_FOR_AN_OUTLIER: usize = 50;

/// Most cells from the window's centre to its edge.
const MAX_HALF_CELLS: f64 = 8192.0;

/// Most headings of a window.
const MAX_HEADINGS: f64 = 65536.0;

/// A pose of the lattice: steps from its first heading, row and column.
///
/// Poses are ordered by heading, then row, then column; of equal scores the first one wins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct LatticePose {
    pub heading: i32,
    pub row: i32,
    pub column: i32,
}

/// The poses of a window: whole cells in x and y, equal steps in the heading.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    center: SE2,
    cell_m: f64,
    step_rad: f64,
    /// Whether the last heading is one step before the first one.
    is_whole_turn: bool,
    half_columns: i32,
    half_rows: i32,
    half_headings: i32,
    pub columns: i32,
    pub rows: i32,
    pub headings: i32,
}

/// A neighbourhood in steps of the lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    cells: i32,
    headings: i32,
}

impl Lattice {
    /// The poses of `window` for `scan`: a step of the heading moves its farthest point by a cell.
    ///
    /// `cos Δθ = 1 − r²/(2 d²)` for cells of r and a reach of d (Hess et al. 2016, eq. (7)), which is
    /// `sin Δθ/2 = r/(2 d)`. One point in fifty, and at least one, may lie beyond d, because a single stray
    /// return must not double the work. The steps divide a full turn evenly.
    pub fn new(
        window: &SearchWindow,
        scan: &PointCloud,
        grid: &LikelihoodGrid,
    ) -> Result<Self, SearchError> {
        let cell_m = grid.config().cell_m;
        let rejected = SearchError::Window {
            half_x_m: window.half_x_m,
            half_y_m: window.half_y_m,
            half_turn_rad: window.half_turn_rad,
        };
        let center = window.center.to_array();
        if !center.iter().all(|value| value.is_finite())
            || window.half_turn_rad.is_nan()
            || window.half_turn_rad < 0.0
        {
            return Err(rejected);
        }
        let cells = |half_m: f64| {
            let cells = (half_m / cell_m - 1e-9).ceil().max(0.0);
            let is_searchable = half_m >= 0.0 && cells <= MAX_HALF_CELLS;
            if is_searchable {
                Ok(cells as i32)
            } else {
                Err(rejected)
            }
        };
        let (half_columns, half_rows) = (cells(window.half_x_m)?, cells(window.half_y_m)?);
        let step_rad = angular_step_rad(robust_reach_m(scan)?, cell_m);
        let is_whole_turn = window.half_turn_rad >= PI;
        let (headings, half_headings, step_rad) = if is_whole_turn {
            let headings = (TAU / step_rad).ceil().min(MAX_HEADINGS);
            (headings as i32, headings as i32 / 2, TAU / headings)
        } else {
            let half = (window.half_turn_rad / step_rad - 1e-9).ceil().max(0.0);
            if 2.0 * half + 1.0 > MAX_HEADINGS {
                return Err(rejected);
            }
            (2 * half as i32 + 1, half as i32, step_rad)
        };
        Ok(Self {
            center: window.center,
            cell_m,
            step_rad,
            is_whole_turn,
            half_columns,
            half_rows,
            half_headings,
            columns: 2 * half_columns + 1,
            rows: 2 * half_rows + 1,
            headings,
        })
    }

    /// Number of poses.
    pub fn len(&self) -> u64 {
        self.columns as u64 * self.rows as u64 * self.headings as u64
    }

    /// The window's centre, m.
    pub fn center_m(&self) -> (f64, f64) {
        (self.center.x(), self.center.y())
    }

    /// Cells from the window's centre to a column and a row.
    pub fn cells_from_center(&self, column: i32, row: i32) -> [i32; 2] {
        [column - self.half_columns, row - self.half_rows]
    }

    /// The last pose.
    pub fn last(&self) -> LatticePose {
        LatticePose {
            heading: self.headings - 1,
            row: self.rows - 1,
            column: self.columns - 1,
        }
    }

    /// The heading of a step, not wrapped, rad.
    pub fn heading_rad(&self, heading: i32) -> f64 {
        self.center.theta() + f64::from(heading - self.half_headings) * self.step_rad
    }

    /// x of a column, m; half a column is between two.
    pub fn x_m(&self, column: f64) -> f64 {
        self.center.x() + (column - f64::from(self.half_columns)) * self.cell_m
    }

    /// y of a row, m.
    pub fn y_m(&self, row: f64) -> f64 {
        self.center.y() + (row - f64::from(self.half_rows)) * self.cell_m
    }

    /// The pose itself, `map_from_scan`.
    pub fn pose(&self, at: LatticePose) -> SE2 {
        SE2::new(
            self.x_m(f64::from(at.column)),
            self.y_m(f64::from(at.row)),
            self.heading_rad(at.heading),
        )
    }

    /// The neighbourhood in steps.
    pub fn nearness(&self, neighborhood: &SearchNeighborhood) -> Nearness {
        // Saturates: an infinite neighbourhood contains everything.
        let steps = |width: f64, step: f64| (width / step + 1e-9) as i32;
        Nearness {
            cells: steps(neighborhood.reach_m, self.cell_m),
            headings: steps(neighborhood.turn_rad, self.step_rad),
        }
    }

    /// Whether all poses from `first` to `last`, inclusive, are in the neighbourhood of `home`.
    pub fn is_near(
        &self,
        home: LatticePose,
        first: LatticePose,
        last: LatticePose,
        nearness: Nearness,
    ) -> bool {
        let within =
            |a: i32, low: i32, high: i32| a - low <= nearness.cells && high - a <= nearness.cells;
        within(home.column, first.column, last.column)
            && within(home.row, first.row, last.row)
            && self.are_headings_near(home.heading, first.heading, last.heading, nearness.headings)
    }

    fn are_headings_near(&self, home: i32, first: i32, last: i32, reach: i32) -> bool {
        let near = |home: i32| home - first <= reach && last - home <= reach;
        near(home)
            || (self.is_whole_turn && (near(home + self.headings) || near(home - self.headings)))
    }
}

/// The reach of a scan without its farthest points, one in fifty and at least one, m.
fn robust_reach_m(scan: &PointCloud) -> Result<f64, SearchError> {
    let mut reaches_m: Vec<f64> = scan
        .iter()
        .map(|point| math::norm2(point.x, point.y))
        .filter(|reach| reach.is_finite())
        .collect();
    if reaches_m.is_empty() {
        return Err(SearchError::EmptyScan);
    }
    sort_numbers(&mut reaches_m);
    let left_out = reaches_m.len().div_ceil(POINTS_FOR_AN_OUTLIER);
    let last = (reaches_m.len() - 1).saturating_sub(left_out);
    Ok(reaches_m[last])
}

fn angular_step_rad(reach_m: f64, cell_m: f64) -> f64 {
    // Rotation does not matter for a scan within one cell: half a turn is as good as any step.
    let half_sine = (cell_m / (2.0 * math::max(reach_m, cell_m))).min(1.0);
    2.0 * math::atan2(half_sine, math::sqrt(1.0 - half_sine * half_sine))
}

#[cfg(test)]
mod tests {
    use pr_geom::Point2;

    use super::super::LikelihoodConfig;
    use super::*;

    /// Points on a circle of 2 m, and one stray return at 400 m.
    fn scan() -> PointCloud {
        let on_circle = (0..40).map(|k| {
            let (sin, cos) = math::sin_cos(f64::from(k) * TAU / 40.0);
            Point2::new(2.0 * cos, 2.0 * sin)
        });
        on_circle.chain([Point2::new(400.0, 0.0)]).collect()
    }

    fn lattice(window: &SearchWindow) -> Result<Lattice, SearchError> {
        let origin = [Point2::origin()].into_iter().collect();
        let grid = LikelihoodGrid::build(&origin, LikelihoodConfig::default()).unwrap();
        Lattice::new(window, &scan(), &grid)
    }

    #[test]
    fn a_heading_step_moves_the_farthest_point_by_a_cell_ignoring_strays() {
        let window = SearchWindow::around(SE2::identity(), 0.2, 0.5);
        let lattice = lattice(&window).unwrap();
        // arccos(1 − 0.05²/(2·2²)) = 0.025 000 65: 41 steps hold ±0.5 rad.
        assert!((lattice.step_rad - 0.025_000_65).abs() < 1e-8);
        assert_eq!(
            (lattice.columns, lattice.rows, lattice.headings),
            (9, 9, 41)
        );
    }

    #[test]
    fn a_full_turn_has_every_heading_once() {
        let window = SearchWindow::around(SE2::new(1.0, 2.0, 0.3), 0.0, 9.0);
        let lattice = lattice(&window).unwrap();
        let last = lattice.heading_rad(lattice.headings - 1) + lattice.step_rad;
        assert!((last - lattice.heading_rad(0) - TAU).abs() < 1e-9);
        let home = LatticePose {
            heading: lattice.headings - 1,
            row: 0,
            column: 0,
        };
        let first = LatticePose { heading: 0, ..home };
        let near = lattice.nearness(&SearchNeighborhood::default());
        assert!(lattice.is_near(home, first, first, near));
    }

    #[test]
    fn an_infinite_window_is_rejected() {
        for (half_m, half_rad) in [(f64::NAN, 1.0), (1e9, 1.0), (1.0, -1.0), (1.0, f64::NAN)] {
            let window = SearchWindow::around(SE2::identity(), half_m, half_rad);
            assert!(matches!(lattice(&window), Err(SearchError::Window { .. })));
        }
    }
}
