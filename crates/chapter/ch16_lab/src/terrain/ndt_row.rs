//! One row of NDT's landscape: each Gaussian along a line of shifts.
//!
//! Along the row the exponent of one Gaussian is a parabola in the shift. Its neighbouring values
//! differ by factors that themselves change by a constant factor, so three exponentials serve the
//! whole run of samples: `e_{s+1} = e_s r_s`, `r_{s+1} = r_s k`, outward from the largest value.
//! Rounding grows with the square of the run's length, to about 1e-12 of the value over 160 samples.

use pr_geom::math;

use super::TerrainSettings;
use ch16_slam2d::cloud::cell_index;
use ch16_slam2d::ndt::{NdtCell, NdtMap};

/// Half a squared Mahalanobis distance beyond which a Gaussian adds less than 1e-17.
const NEGLIGIBLE_EXPONENT: f64 = 40.0;

/// Sums of scores over points, for one row of shifts.
#[derive(Clone, Debug, Default)]
pub(super) struct NdtRow {
    shifts: Vec<f64>,
    step_m: f64,
    per_step: f64,
    cell_m: f64,
    sums: Vec<f64>,
    profiles: Vec<Profile>,
    /// The first cell column of every point.
    first_columns: Vec<i32>,
    /// The first sample in each cell column of every point, `columns + 1` each.
    borders: Vec<u32>,
    columns: usize,
}

/// A Gaussian along a row: `½ a (x + b y)² + ½ c y²` with x, y relative to the mean.
#[derive(Clone, Copy, Debug)]
struct Profile {
    cell: (i32, i32),
    mean: (f64, f64),
    along: f64,
    skew: f64,
    across: f64,
    /// Factor by which the ratio of neighbours changes from sample to sample.
    fall: f64,
}

impl Profile {
    fn new(gaussian: &NdtCell, step_m: f64) -> Self {
        let m = &gaussian.information;
        Self {
            cell: gaussian.cell,
            mean: (gaussian.mean.x, gaussian.mean.y),
            along: m.m11,
            skew: m.m12 / m.m11,
            across: m.m22 - m.m12 * m.m12 / m.m11,
            fall: math::exp(-m.m11 * step_m * step_m),
        }
    }
}

impl NdtRow {
    pub(super) fn prepare(&mut self, map: &NdtMap, xs: &[f64], settings: &TerrainSettings) {
        self.shifts.clear();
        self.shifts
            .extend((0..settings.n).map(|index| settings.offset_m(index)));
        self.step_m = match self.shifts[..] {
            [first, second, ..] => second - first,
            _ => 1.0,
        };
        self.per_step = 1.0 / self.step_m;
        self.cell_m = map.cell_m();
        self.profiles.clear();
        let gaussians = map.cells().iter();
        self.profiles
            .extend(gaussians.map(|gaussian| Profile::new(gaussian, self.step_m)));
        self.find_borders(xs);
    }

    /// Finds which samples lie in which cell column, for every point; it does not depend on the row.
    fn find_borders(&mut self, xs: &[f64]) {
        self.first_columns.clear();
        self.borders.clear();
        let (Some(first), Some(last)) = (self.shifts.first(), self.shifts.last()) else {
            return;
        };
        // One more than the span can touch at any phase.
        self.columns = ((last - first) / self.cell_m).floor() as usize + 2;
        for &x in xs {
            let column = cell_index(x + first, self.cell_m);
            self.first_columns.push(column);
            for offset in 0..=self.columns as i32 {
                let before = |shift: &f64| cell_index(x + shift, self.cell_m) < column + offset;
                self.borders
                    .push(self.shifts.partition_point(before) as u32);
            }
        }
    }

    /// Starts a row with all sums at zero.
    pub(super) fn begin(&mut self) {
        self.sums.clear();
        self.sums.resize(self.shifts.len(), 0.0);
    }

    /// Adds point `index`, which is at `(x, y)` where the shift along the row is zero.
    pub(super) fn add_point(&mut self, index: usize, x: f64, y: f64) {
        let row = cell_index(y, self.cell_m);
        let stride = self.columns + 1;
        let borders = &self.borders[index * stride..(index + 1) * stride];
        let first_column = self.first_columns[index];
        // The samples whose cell is at most one column away from the Gaussian's.
        let border = |column: i32| {
            let offset = column.saturating_sub(first_column);
            borders[offset.clamp(0, self.columns as i32) as usize] as usize
        };
        for profile in &self.profiles {
            let (i, j) = profile.cell;
            let dy = y - profile.mean.1;
            let least = 0.5 * profile.across * dy * dy;
            if row.abs_diff(j) > 1 || least > NEGLIGIBLE_EXPONENT {
                continue;
            }
            let samples = (border(i.saturating_sub(1)), border(i.saturating_add(2)));
            if samples.0 < samples.1 {
                let dx = x - profile.mean.0 + profile.skew * dy;
                add_profile(
                    &mut self.sums[samples.0..samples.1],
                    profile,
                    dx + self.shifts[samples.0],
                    least,
                    (self.step_m, self.per_step),
                );
            }
        }
    }

    /// The sums of the row.
    pub(super) fn sums(&self) -> &[f64] {
        &self.sums
    }
}

/// Adds `exp(−½ a u² − least)` to the sums, where u starts at `first` and grows by a step each.
#[inline]
fn add_profile(
    sums: &mut [f64],
    profile: &Profile,
    first: f64,
    least: f64,
    (step_m, per_step): (f64, f64),
) {
    let reach = math::sqrt(2.0 * (NEGLIGIBLE_EXPONENT - least) / profile.along);
    // Casts truncate at zero; the exact end of a run matters less than 1e-17.
    let from = ((-reach - first) * per_step) as u32 as usize;
    let to = ((reach - first) * per_step + 1.0) as u32 as usize;
    let to = to.min(sums.len());
    if from >= to {
        return;
    }
    let middle = ((-first * per_step + 0.5) as u32 as usize).clamp(from, to - 1);
    let u = first + middle as f64 * step_m;
    let value = math::exp(-0.5 * profile.along * u * u - least);
    let slope = profile.along * step_m * u;
    let half = 0.5 * profile.along * step_m * step_m;
    let mut e = value;
    let mut ratio = math::exp(-slope - half);
    for sum in &mut sums[middle..to] {
        *sum += e;
        e *= ratio;
        ratio *= profile.fall;
    }
    if middle == from {
        return;
    }
    let mut ratio = math::exp(slope - half);
    let mut e = value * ratio;
    for sum in sums[from..middle].iter_mut().rev() {
        *sum += e;
        ratio *= profile.fall;
        e *= ratio;
    }
}
