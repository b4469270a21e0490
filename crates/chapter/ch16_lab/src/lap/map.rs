//! The occupancy grid of a lap's keyframes.

use core::ops::Range;

use pr_geom::Vector2;
use pr_grid::{Beams, GridConfig, OccupancyGrid};
use pr_sim::Lidar;

use super::config::GridExtent;
use super::record::LapRecord;

/// Most cells of a grid: 300 m × 300 m.
const MAX_CELLS: f64 = 4e6;

impl LapRecord {
    /// The occupancy grid of the keyframes up to `tick`, at their poses of that tick.
    #[must_use]
    pub fn occupancy_grid(&self, tick: usize) -> OccupancyGrid {
        let mut grid = self.empty_grid(tick);
        self.draw_keyframes(&mut grid, tick, 0..self.lap.node_count(tick));
        grid
    }

    /// The occupancy grid of the keyframes up to `tick`, before the first one is drawn.
    #[must_use]
    pub fn empty_grid(&self, tick: usize) -> OccupancyGrid {
        let drive = &self.config.drive;
        let mut config = match self.config.grid {
            GridExtent::Plan => {
                let bounds = drive.world.bounds();
                GridConfig {
                    min_m: bounds.min,
                    max_m: bounds.max,
                    ..GridConfig::default()
                }
            }
            GridExtent::Poses => self.seen_area(tick),
        };
        config.sensor.max_range_m = drive.lidar.max_range_m;
        OccupancyGrid::new(config)
    }

    /// The area in sensor range of the keyframes up to `tick`, in whole cells from the start.
    ///
    /// Poses that would need too many cells do not count; their beams are cut at the border.
    fn seen_area(&self, tick: usize) -> GridConfig {
        let drive = &self.config.drive;
        let default = GridConfig::default();
        let start = drive.start.position();
        let reach = Vector2::repeat(drive.lidar.max_range_m + default.cell_m);
        let (mut low, mut high) = (start, start);
        for pose in self.lap.poses(tick) {
            let (lower, upper) = (
                low.inf(&(pose.position() - reach)),
                high.sup(&(pose.position() + reach)),
            );
            let sides = (upper - lower) / default.cell_m;
            if sides.x * sides.y <= MAX_CELLS {
                (low, high) = (lower, upper);
            }
        }
        let whole = |side_m: f64| (side_m / default.cell_m).ceil() * default.cell_m;
        GridConfig {
            min_m: start - (start - low).map(whole),
            max_m: start + (high - start).map(whole),
            ..default
        }
    }

    /// Draws some of the keyframes up to `tick`, at their poses of that tick.
    pub fn draw_keyframes(&self, grid: &mut OccupancyGrid, tick: usize, drawn: Range<usize>) {
        let lidar = self.config.drive.lidar;
        let beams = Beams::new(Lidar::new(lidar).bearings_rad());
        let keyframes = self.lap.poses(tick).iter().zip(&self.lap.keyframes);
        for (pose, keyframe) in keyframes.skip(drawn.start).take(drawn.len()) {
            grid.integrate(pose, &beams, &self.drive.sweep(keyframe.tick).ranges_m);
        }
    }
}
