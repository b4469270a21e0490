//! The relief that is drawn: one of the two landscapes, or a mixture while it morphs into the other.

use std::sync::Arc;

use widget_kit::model::{Activity, Motion};
use widget_kit::scene::{Bounds, Raster, RasterCell};

use super::landscape::spacing_m;
use super::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::{HALF_SPAN_M, ReliefMeasure};

/// Duration of a morph, s.
const MORPH_S: f64 = 0.8;

/// Light on a slope that rises from the lowest to the highest colour within a metre.
const LIGHT_PER_SLOPE_M: f32 = 0.2;

/// The relief, with the share of NDT in it.
#[derive(Clone, Debug)]
pub struct Morph {
    /// The picture.
    pub raster: Raster,
    /// 0 is ICP's landscape, 1 NDT's.
    share: f64,
    wanted: f64,
    levels: Vec<f32>,
}

impl Morph {
    /// ICP's relief.
    pub fn new(terrains: &Terrains) -> Self {
        let mut morph = Self {
            raster: Raster {
                bounds: Bounds {
                    min: [0.0; 2],
                    max: [0.0; 2],
                },
                columns: 0,
                rows: 0,
                cells: Arc::new([]),
                revision: 0,
            },
            share: 0.0,
            wanted: 0.0,
            levels: Vec::new(),
        };
        morph.paint(terrains);
        morph
    }

    /// Starts to morph into a measure, and follows changed landscapes.
    pub fn turn_to(&mut self, measure: ReliefMeasure, motion: Motion, terrains: &Terrains) {
        self.wanted = match measure {
            ReliefMeasure::Icp => 0.0,
            ReliefMeasure::Ndt => 1.0,
        };
        if motion == Motion::Reduced {
            self.share = self.wanted;
        }
        self.paint(terrains);
    }

    /// Ends the morph.
    pub fn end(&mut self, terrains: &Terrains) {
        self.share = self.wanted;
        self.paint(terrains);
    }

    /// Morphs for that many seconds.
    pub fn advance(&mut self, elapsed_s: f64, terrains: &Terrains) -> Activity {
        if self.share == self.wanted {
            return Activity::Idle;
        }
        let most = elapsed_s / MORPH_S;
        self.share += (self.wanted - self.share).clamp(-most, most);
        self.paint(terrains);
        Activity::Busy
    }

    /// Position of a ball in the mixture: the balls morph like their ground.
    pub fn between(&self, icp: [f64; 2], ndt: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| icp[axis] + self.share * (ndt[axis] - icp[axis]))
    }

    /// Draws the relief again if its levels changed.
    fn paint(&mut self, terrains: &Terrains) {
        let share = self.share as f32;
        let pairs = terrains.icp.levels.iter().zip(&terrains.ndt.levels);
        let levels: Vec<f32> = pairs
            .map(|(icp, ndt)| (1.0 - share) * icp + share * ndt)
            .collect();
        if levels == self.levels {
            return;
        }
        let cells = terrains.icp.cells();
        // Half a cell beyond the outermost samples: a sample is the center of its cell.
        let edge = HALF_SPAN_M + 0.5 * spacing_m(cells);
        self.raster = Raster {
            bounds: Bounds {
                min: [-edge, -edge],
                max: [edge, edge],
            },
            columns: cells,
            rows: cells,
            cells: lit(&levels, cells),
            revision: self.raster.revision + 1,
        };
        self.levels = levels;
    }
}

/// The relief: each cell with the slope to its neighbours, lit from the upper left.
fn lit(levels: &[f32], cells: usize) -> Arc<[RasterCell]> {
    let gain = LIGHT_PER_SLOPE_M / (2.0 * spacing_m(cells)) as f32;
    let rise = |along: usize, stride: usize, index: usize| {
        let (before, after) = (along.min(1), (cells - 1 - along).min(1));
        levels[index + after * stride] - levels[index - before * stride]
    };
    let cell = |(index, level): (usize, &f32)| {
        let up_right = rise(index % cells, 1, index) - rise(index / cells, cells, index);
        RasterCell::Relief {
            level: *level,
            light: (gain * up_right).clamp(-1.0, 1.0),
        }
    };
    levels.iter().enumerate().map(cell).collect()
}
