//! Walls through the returns of a scan, where they are far apart.

use nalgebra::Point2;
use pr_geom::math;

use crate::cloud::PointCloud;

/// Spacing of the points on a wall, m: that of a search's cells.
const SPACING_M: f64 = 0.1;
/// Largest distance of the middle one of three returns on a wall from the line through the others, m: two standard
/// deviations of a point.
const FLAT_M: f64 = 0.05;
/// Smallest cosine of the angle between the gaps of three returns on a wall: 25°.
const MIN_COSINE: f64 = 0.9;
/// A gap has a beam without a return if it is wider than the next one, by bearing, times this.
const MAX_TURNS: f64 = 1.5;

/// Adds points of the walls between adjacent returns of a scan, body frame.
///
/// Two returns are on a wall if the return before or after them is on one line with them, and no beam passed between
/// them.
pub(super) fn add_between(scan: impl IntoIterator<Item = Point2<f64>>, walls: &mut PointCloud) {
    let mut returns = scan.into_iter();
    let mut next = || returns.next();
    let (mut before, mut from) = (None, next());
    let (mut to, mut after) = (next(), next());
    while let (Some(one), Some(other)) = (from, to) {
        let gap_m = (other - one).norm();
        if gap_m > SPACING_M && is_wall(before, one, other, after) {
            let parts = (gap_m / SPACING_M).ceil();
            for part in 1..parts as usize {
                walls.push(one + (other - one) * (part as f64 / parts));
            }
        }
        (before, from, to, after) = (from, to, after, next());
    }
}

fn is_wall(
    before: Option<Point2<f64>>,
    one: Point2<f64>,
    other: Point2<f64>,
    after: Option<Point2<f64>>,
) -> bool {
    let turns = [
        before.map(|before| turn_rad(before, one)),
        after.map(|after| turn_rad(other, after)),
    ];
    let widest_rad = turns.into_iter().flatten().fold(0.0, math::max);
    let is_straight = before.is_some_and(|before| are_straight(before, one, other))
        || after.is_some_and(|after| are_straight(one, other, after));
    is_straight && turn_rad(one, other) <= MAX_TURNS * widest_rad
}

/// Angle between the bearings of two points.
fn turn_rad(from: Point2<f64>, to: Point2<f64>) -> f64 {
    math::atan2(from.coords.perp(&to.coords), from.coords.dot(&to.coords)).abs()
}

/// Whether a line through the outer two of three points passes through the middle one, in this order.
fn are_straight(first: Point2<f64>, middle: Point2<f64>, last: Point2<f64>) -> bool {
    let (one, two, whole) = (middle - first, last - middle, last - first);
    one.dot(&two) > MIN_COSINE * one.norm() * two.norm()
        && one.perp(&whole).abs() <= FLAT_M * whole.norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(scan: &[(f64, f64)]) -> Vec<Point2<f64>> {
        let mut walls = PointCloud::default();
        add_between(scan.iter().map(|at| Point2::new(at.0, at.1)), &mut walls);
        walls.iter().collect()
    }

    /// Returns of beams 2° apart on the wall y = 1, up to a bearing of 14°.
    fn grazed(beams: usize) -> Vec<(f64, f64)> {
        let bearing = |beam: usize| (90.0 - 2.0 * beam as f64).to_radians();
        (0..beams)
            .map(|beam| (1.0 / bearing(beam).tan(), 1.0))
            .collect()
    }

    #[test]
    fn a_wall_at_a_grazing_angle_has_no_gaps() {
        let scan = grazed(39);
        let gap_m = scan[38].0 - scan[37].0;
        assert!(gap_m > 0.4, "{gap_m}");
        let mut xs: Vec<f64> = between(&scan).iter().map(|at| at.x).collect();
        xs.extend(scan.iter().map(|at| at.0));
        xs.sort_by(f64::total_cmp);
        // 1e-9: rounding.
        assert!(xs.is_sorted_by(|one, next| next - one <= SPACING_M + 1e-9));
        assert!(between(&scan).iter().all(|at| (at.y - 1.0).abs() < 1e-9));
    }

    #[test]
    fn a_gap_that_a_beam_passed_is_no_wall() {
        let mut scan = grazed(39);
        scan.remove(30);
        let through = (scan[29].0, scan[30].0);
        let is_through = |at: &Point2<f64>| at.x > through.0 && at.x < through.1;
        assert!(!between(&scan).iter().any(is_through));
        assert!(between(&grazed(39)).iter().any(is_through));
    }

    #[test]
    fn a_wall_does_not_continue_from_an_edge_to_the_wall_behind_it() {
        let near = (0..8).map(|k| (0.07 * f64::from(k) - 0.56, 1.0));
        let far = (0..8).map(|k| (0.14 * f64::from(k), 2.0));
        let scan: Vec<(f64, f64)> = near.chain(far).rev().collect();
        let is_open = |at: &Point2<f64>| at.y > 1.01 && at.y < 1.99;
        assert!(!between(&scan).iter().any(is_open));
    }
}
