//! The common interface of all maps.

use nalgebra::{Point2, Vector2};

/// The nearest point of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Index of the point in the map, for [`NearestMap::point`] and [`NearestMap::normal`].
    pub index: usize,
    /// Squared distance to the query, m².
    pub distance_squared_m2: f64,
}

/// Cached result of the last search of a moving query, which often makes the next one unnecessary.
///
/// A cache belongs to one query point and one map. It affects the time, never the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryCache {
    /// The nearest point of the last search, or [`QueryCache::NO_POINT`].
    pub(super) index: u32,
    /// Query position of the last search.
    pub(super) anchor: (f64, f64),
    /// No other point was nearer to the anchor than this, m.
    pub(super) clearance_m: f64,
}

impl QueryCache {
    pub(super) const NO_POINT: u32 = u32::MAX;

    /// An empty cache with a point of the map that is likely to be near.
    #[must_use]
    pub fn near(index: usize) -> Self {
        Self {
            index: index as u32,
            ..Self::default()
        }
    }
}

impl Default for QueryCache {
    /// An empty cache.
    fn default() -> Self {
        Self {
            index: Self::NO_POINT,
            anchor: (0.0, 0.0),
            clearance_m: 0.0,
        }
    }
}

/// A map of points with nearest-neighbour search.
///
/// All maps give the same answer to the last bit. Among points at exactly the same distance the
/// one in the cell with the smaller x index wins, then the smaller y index, then the one that was
/// inserted first: the order in which the chapter's double loop visits them.
pub trait NearestMap {
    /// Number of stored points.
    fn len(&self) -> usize;

    /// Whether the map has no points.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Point `index`, m.
    fn point(&self, index: usize) -> Point2<f64>;

    /// Unit normal of point `index`, if it has one.
    fn normal(&self, index: usize) -> Option<Vector2<f64>>;

    /// The nearest point strictly closer than `radius_m`.
    fn neighbor(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor>;

    /// [`NearestMap::neighbor`] for a query that moves a little from call to call.
    #[inline]
    fn neighbor_cached(
        &self,
        query: Point2<f64>,
        radius_m: f64,
        cache: &mut QueryCache,
    ) -> Option<Neighbor> {
        let _ = cache;
        self.neighbor(query, radius_m)
    }
}
