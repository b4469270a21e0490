//! The occupancy grid of a lap's keyframes.

use core::ops::Range;

use pr_grid::{Beams, GridConfig, OccupancyGrid};
use pr_sim::Lidar;

use super::record::LapRecord;

/// The area of a lap's grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GridExtent {
    /// The plan of the world, as in the chapter's figures; beams are cut at its border.
    Plan,
    /// Everything in sensor range of the poses, because a robot has no plan of an unknown world, and an
    /// estimate that drifts leaves the plan.
    #[default]
    Poses,
}

impl LapRecord {
    /// The occupancy grid of the keyframes up to `tick`, at their poses of that tick.
    #[must_use]
    pub fn occupancy_grid(&self, tick: usize) -> OccupancyGrid {
        let mut grid = self.empty_grid();
        self.draw_keyframes(&mut grid, tick, 0..self.lap.node_count(tick));
        grid
    }

    /// The occupancy grid before its first keyframe.
    #[must_use]
    pub fn empty_grid(&self) -> OccupancyGrid {
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
            GridExtent::Poses => {
                GridConfig::growing_from(drive.start.position(), GridConfig::default().cell_m)
            }
        };
        config.sensor.max_range_m = drive.lidar.max_range_m;
        OccupancyGrid::new(config)
    }

    /// Draws some of the keyframes up to `tick`, at their poses of that tick.
    ///
    /// A growing grid stops growing at its size limit, and beams are cut at its border.
    pub fn draw_keyframes(&self, grid: &mut OccupancyGrid, tick: usize, drawn: Range<usize>) {
        let lidar = self.config.drive.lidar;
        let beams = Beams::new(Lidar::new(lidar).bearings_rad());
        let keyframes = self.lap.poses(tick).iter().zip(&self.lap.keyframes);
        for (pose, keyframe) in keyframes.skip(drawn.start).take(drawn.len()) {
            if self.config.grid == GridExtent::Poses {
                let _ = grid.cover(pose.position(), lidar.max_range_m);
            }
            grid.integrate(pose, &beams, &self.drive.sweep(keyframe.tick).ranges_m);
        }
    }
}
