//! The occupancy grid of the current tick, redrawn only if its keyframes changed.

use std::sync::Arc;

use ch16_lab::lap::LapRecord;
use ch16_slam2d::graph::EdgeKind;
use pr_geom::math;
use pr_grid::OccupancyGrid;
use widget_kit::model::Fact;
use widget_kit::scene::{Bounds, Raster, RasterCell};

/// Odds above which a cell counts as occupied: nine to one, a probability of 0.9.
const SURE_ODDS: f64 = 9.0;

/// The grid of one tick, with its picture.
pub struct GridView {
    grid: OccupancyGrid,
    raster: Raster,
    source: Source,
    /// Keyframes drawn since it was cleared.
    drawn: usize,
}

/// Identifies a grid within one run.
#[derive(Clone, Copy, PartialEq)]
struct Source {
    keyframes: usize,
    loops: usize,
}

impl Source {
    /// Every tick has a keyframe, so no grid has this key.
    const NOTHING: Self = Self {
        keyframes: 0,
        loops: 0,
    };

    fn from_record(record: &LapRecord, tick: usize) -> Self {
        let edges = record.lap.edges(tick).iter();
        Self {
            keyframes: record.lap.node_count(tick),
            loops: edges.filter(|edge| edge.kind == EdgeKind::Loop).count(),
        }
    }
}

impl GridView {
    /// The grid of a tick.
    pub fn new(record: &LapRecord, tick: usize) -> Self {
        let grid = record.occupancy_grid(tick);
        Self {
            raster: raster(&grid, 0),
            source: Source::from_record(record, tick),
            drawn: 0,
            grid,
        }
    }

    /// Updates it for another tick of the run.
    pub fn show(&mut self, record: &LapRecord, tick: usize) {
        let source = Source::from_record(record, tick);
        if source != self.source {
            self.source = source;
            self.grid = record.occupancy_grid(tick);
            self.raster = raster(&self.grid, self.raster.revision + 1);
        }
    }

    /// Empties it, to be drawn again by [`GridView::draw`].
    pub fn clear(&mut self, record: &LapRecord, tick: usize) {
        self.grid = record.empty_grid(tick);
        self.drawn = 0;
        self.raster = raster(&self.grid, self.raster.revision + 1);
    }

    /// Draws a cleared grid up to that share of the tick's keyframes.
    pub fn draw(&mut self, record: &LapRecord, tick: usize, share: f64) {
        let until = (share * self.source.keyframes as f64) as usize;
        record.draw_keyframes(&mut self.grid, tick, self.drawn..until);
        self.drawn = until;
        self.raster = raster(&self.grid, self.raster.revision + 1);
    }

    /// Invalidates the grid because the run changed.
    pub fn forget(&mut self) {
        self.source = Source::NOTHING;
    }

    /// The picture.
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// The numbers.
    pub fn facts(&self) -> [Fact; 5] {
        let count = |id, label, cells: usize| Fact::count(id, label, cells as f64);
        let grid = &self.grid;
        [
            count("keyframes", "keyframes", self.source.keyframes),
            count("loops", "loops closed, grids redrawn", self.source.loops),
            count("occupied_cells", "occupied cells", grid.occupied_cells()),
            count("sure_cells", "occupied, over 90% sure", self.sure_cells()),
            count("free_cells", "free cells", grid.free_cells()),
        ]
    }

    /// The grid in words.
    pub fn words(&self) -> String {
        format!(
            "Occupancy grid of {} cells, {} occupied and {} free, with a pose graph of {} nodes \
             and {} loops over it.",
            self.grid.columns() * self.grid.rows(),
            self.grid.occupied_cells(),
            self.grid.free_cells(),
            self.source.keyframes,
            self.source.loops,
        )
    }

    fn sure_cells(&self) -> usize {
        let sure = math::ln(SURE_ODDS);
        let log_odds = self.grid.log_odds().iter();
        log_odds.filter(|l| **l > sure).count()
    }
}

/// The grid as a raster of occupancies.
fn raster(grid: &OccupancyGrid, revision: u64) -> Raster {
    let config = grid.config();
    let (min, cell_m) = (config.min_m, config.cell_m);
    let cells: Arc<[RasterCell]> = grid.log_odds().iter().map(|l| occupancy(*l)).collect();
    Raster {
        bounds: Bounds {
            min: [min.x, min.y],
            max: [
                min.x + cell_m * grid.columns() as f64,
                min.y + cell_m * grid.rows() as f64,
            ],
        },
        columns: grid.columns(),
        rows: grid.rows(),
        cells,
        revision,
    }
}

/// Probability of occupancy, `1 − 1/(1 + e^l)`; log odds of 0 mean that the cell was not observed.
fn occupancy(log_odds: f64) -> RasterCell {
    if log_odds == 0.0 {
        return RasterCell::Unknown;
    }
    RasterCell::Occupancy((1.0 - 1.0 / (1.0 + math::exp(log_odds))) as f32)
}
