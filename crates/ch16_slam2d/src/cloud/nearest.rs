//! What every map can be asked.

use nalgebra::{Point2, Vector2};

/// The nearest point of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Index of the point in the map, for [`NearestMap::point`] and [`NearestMap::normal`].
    pub index: usize,
    /// Squared distance to the query, m².
    pub distance_squared_m2: f64,
}

/// What a moving query remembers of its last search, so that the next one can often do without.
///
/// A memory belongs to one query point and one map. It changes the time, never the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryCache {
    /// The nearest point found then, or [`QueryCache::NO_POINT`].
    pub(super) index: u32,
    /// Where the query was then.
    pub(super) anchor: (f64, f64),
    /// No other point was nearer to the anchor than this, m.
    pub(super) clearance_m: f64,
}

impl QueryCache {
    pub(super) const NO_POINT: u32 = u32::MAX;

    /// A memory of no search, but of a point of the map that is likely to be near.
    #[must_use]
    pub fn near(index: usize) -> Self {
        Self {
            index: index as u32,
            ..Self::default()
        }
    }
}

impl Default for QueryCache {
    /// Remembers nothing.
    fn default() -> Self {
        Self {
            index: Self::NO_POINT,
            anchor: (0.0, 0.0),
            clearance_m: 0.0,
        }
    }
}

/// A map of points that finds nearest neighbours.
///
/// All maps agree on the answer to the last bit. Among points at exactly the same distance the
/// one in the cell with the smaller x index wins, then the smaller y index, then the one that was
/// inserted first: the order in which the chapter's double loop visits them.
pub trait NearestMap {
    /// Number of points that were kept.
    fn len(&self) -> usize;

    /// Whether the map has no points.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Point `index`, m.
    fn point(&self, index: usize) -> Point2<f64>;

    /// Unit normal of point `index`, where it has one.
    fn normal(&self, index: usize) -> Option<Vector2<f64>>;

    /// The nearest point strictly closer than `radius_m`.
    fn neighbor(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor>;

    /// As [`NearestMap::neighbor`], for a query that moves a little from call to call.
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
