//! The basin map: a grid of starts, coloured by the minimum that each one reaches.

use super::{BasinScene, BasinStart, Minimum};
use ch16_slam2d::icp::{IcpConfig, IcpWorkspace};

/// Strides of the passes that fill the picture, coarse first.
const STRIDES: [usize; 4] = [8, 4, 2, 1];

/// Which offset the vertical axis shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum OffsetAxis {
    /// Δx.
    #[default]
    Dx,
    /// Δy.
    Dy,
}

/// What the two axes of a basin map show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasinMapAxes {
    /// Number of headings, from −180° to 180° inclusive; one column each.
    pub columns: usize,
    /// Number of offsets, from `−offset_span_m` to `offset_span_m` inclusive; one row each.
    pub rows: usize,
    /// Largest offset, m.
    pub offset_span_m: f64,
    /// Which offset the rows show.
    pub axis: OffsetAxis,
    /// The other offset, m.
    pub other_offset_m: f64,
}

impl Default for BasinMapAxes {
    fn default() -> Self {
        Self {
            columns: 121,
            rows: 61,
            offset_span_m: 1.5,
            axis: OffsetAxis::default(),
            other_offset_m: 0.0,
        }
    }
}

impl BasinMapAxes {
    /// The start at the center of a cell. Row 0 is the most negative offset.
    #[must_use]
    pub fn start(&self, column: usize, row: usize) -> BasinStart {
        let along = |index: usize, count: usize, span: f64| {
            if count < 2 {
                0.0
            } else {
                span * (2.0 * index as f64 / (count - 1) as f64 - 1.0)
            }
        };
        let offset_m = along(row, self.rows, self.offset_span_m);
        let (dx_m, dy_m) = match self.axis {
            OffsetAxis::Dx => (offset_m, self.other_offset_m),
            OffsetAxis::Dy => (self.other_offset_m, offset_m),
        };
        BasinStart {
            heading_deg: along(column, self.columns, 180.0),
            dx_m,
            dy_m,
        }
    }

    /// The start moved to the map's other offset.
    #[must_use]
    pub fn through(&self, start: &BasinStart) -> BasinStart {
        match self.axis {
            OffsetAxis::Dx => BasinStart {
                dy_m: self.other_offset_m,
                ..*start
            },
            OffsetAxis::Dy => BasinStart {
                dx_m: self.other_offset_m,
                ..*start
            },
        }
    }

    /// Column and row of a start, in fractions of a cell; it may lie outside.
    #[must_use]
    pub fn position(&self, start: &BasinStart) -> (f64, f64) {
        let back = |value: f64, count: usize, span: f64| {
            0.5 * (value / span + 1.0) * count.saturating_sub(1) as f64
        };
        let offset_m = match self.axis {
            OffsetAxis::Dx => start.dx_m,
            OffsetAxis::Dy => start.dy_m,
        };
        (
            back(start.heading_deg, self.columns, 180.0),
            back(offset_m, self.rows, self.offset_span_m),
        )
    }
}

/// A basin map that is filled a few cells at a time, coarse ones first.
///
/// Every cell is registered separately, without interpolation. Until a cell is computed, [`BasinMap::shown`]
/// returns the coarser cell that covers it.
#[derive(Clone, Debug)]
pub struct BasinMap {
    axes: BasinMapAxes,
    config: IcpConfig,
    cells: Vec<Option<Minimum>>,
    /// Pass, and position within it, of the next cell.
    pass: usize,
    next: usize,
}

impl BasinMap {
    /// An empty map.
    #[must_use]
    pub fn new(axes: BasinMapAxes, config: IcpConfig) -> Self {
        Self {
            axes,
            config,
            cells: vec![None; axes.columns * axes.rows],
            pass: 0,
            next: 0,
        }
    }

    /// What the axes show.
    #[must_use]
    pub fn axes(&self) -> &BasinMapAxes {
        &self.axes
    }

    /// The settings of all registrations.
    #[must_use]
    pub fn config(&self) -> &IcpConfig {
        &self.config
    }

    /// Whether every cell is filled.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.pass == STRIDES.len()
    }

    /// Share of the cells that are filled, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let filled = self.cells.iter().flatten().count();
        filled as f64 / self.cells.len().max(1) as f64
    }

    /// Fills up to `registrations` cells. Returns whether the map is complete.
    pub fn advance(
        &mut self,
        scene: &BasinScene,
        workspace: &mut IcpWorkspace,
        registrations: usize,
    ) -> bool {
        for _ in 0..registrations {
            let Some((column, row)) = self.next_cell() else {
                break;
            };
            let start = self.axes.start(column, row);
            let outcome = scene.register_from(&start, &self.config, workspace);
            self.cells[row * self.axes.columns + column] = Some(outcome.ending);
        }
        self.skip_filled();
        self.is_complete()
    }

    /// The next cells in the order of filling, up to `count`, by column and row; they stay empty.
    #[must_use]
    pub fn ahead(&self, count: usize) -> Vec<[usize; 2]> {
        let mut map = self.clone();
        let next = |_| {
            let (column, row) = map.next_cell()?;
            map.put([column, row], Minimum::Other);
            Some([column, row])
        };
        (0..count).map_while(next).collect()
    }

    /// Fills a cell with a minimum that was computed elsewhere.
    pub fn put(&mut self, [column, row]: [usize; 2], minimum: Minimum) {
        self.cells[row * self.axes.columns + column] = Some(minimum);
        self.skip_filled();
    }

    /// The minimum that a cell's start reaches, `None` before it is computed; [`Minimum::Right`] requires the
    /// right heading, too.
    #[must_use]
    pub fn minimum(&self, column: usize, row: usize) -> Option<Minimum> {
        self.cells[row * self.axes.columns + column]
    }

    /// The cell's own minimum, or that of the finest computed cell that covers it.
    #[must_use]
    pub fn shown(&self, column: usize, row: usize) -> Option<Minimum> {
        STRIDES
            .iter()
            .rev()
            .find_map(|stride| self.minimum(column - column % stride, row - row % stride))
    }

    fn next_cell(&mut self) -> Option<(usize, usize)> {
        self.skip_filled();
        let &stride = STRIDES.get(self.pass)?;
        let cell = self.cell_of_pass(stride);
        self.next += 1;
        cell
    }

    /// Moves to the next cell that no earlier pass has filled.
    fn skip_filled(&mut self) {
        while let Some(&stride) = STRIDES.get(self.pass) {
            match self.cell_of_pass(stride) {
                None => {
                    self.pass += 1;
                    self.next = 0;
                }
                Some((column, row)) if self.minimum(column, row).is_some() => self.next += 1,
                Some(_) => return,
            }
        }
    }

    fn cell_of_pass(&self, stride: usize) -> Option<(usize, usize)> {
        let columns = self.axes.columns.div_ceil(stride);
        let rows = self.axes.rows.div_ceil(stride);
        (self.next < columns * rows)
            .then(|| (self.next % columns * stride, self.next / columns * stride))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::icp::IcpVariant;

    #[test]
    fn filling_bit_by_bit_gives_every_cell_the_outcome_of_its_own_registration() {
        let scene = BasinScene::new();
        let config = BasinScene::config(IcpVariant::PointToPlane, 0.7);
        let axes = BasinMapAxes {
            columns: 13,
            rows: 5,
            ..BasinMapAxes::default()
        };
        let mut workspace = IcpWorkspace::new();
        let mut map = BasinMap::new(axes, config);
        let mut calls = 0;
        while !map.advance(&scene, &mut workspace, 7) {
            calls += 1;
            assert!(map.shown(12, 4).is_some(), "the coarse pass covers all");
            assert!(calls < 100, "the map never completes");
        }
        assert_eq!(map.progress(), 1.0);
        for row in 0..axes.rows {
            for column in 0..axes.columns {
                let start = axes.start(column, row);
                let alone = scene.register_from(&start, &config, &mut workspace);
                assert_eq!(map.minimum(column, row), Some(alone.ending));
                assert_eq!(map.shown(column, row), Some(alone.ending));
            }
        }
    }

    #[test]
    fn a_start_lies_where_its_cell_is() {
        let axes = BasinMapAxes {
            axis: OffsetAxis::Dy,
            ..BasinMapAxes::default()
        };
        let (column, row) = axes.position(&axes.start(17, 42));
        // 1e-9: a few roundings of numbers below 180.
        assert!((column - 17.0).abs() < 1e-9 && (row - 42.0).abs() < 1e-9);
        let elsewhere = BasinStart {
            dx_m: 1.0,
            ..axes.start(17, 42)
        };
        assert_eq!(axes.through(&elsewhere), axes.start(17, 42));
    }

    #[test]
    fn a_map_without_cells_is_complete_at_once() {
        let axes = BasinMapAxes {
            columns: 0,
            ..BasinMapAxes::default()
        };
        let config = BasinScene::config(IcpVariant::PointToPoint, 0.7);
        let mut map = BasinMap::new(axes, config);
        assert!(map.advance(&BasinScene::new(), &mut IcpWorkspace::new(), 1));
    }
}
