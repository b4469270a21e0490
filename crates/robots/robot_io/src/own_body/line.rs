//! The straight line in which the plane of a leaning laser meets the floor.

use ch16_slam2d::scan::LaserScan;
use pr_geom::math;

use super::fixed_m;

/// Beams on a line: two determine it, and three others confirm it.
const FEWEST_BEAMS: usize = 5;
/// Most points through which lines are tried, pair by pair.
const MAX_TRIED: usize = 64;

/// A line in the sensor's frame, `x cos φ + y sin φ = d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// φ, rad.
    pub direction_rad: f64,
    /// d, m; positive.
    pub distance_m: f64,
}

impl Line {
    fn through(one: [f64; 2], other: [f64; 2]) -> Option<Self> {
        let along = [other[0] - one[0], other[1] - one[1]];
        let length_m = math::norm2(along[0], along[1]);
        if length_m == 0.0 {
            return None;
        }
        let signed_m = (along[0] * one[1] - along[1] * one[0]) / length_m;
        let sign = if signed_m < 0.0 { -1.0 } else { 1.0 };
        Some(Self {
            direction_rad: math::atan2(sign * along[0], -sign * along[1]),
            distance_m: signed_m.abs(),
        })
    }

    /// The line on which most of these points lie; `None` if they are few, or on a circle around the sensor as well.
    pub fn of(points: &[[f64; 2]]) -> Option<Self> {
        let every = points.len().div_ceil(MAX_TRIED).max(1);
        let tried: Vec<[f64; 2]> = points.iter().step_by(every).copied().collect();
        let on = |line: &Self| -> Vec<[f64; 2]> {
            let is_on = |point: &&[f64; 2]| line.is_at(**point);
            points.iter().filter(is_on).copied().collect()
        };
        let mut best = (FEWEST_BEAMS - 1, None);
        for (number, one) in tried.iter().enumerate() {
            for other in &tried[number + 1..] {
                let found = Self::through(*one, *other);
                let count = found.as_ref().map_or(0, |line| on(line).len());
                if count > best.0 {
                    best = (count, found);
                }
            }
        }
        let line = Self::fitted(&on(&best.1?))?;
        let on = on(&line);
        let ranges_m = || on.iter().map(|point| math::norm2(point[0], point[1]));
        let farthest_m = ranges_m().fold(0.0, f64::max);
        let nearest_m = ranges_m().fold(f64::INFINITY, f64::min);
        let bends = farthest_m - nearest_m > 2.0 * fixed_m(line.distance_m);
        (on.len() >= FEWEST_BEAMS && bends).then_some(line)
    }

    /// Least squares of `a x + b y = 1`.
    fn fitted(points: &[[f64; 2]]) -> Option<Self> {
        let sum = |of: fn(&[f64; 2]) -> f64| points.iter().map(of).sum::<f64>();
        let (xx, xy, yy) = (
            sum(|p| p[0] * p[0]),
            sum(|p| p[0] * p[1]),
            sum(|p| p[1] * p[1]),
        );
        let (x, y) = (sum(|p| p[0]), sum(|p| p[1]));
        let determinant = xx * yy - xy * xy;
        let a = (x * yy - y * xy) / determinant;
        let b = (y * xx - x * xy) / determinant;
        let length = math::norm2(a, b);
        let line = Self {
            direction_rad: math::atan2(b, a),
            distance_m: 1.0 / length,
        };
        (length.is_finite() && length > 0.0).then_some(line)
    }

    fn is_at(&self, [x, y]: [f64; 2]) -> bool {
        let (sin, cos) = math::sin_cos(self.direction_rad);
        (x * cos + y * sin - self.distance_m).abs() < fixed_m(self.distance_m)
    }

    /// Whether a beam ends on the line.
    pub fn is_met_by(&self, scan: &LaserScan, beam: usize) -> bool {
        let range_m = scan.ranges_m[beam];
        let (sin, cos) = math::sin_cos(scan.bearing_rad(beam));
        scan.is_return(range_m) && self.is_at([range_m * cos, range_m * sin])
    }
}
