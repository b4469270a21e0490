//! Data association: pairs each cloud point with a map point.

use nalgebra::{Point2, Vector2};
use pr_geom::{SE2, math};

use super::align::{PlanePair, PointPair, Solved, point_to_plane, point_to_point};
use super::{Accepted, IcpConfig, IcpVariant, PairRejection, Trimmed, huber_weight};
use crate::cloud::{NearestMap, PointCloud, QueryCache};

/// The state of a registration after one association.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IcpTrace {
    /// `target_from_source`.
    pub pose: SE2,
    /// Number of pairs at this pose.
    pub pairs: usize,
    /// Root mean square residual of the pairs, m; infinite without pairs.
    pub rmse_m: f64,
    /// Mean over the cloud of `min(d², τ²)`, m²: point-to-point ICP never raises it.
    pub truncated_cost_m2: f64,
}

/// A moved cloud point and the map point nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Index in the cloud.
    pub source_index: usize,
    /// Index in the map.
    pub target_index: usize,
    /// The cloud point, moved into the map's frame, m.
    pub source: Point2<f64>,
    /// The map point, m.
    pub target: Point2<f64>,
    /// Unit normal of the map point, if it has one.
    pub normal: Option<Vector2<f64>>,
}

impl Pair {
    /// Distance between the two points, m.
    #[must_use]
    pub fn distance_m(&self) -> f64 {
        math::norm2(self.source.x - self.target.x, self.source.y - self.target.y)
    }

    /// Signed distance along the normal, m; without a normal, the distance.
    #[must_use]
    pub fn plane_distance_m(&self) -> f64 {
        self.normal.map_or_else(
            || self.distance_m(),
            |n| n.dot(&(self.source - self.target)),
        )
    }
}

/// The pairs of a registration with the cloud at `target_from_source`.
///
/// Pairs are closer than `config.tau_m`; trimming drops the longest share of them.
#[must_use]
pub fn correspondences<M: NearestMap>(
    cloud: &PointCloud,
    map: &M,
    target_from_source: SE2,
    config: &IcpConfig,
) -> Vec<Pair> {
    let mut workspace = IcpWorkspace::new();
    workspace.forget();
    workspace.associate(cloud, map, &target_from_source, config);
    workspace.pairs(map).collect()
}

/// A pair as the inner loops use it; normal `(0, 0)` if there is none.
#[derive(Clone, Copy)]
struct RawPair {
    source: (f64, f64),
    target: (f64, f64),
    normal: (f64, f64),
    distance_squared_m2: f64,
    source_index: u32,
    target_index: u32,
}

impl RawPair {
    #[inline]
    fn has_normal(&self) -> bool {
        self.normal.0 != 0.0 || self.normal.1 != 0.0
    }

    #[inline]
    fn plane_residual_m(&self) -> f64 {
        self.normal.0 * (self.source.0 - self.target.0)
            + self.normal.1 * (self.source.1 - self.target.1)
    }

    /// The squared residual, along the normal if there is one.
    #[inline]
    fn square_m2(&self) -> f64 {
        if self.has_normal() {
            let residual_m = self.plane_residual_m();
            residual_m * residual_m
        } else {
            self.distance_squared_m2
        }
    }
}

/// The memory of a registration, reused between calls to avoid allocation.
#[derive(Clone, Default)]
pub struct IcpWorkspace {
    /// Cached neighbour of each cloud point; empty if there is no cache.
    cache: Vec<QueryCache>,
    pairs: Vec<RawPair>,
    distances: Vec<f64>,
    pub(super) trace: Vec<IcpTrace>,
    /// Sum of the squared residuals of the last pairs, m².
    sum_of_squares_m2: f64,
    /// Mean over the cloud of `min(d², τ²)` at the last association, m².
    pub(super) truncated_cost_m2: f64,
}

impl IcpWorkspace {
    /// An empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The trace of the last registration; the first entry is the initial guess.
    #[must_use]
    pub fn trace(&self) -> &[IcpTrace] {
        &self.trace
    }

    /// The last pairs; `map` has to be the map of that registration.
    pub fn pairs<'a, M: NearestMap>(&'a self, map: &'a M) -> impl Iterator<Item = Pair> + 'a {
        self.pairs.iter().map(|pair| Pair {
            source_index: pair.source_index as usize,
            target_index: pair.target_index as usize,
            source: Point2::new(pair.source.0, pair.source.1),
            target: Point2::new(pair.target.0, pair.target.1),
            normal: map.normal(pair.target_index as usize),
        })
    }

    /// Number of the last pairs.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// Clears the cached neighbours, for another cloud or map.
    pub(crate) fn forget(&mut self) {
        self.cache.clear();
    }

    /// Pairs every cloud point, moved by `target_from_source`, with its nearest map point.
    pub(super) fn associate<M: NearestMap>(
        &mut self,
        cloud: &PointCloud,
        map: &M,
        target_from_source: &SE2,
        config: &IcpConfig,
    ) {
        let rotation = target_from_source.rotation();
        let tau_squared = config.tau_m * config.tau_m;
        let with_normals = config.variant == IcpVariant::PointToPlane;
        let (mut cost, mut last_found) = (0.0, None);
        let is_first = self.cache.is_empty();
        self.cache.resize(cloud.len(), QueryCache::default());
        self.pairs.clear();
        self.sum_of_squares_m2 = 0.0;
        let points = cloud.xs().iter().zip(cloud.ys()).zip(&mut self.cache);
        for (source_index, ((&x, &y), cache)) in (0..cloud.len()).zip(points) {
            let (x, y) = rotation.rotate(x, y);
            let source = (x + target_from_source.x(), y + target_from_source.y());
            if let (true, Some(index)) = (is_first, last_found) {
                // Neighbours in a sweep are neighbours in the map.
                *cache = QueryCache::near(index);
            }
            let query = Point2::new(source.0, source.1);
            let Some(nearest) = map.neighbor_cached(query, config.tau_m, cache) else {
                cost += tau_squared;
                continue;
            };
            cost += nearest.distance_squared_m2;
            last_found = Some(nearest.index);
            let target = map.point(nearest.index);
            let normal = if with_normals {
                map.normal(nearest.index).unwrap_or_default()
            } else {
                Vector2::zeros()
            };
            let pair = RawPair {
                source,
                target: (target.x, target.y),
                normal: (normal.x, normal.y),
                distance_squared_m2: nearest.distance_squared_m2,
                source_index: source_index as u32,
                target_index: nearest.index as u32,
            };
            self.sum_of_squares_m2 += pair.square_m2();
            self.pairs.push(pair);
        }
        self.truncated_cost_m2 = cost / cloud.len().max(1) as f64;
        if config.trim > 0.0 {
            self.reject(&Trimmed { share: config.trim });
        }
    }

    /// Drops the pairs that a rule rejects.
    pub(super) fn reject(&mut self, rule: &dyn PairRejection) {
        if self.pairs.is_empty() {
            return;
        }
        self.distances.clear();
        self.distances
            .extend(self.pairs.iter().map(|pair| pair.distance_squared_m2));
        let (limit_m2, rejected) = match rule.accepted(&mut self.distances) {
            Accepted::UpTo(limit_m2) => (limit_m2, Vec::new()),
            Accepted::AllBut(rejected) => (f64::INFINITY, rejected),
        };
        let (mut index, mut rejected) = (0, rejected.into_iter().peekable());
        self.pairs.retain(|pair| {
            let is_rejected = rejected.next_if_eq(&index).is_some();
            index += 1;
            !is_rejected && pair.distance_squared_m2 <= limit_m2
        });
        self.sum_of_squares_m2 = self.pairs.iter().map(RawPair::square_m2).sum();
    }

    /// The increment by the last pairs, and what they measured.
    pub(super) fn increment(&self, config: &IcpConfig) -> Solved {
        let width_m = config.huber_width_m;
        match config.variant {
            IcpVariant::PointToPoint => {
                let found = point_to_point(self.pairs.iter().map(|pair| PointPair {
                    source: pair.source,
                    target: pair.target,
                    weight: if width_m.is_finite() {
                        huber_weight(math::sqrt(pair.distance_squared_m2), width_m)
                    } else {
                        1.0
                    },
                }));
                Solved::Points(found)
            }
            IcpVariant::PointToPlane => {
                let with_normals = self.pairs.iter().filter(|pair| pair.has_normal());
                let step = point_to_plane(with_normals.map(|pair| {
                    let residual_m = pair.plane_residual_m();
                    PlanePair {
                        source: pair.source,
                        residual_m,
                        normal: pair.normal,
                        weight: huber_weight(residual_m.abs(), width_m),
                    }
                }));
                Solved::Planes(step)
            }
        }
    }

    /// Number of the last pairs that the increment uses with full weight: their residual is within the kernel's width.
    pub(super) fn full_weights(&self, config: &IcpConfig) -> usize {
        let width_m = config.huber_width_m;
        let is_full = |pair: &&RawPair| {
            let is_used = config.variant == IcpVariant::PointToPoint || pair.has_normal();
            is_used && pair.square_m2() <= width_m * width_m
        };
        self.pairs.iter().filter(is_full).count()
    }

    /// Root mean square residual of the last pairs, m; infinite without pairs.
    ///
    /// Point-to-plane uses the distance along the normal, if the pair has one.
    pub(super) fn rmse_m(&self) -> f64 {
        if self.pairs.is_empty() {
            return f64::INFINITY;
        }
        math::sqrt(self.sum_of_squares_m2 / self.pairs.len() as f64)
    }
}
