//! The directions of a scan's beams, and the beam nearest to a point.

use pr_geom::Rotation;

/// Unit vectors of the beams in the sensor frame, in order of bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Beams {
    directions: Vec<Rotation>,
}

impl Beams {
    /// Creates beams at these bearings in radians, which must increase and span at most one turn.
    #[must_use]
    pub fn new(bearings_rad: &[f64]) -> Self {
        Self {
            directions: bearings_rad.iter().map(|&b| Rotation::new(b)).collect(),
        }
    }

    /// Unit vectors of the beams in the sensor frame.
    #[must_use]
    pub fn directions(&self) -> &[Rotation] {
        &self.directions
    }

    /// Projection of the point `(x, y)` onto beam `beam`, in metres.
    #[inline]
    #[must_use]
    pub fn along(&self, beam: usize, x: f64, y: f64) -> f64 {
        let direction = &self.directions[beam];
        direction.cos * x + direction.sin * y
    }

    /// The beam whose bearing is nearest to that of the point `(x, y)`, in the sensor frame.
    ///
    /// Climbs from `hint` to better neighbours, because around the circle the distance along a beam has
    /// a single peak. On a ray the answer is the hint or next to it, so no angle is computed.
    #[inline]
    #[must_use]
    pub fn nearest(&self, x: f64, y: f64, hint: usize) -> usize {
        let n = self.directions.len();
        let mut best = hint;
        let mut best_along = self.along(best, x, y);
        for forward in [true, false] {
            loop {
                let next = match (forward, best) {
                    (true, k) if k + 1 == n => 0,
                    (true, k) => k + 1,
                    (false, 0) => n - 1,
                    (false, k) => k - 1,
                };
                let along = self.along(next, x, y);
                if along <= best_along {
                    break;
                }
                (best, best_along) = (next, along);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use pr_geom::{math, wrap_angle};

    use super::*;

    #[test]
    fn the_walk_finds_the_beam_that_a_search_over_all_angles_finds() {
        let bearings: Vec<f64> = (0..120).map(|k| -PI + f64::from(k) * TAU / 120.0).collect();
        let beams = Beams::new(&bearings);
        for step in 0..400 {
            // An irrational step, so no point is exactly between two beams.
            let angle = f64::from(step) * 0.618_033_988_7;
            let (y, x) = math::sin_cos(angle);
            let off = |b: &f64| wrap_angle(angle - b).abs();
            let expected = (0..120)
                .min_by(|&a, &b| off(&bearings[a]).total_cmp(&off(&bearings[b])))
                .unwrap();
            for hint in [0, expected, (expected + 50) % 120, 119] {
                assert_eq!(beams.nearest(2.0 * x, 2.0 * y, hint), expected);
            }
        }
    }
}
