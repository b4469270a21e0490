//! One row of ICP's landscape: nearest distances along a line, without a search per sample.
//!
//! A cloud point shifted along x meets map point k at the squared distance
//! `(x − x_k)² + c_k` with `c_k = (y − y_k)²`. All these parabolas have the same shape, so each is
//! the lowest on at most one interval, and two of them cross once. One pass over the map points,
//! sorted by x, yields the intervals (Felzenszwalb & Huttenlocher 2012); the samples of an interval
//! are then a plain loop.

use pr_geom::{math, sort_pairs};

use super::TerrainSettings;
use ch16_slam2d::cloud::DenseMap;

/// Height of the slabs by which the map points are looked up, m.
const SLAB_M: f64 = 0.05;

/// A parabola and the sample from which it is the lowest.
#[derive(Clone, Copy, Debug)]
struct Arc {
    /// Where its vertex is, as a shift.
    vertex: f64,
    /// How high its vertex is, m².
    height: f64,
    /// It is the lowest from this shift on.
    from: f64,
}

/// Sums of `min(d², τ²)` over points, for one row of shifts.
#[derive(Clone, Debug, Default)]
pub(super) struct IcpRow {
    shifts: Vec<f64>,
    per_step: f64,
    tau_m: f64,
    slabs: Slabs,
    sums: Vec<f64>,
    arcs: Vec<Arc>,
    /// Points without any map point within reach of the row.
    lonely: usize,
}

impl IcpRow {
    pub(super) fn prepare(&mut self, map: &DenseMap, settings: &TerrainSettings) {
        self.shifts.clear();
        self.shifts
            .extend((0..settings.n).map(|index| settings.offset_m(index)));
        self.per_step = match self.shifts[..] {
            [first, second, ..] => 1.0 / (second - first),
            _ => 1.0,
        };
        self.tau_m = settings.tau_m;
        self.slabs.fill(map, settings.tau_m);
    }

    /// Starts a row with all sums at zero.
    pub(super) fn begin(&mut self) {
        self.sums.clear();
        self.sums.resize(self.shifts.len(), 0.0);
        self.lonely = 0;
    }

    /// Adds a point that is at `(x, y)` where the shift along the row is zero.
    pub(super) fn add_point(&mut self, x: f64, y: f64) {
        let (Some(&first_shift), Some(&last_shift)) = (self.shifts.first(), self.shifts.last())
        else {
            return;
        };
        let (west, east) = (x + first_shift - self.tau_m, x + last_shift + self.tau_m);
        let tau_squared = self.tau_m * self.tau_m;
        self.arcs.clear();
        for &(map_x, map_y) in self.slabs.near(y) {
            let height = (map_y - y) * (map_y - y);
            if height < tau_squared && map_x >= west && map_x <= east {
                push_arc(&mut self.arcs, map_x - x, height);
            }
        }
        if self.arcs.is_empty() {
            self.lonely += 1;
            return;
        }
        let mut first = 0;
        for (index, arc) in self.arcs.iter().enumerate() {
            // Two parabolas are equal where they cross, so rounding a border to a neighbouring sample does
            // not matter.
            let last = self.arcs.get(index + 1).map_or(self.sums.len(), |next| {
                let border = (next.from - first_shift) * self.per_step;
                let border = if border < 0.0 {
                    0
                } else {
                    border as u32 as usize + 1
                };
                border.clamp(first, self.sums.len())
            });
            let samples = self.shifts[first..last].iter();
            for (sum, &shift) in self.sums[first..last].iter_mut().zip(samples) {
                let along = shift - arc.vertex;
                let squared = along * along + arc.height;
                *sum += if squared < tau_squared {
                    squared
                } else {
                    tau_squared
                };
            }
            first = last;
        }
    }

    /// The sums of the row, m².
    pub(super) fn sums(&mut self) -> &[f64] {
        let rest = self.lonely as f64 * self.tau_m * self.tau_m;
        for sum in &mut self.sums {
            *sum += rest;
        }
        self.lonely = 0;
        &self.sums
    }
}

/// Adds a parabola whose vertex is right of all earlier ones.
#[inline]
fn push_arc(arcs: &mut Vec<Arc>, vertex: f64, height: f64) {
    while let Some(top) = arcs.last() {
        let gap = vertex - top.vertex;
        let from = if gap > 0.0 {
            0.5 * (vertex + top.vertex + (height - top.height) / gap)
        } else if height < top.height {
            f64::NEG_INFINITY
        } else {
            return;
        };
        if from > top.from {
            arcs.push(Arc {
                vertex,
                height,
                from,
            });
            return;
        }
        arcs.pop();
    }
    arcs.push(Arc {
        vertex,
        height,
        from: f64::NEG_INFINITY,
    });
}

/// The map points within reach of each slab of y, sorted by x.
#[derive(Clone, Debug, Default)]
struct Slabs {
    sorted: Vec<(f64, f64)>,
    south: f64,
    starts: Vec<usize>,
    points: Vec<(f64, f64)>,
}

impl Slabs {
    fn fill(&mut self, map: &DenseMap, tau_m: f64) {
        self.sorted.clear();
        self.sorted
            .extend(map.xs().iter().copied().zip(map.ys().iter().copied()));
        sort_pairs(&mut self.sorted);
        let ys = || self.sorted.iter().map(|point| point.1);
        self.south = ys().fold(f64::INFINITY, math::min) - tau_m;
        let north = ys().fold(f64::NEG_INFINITY, math::max) + tau_m;
        let count = ((north - self.south) / SLAB_M).ceil() as usize;
        self.points.clear();
        self.starts.clear();
        self.starts.push(0);
        for slab in 0..count {
            let low = self.south + slab as f64 * SLAB_M;
            let (reach_low, reach_high) = (low - tau_m, low + SLAB_M + tau_m);
            let near = self.sorted.iter();
            self.points
                .extend(near.filter(|point| point.1 >= reach_low && point.1 <= reach_high));
            self.starts.push(self.points.len());
        }
    }

    /// The points that may be within τ of `y`; a superset.
    #[inline]
    fn near(&self, y: f64) -> &[(f64, f64)] {
        let slab = (y - self.south) / SLAB_M;
        if !(slab >= 0.0 && slab < (self.starts.len() - 1) as f64) {
            return &[];
        }
        let slab = slab as u32 as usize;
        &self.points[self.starts[slab]..self.starts[slab + 1]]
    }
}
