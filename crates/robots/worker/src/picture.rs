//! The map as a picture, painted a few scans at a time, and repainted after the graph has moved.

use log_messages::MapReport;
use pr_geom::{SE2, math};
use robot_io::log::LogFrame;
use robot_io::map_image::{MapBuilder, MapError};

/// Size of the finest cells, m.
const FINEST_M: f64 = 0.05;
/// A picture with more cells gets coarser ones.
const MAX_CELLS: usize = 1_000_000;
/// The map is repainted if a scan has moved by more than this share of a cell.
const MOVED_CELLS: f64 = 0.5;
/// The same for its heading, rad.
const TURNED_RAD: f64 = 0.01;
/// Scans painted per step.
const SCANS_AT_ONCE: usize = 8;

/// The picture of the map.
#[derive(Clone, Debug)]
pub struct MapPicture {
    cell_m: f64,
    map: MapBuilder,
    /// Poses of the scans when they were painted.
    painted: Vec<SE2>,
    /// Whether it changed since the last [`MapPicture::report`].
    is_new: bool,
}

impl Default for MapPicture {
    fn default() -> Self {
        Self {
            cell_m: FINEST_M,
            map: builder(FINEST_M),
            painted: Vec::new(),
            is_new: false,
        }
    }
}

impl MapPicture {
    /// Restarts if poses have moved since they were painted.
    pub fn follow(&mut self, poses: &[SE2]) {
        let has_moved = self.painted.iter().zip(poses).any(|(old, new)| {
            let shift_m = math::norm2(old.x() - new.x(), old.y() - new.y());
            shift_m > MOVED_CELLS * self.cell_m || old.between(new).theta().abs() > TURNED_RAD
        });
        if has_moved {
            self.begin(self.cell_m);
        }
    }

    fn begin(&mut self, cell_m: f64) {
        self.cell_m = cell_m;
        self.map = builder(cell_m);
        self.painted.clear();
    }

    /// Paints the next scans; returns false if all are painted.
    pub fn step(&mut self, frames: &[LogFrame], poses: &[SE2]) -> bool {
        let next = self.painted.len();
        let todo = frames.iter().zip(poses).skip(next).take(SCANS_AT_ONCE);
        if todo.len() == 0 {
            return false;
        }
        for (frame, pose) in todo {
            if self.map.add(pose, &frame.scan).is_err() {
                self.begin(2.0 * self.cell_m);
                return true;
            }
            self.painted.push(*pose);
        }
        self.is_new = true;
        true
    }

    /// The picture, if it is complete and changed.
    pub fn report(&mut self, scans: usize) -> Option<MapReport> {
        if !self.is_new || self.painted.len() < scans {
            return None;
        }
        let map = match self.map.finish() {
            Ok(map) if map.width * map.height <= MAX_CELLS => map,
            Err(MapError::Nothing) => return None,
            _ => {
                self.begin(2.0 * self.cell_m);
                return None;
            }
        };
        self.is_new = false;
        let log_odds = map.log_odds();
        let rows = log_odds.chunks(map.width).rev();
        Some(MapReport {
            columns: map.width,
            min: [map.origin_m[0], map.origin_m[1]],
            cell_m: map.cell_m,
            cells: rows.flatten().map(|&log_odds| shade(log_odds)).collect(),
        })
    }
}

/// An empty map that a picture has room for.
fn builder(cell_m: f64) -> MapBuilder {
    MapBuilder::new(cell_m).with_most_cells(4 * MAX_CELLS)
}

/// 0 if unknown, else 1 for free to 255 for occupied.
fn shade(log_odds: f64) -> u8 {
    if log_odds == 0.0 {
        return 0;
    }
    let probability = 1.0 / (1.0 + math::exp(-log_odds));
    1 + (254.0 * probability).round() as u8
}
