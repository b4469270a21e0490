//! The cells of an NDT map and the score of a point.

use nalgebra::{Matrix2, Point2, Vector2};
use pr_geom::{SE2, math};
use rustc_hash::FxHashMap;

use crate::cloud::{PointCloud, cell_index};

/// Floor of the larger variance of a cell, m².
const MIN_VARIANCE_M2: f64 = 1e-4;
/// Floor of the smaller variance, as a share of the larger one.
const MIN_VARIANCE_RATIO: f64 = 0.01;
/// Half a squared Mahalanobis distance beyond which a cell adds less than 1e-17 to a score.
const NEGLIGIBLE_EXPONENT: f64 = 40.0;
/// Largest number of cells of a dense table for every Gaussian; beyond that the lookup hashes.
const TABLE_CELLS_PER_GAUSSIAN: i64 = 1024;

/// One Gaussian of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NdtCell {
    /// Index of the cell along x and y; cell `(0, 0)` starts at the origin.
    pub cell: (i32, i32),
    /// Number of its points.
    pub count: usize,
    /// Their mean, m.
    pub mean: Point2<f64>,
    /// Their covariance with its eigenvalues raised to the floor, m².
    pub covariance: Matrix2<f64>,
    /// The inverse of the covariance, 1/m².
    pub information: Matrix2<f64>,
}

/// A map of Gaussians on a grid of cells.
#[derive(Clone, Debug)]
pub struct NdtMap {
    cell_m: f64,
    gaussians: Vec<NdtCell>,
    lookup: Lookup,
    /// For every cell near a Gaussian, the Gaussians of the 3×3 cells around it, one run each.
    near: Vec<u32>,
}

/// Where the run of a cell starts and ends in `NdtMap::near`.
#[derive(Clone, Debug)]
enum Lookup {
    Dense {
        origin: (i32, i32),
        columns: i32,
        rows: i32,
        runs: Vec<(u32, u32)>,
    },
    Hashed(FxHashMap<(i32, i32), (u32, u32)>),
}

impl NdtMap {
    /// The Gaussians of `cloud` on cells `cell_m` wide that hold at least `min_points` points.
    ///
    /// The covariance divides by n − 1. Its larger eigenvalue is raised to 1e-4 m² and the smaller
    /// one to 0.01 of the larger, so that collinear points have an invertible covariance too. A cell
    /// whose covariance overflows, as for points 1e200 m apart, is left out.
    ///
    /// # Panics
    /// If the cell size is not positive and finite, or `min_points` is below 2.
    #[must_use]
    pub fn build(cloud: &PointCloud, cell_m: f64, min_points: usize) -> Self {
        assert!(
            cell_m > 0.0 && cell_m.is_finite(),
            "cell size {cell_m} m is not positive"
        );
        assert!(min_points >= 2, "one point has no covariance");
        let finite = cloud
            .iter()
            .filter(|point| point.x.is_finite() && point.y.is_finite());
        let mut slots = FxHashMap::<(i32, i32), usize>::default();
        let mut moments: Vec<Moments> = Vec::new();
        let mut slot_of = Vec::with_capacity(cloud.len());
        for point in finite.clone() {
            let cell = (cell_index(point.x, cell_m), cell_index(point.y, cell_m));
            let slot = *slots.entry(cell).or_insert_with(|| {
                moments.push(Moments::new(cell));
                moments.len() - 1
            });
            moments[slot].count_in(point);
            slot_of.push(slot);
        }
        for (point, slot) in finite.zip(slot_of) {
            moments[slot].spread(point);
        }
        let gaussians: Vec<NdtCell> = moments
            .iter()
            .filter(|moments| moments.count >= min_points)
            .map(Moments::gaussian)
            .filter(NdtCell::is_finite)
            .collect();
        let (lookup, near) = Lookup::build(&gaussians);
        Self {
            cell_m,
            gaussians,
            lookup,
            near,
        }
    }

    /// Width of a cell, m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// The Gaussians, in the order of the first point in each.
    #[must_use]
    pub fn cells(&self) -> &[NdtCell] {
        &self.gaussians
    }

    /// The Gaussians of the 3×3 cells around a point.
    #[inline]
    pub fn around(&self, x: f64, y: f64) -> impl Iterator<Item = &NdtCell> + Clone {
        self.near_cell((cell_index(x, self.cell_m), cell_index(y, self.cell_m)))
            .iter()
            .map(|&index| &self.gaussians[index as usize])
    }

    /// The Gaussians that contribute to the score of a point, each with its contribution, `exp(−½ dᵀ Σ⁻¹ d)`.
    #[inline]
    pub fn scores_around(&self, x: f64, y: f64) -> impl Iterator<Item = (&NdtCell, f64)> {
        self.around(x, y).filter_map(move |gaussian| {
            let exponent = gaussian.exponent(x, y);
            (exponent < NEGLIGIBLE_EXPONENT).then(|| (gaussian, math::exp(-exponent)))
        })
    }

    /// Indices of the Gaussians of the 3×3 cells around `cell`.
    #[inline]
    #[must_use]
    pub fn near_cell(&self, cell: (i32, i32)) -> &[u32] {
        let (start, end) = self.lookup.run(cell);
        &self.near[start as usize..end as usize]
    }

    /// The score of a point at `(x, y)`: the sum of `exp(−½ dᵀ Σ⁻¹ d)` over the 3×3 cells around it.
    #[inline]
    #[must_use]
    pub fn score_point(&self, x: f64, y: f64) -> f64 {
        let mut score = 0.0;
        self.add_scores(x, y, &mut score);
        score
    }

    #[inline]
    fn add_scores(&self, x: f64, y: f64, score: &mut f64) {
        self.scores_around(x, y)
            .for_each(|(_, added)| *score += added);
    }

    /// The sum of the scores of all points of `cloud`, moved by `map_from_cloud`.
    #[must_use]
    pub fn score(&self, cloud: &PointCloud, map_from_cloud: &SE2) -> f64 {
        let rotation = map_from_cloud.rotation();
        let mut score = 0.0;
        for (&x, &y) in cloud.xs().iter().zip(cloud.ys()) {
            let (x, y) = rotation.rotate(x, y);
            self.add_scores(x + map_from_cloud.x(), y + map_from_cloud.y(), &mut score);
        }
        score
    }
}

/// Sums over the points of one cell: first the points, then their scatter about the mean.
struct Moments {
    cell: (i32, i32),
    count: usize,
    sum: Vector2<f64>,
    scatter: [f64; 3],
}

impl Moments {
    fn new(cell: (i32, i32)) -> Self {
        Self {
            cell,
            count: 0,
            sum: Vector2::zeros(),
            scatter: [0.0; 3],
        }
    }

    fn count_in(&mut self, point: Point2<f64>) {
        self.count += 1;
        self.sum += point.coords;
    }

    fn mean(&self) -> Point2<f64> {
        (self.sum / self.count as f64).into()
    }

    fn spread(&mut self, point: Point2<f64>) {
        let d = point - self.mean();
        self.scatter[0] += d.x * d.x;
        self.scatter[1] += d.x * d.y;
        self.scatter[2] += d.y * d.y;
    }

    fn gaussian(&self) -> NdtCell {
        let divisor = self.count as f64 - 1.0;
        let [xx, xy, yy] = self.scatter.map(|sum| sum / divisor);
        let (covariance, information) = floored(xx, xy, yy);
        NdtCell {
            cell: self.cell,
            count: self.count,
            mean: self.mean(),
            covariance,
            information,
        }
    }
}

impl NdtCell {
    fn is_finite(&self) -> bool {
        let numbers = self.mean.iter().chain(&self.covariance);
        let mut numbers = numbers.chain(&self.information);
        numbers.all(|number| number.is_finite())
    }

    /// `½ dᵀ Σ⁻¹ d` of a point at `(x, y)`.
    #[inline]
    #[must_use]
    pub fn exponent(&self, x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - self.mean.x, y - self.mean.y);
        let m = &self.information;
        0.5 * (m.m11 * dx * dx + 2.0 * m.m12 * dx * dy + m.m22 * dy * dy)
    }
}

/// The covariance `[xx xy; xy yy]` with its eigenvalues raised to the floor, and its inverse.
fn floored(xx: f64, xy: f64, yy: f64) -> (Matrix2<f64>, Matrix2<f64>) {
    let center = 0.5 * (xx + yy);
    let half_gap = math::norm2(0.5 * (xx - yy), xy);
    let largest = math::max(center + half_gap, MIN_VARIANCE_M2);
    let smallest = math::max(center - half_gap, MIN_VARIANCE_RATIO * largest);
    // With the unit axis u of the larger variance, f(Σ) = f(λ_max) u uᵀ + f(λ_min) (I − u uᵀ).
    let (ux, uy) = if xx > yy {
        (xx - center + half_gap, xy)
    } else {
        (xy, yy - center + half_gap)
    };
    let length = math::norm2(ux, uy);
    let (ux, uy) = if length > 0.0 {
        (ux / length, uy / length)
    } else {
        (1.0, 0.0)
    };
    let compose = |along: f64, across: f64| {
        let off = (along - across) * ux * uy;
        Matrix2::new(
            along * ux * ux + across * uy * uy,
            off,
            off,
            along * uy * uy + across * ux * ux,
        )
    };
    (
        compose(largest, smallest),
        compose(1.0 / largest, 1.0 / smallest),
    )
}

impl Lookup {
    /// Lists, for every cell that touches a Gaussian's, the Gaussians around it.
    fn build(gaussians: &[NdtCell]) -> (Self, Vec<u32>) {
        let (mut low, mut high) = ((i32::MAX, i32::MAX), (i32::MIN, i32::MIN));
        for NdtCell { cell: (i, j), .. } in gaussians {
            low = (low.0.min(*i), low.1.min(*j));
            high = (high.0.max(*i), high.1.max(*j));
        }
        let side = |low: i32, high: i32| (i64::from(high) - i64::from(low) + 3).max(0);
        let (columns, rows) = (side(low.0, high.0), side(low.1, high.1));
        let budget = TABLE_CELLS_PER_GAUSSIAN * gaussians.len() as i64;
        let is_dense = columns.saturating_mul(rows) <= budget;
        let mut index_of = FxHashMap::<(i32, i32), u32>::default();
        let mut lookup = if is_dense {
            Self::Dense {
                origin: (low.0.saturating_sub(1), low.1.saturating_sub(1)),
                columns: columns as i32,
                rows: rows as i32,
                runs: vec![(0, 0); (columns * rows) as usize],
            }
        } else {
            Self::Hashed(FxHashMap::default())
        };
        for (index, gaussian) in gaussians.iter().enumerate() {
            index_of.insert(gaussian.cell, index as u32);
        }
        let mut near = Vec::new();
        for gaussian in gaussians {
            for cell in cells_around(gaussian.cell) {
                let Some(run) = lookup.run_mut(cell) else {
                    continue;
                };
                if *run == (0, 0) {
                    let start = near.len() as u32;
                    near.extend(cells_around(cell).filter_map(|cell| index_of.get(&cell)));
                    *run = (start, near.len() as u32);
                }
            }
        }
        (lookup, near)
    }

    /// The run of a cell around a Gaussian, for writing.
    fn run_mut(&mut self, cell: (i32, i32)) -> Option<&mut (u32, u32)> {
        match self {
            Self::Dense {
                origin,
                columns,
                rows,
                runs,
            } => runs.get_mut(slot(cell, *origin, *columns, *rows)?),
            Self::Hashed(runs) => Some(runs.entry(cell).or_insert((0, 0))),
        }
    }

    #[inline]
    fn run(&self, cell: (i32, i32)) -> (u32, u32) {
        match self {
            Self::Dense {
                origin,
                columns,
                rows,
                runs,
            } => {
                let slot = slot(cell, *origin, *columns, *rows);
                slot.map_or((0, 0), |slot| runs[slot])
            }
            Self::Hashed(runs) => runs.get(&cell).copied().unwrap_or((0, 0)),
        }
    }
}

/// The 3×3 cells around a cell, without those beyond the range of indices.
fn cells_around((i, j): (i32, i32)) -> impl Iterator<Item = (i32, i32)> {
    (-1..=1)
        .flat_map(move |di| (-1..=1).map(move |dj| (i.saturating_add(di), j.saturating_add(dj))))
}

/// Index of a cell in a table of columns, if it is inside.
#[inline]
fn slot((i, j): (i32, i32), origin: (i32, i32), columns: i32, rows: i32) -> Option<usize> {
    let (column, row) = (i.wrapping_sub(origin.0), j.wrapping_sub(origin.1));
    let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
    is_inside.then(|| (column * rows + row) as usize)
}
