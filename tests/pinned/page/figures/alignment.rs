//! The worked example of alignment: four points, moved in closed form.

use ch16_slam2d::icp::closed_form;
use nalgebra::Matrix2;
use pr_geom::{Point2, Vector2};

/// Source points, and their partners in the target.
const POINTS: [([f64; 2], [f64; 2]); 4] = [
    ([1.0, 0.0], [2.8, 1.6]),
    ([0.0, 1.0], [1.4, 1.8]),
    ([-1.0, 0.0], [1.2, 0.4]),
    ([0.0, -1.0], [2.6, 0.2]),
];

/// `theta_deg`, `dot`: results by name; `p0x` or `q3y`: a coordinate of a point.
pub fn value(what: &str) -> Option<f64> {
    let source = POINTS.map(|(p, _)| Point2::from(p));
    let target = POINTS.map(|(_, q)| Point2::from(q));
    let aligned = closed_form(&source, &target);
    let centroid = |points: &[Point2<f64>; 4]| {
        Point2::from(points.iter().map(|p| p.coords).sum::<Vector2<f64>>() / 4.0)
    };
    let (p_mean, q_mean) = (centroid(&source), centroid(&target));
    let spread = |points: &[Point2<f64>; 4], mean: Point2<f64>| -> f64 {
        points.iter().map(|p| (p - mean).norm_squared()).sum()
    };
    let moments: Matrix2<f64> = source
        .iter()
        .zip(&target)
        .map(|(p, q)| (p - p_mean) * (q - q_mean).transpose())
        .sum();
    let residual =
        |(p, q): (&Point2<f64>, &Point2<f64>)| (aligned.pose.transform(*p) - q).norm_squared();
    Some(match what {
        "x" => aligned.pose.x(),
        "y" => aligned.pose.y(),
        "theta_deg" => aligned.pose.theta().to_degrees(),
        "cos" => aligned.pose.rotation().cos,
        "sin" => aligned.pose.rotation().sin,
        "trace_bound" => aligned.trace_bound,
        "dot" => moments.trace(),
        "cross" => moments[(0, 1)] - moments[(1, 0)],
        "spread_p" => spread(&source, p_mean),
        "spread_q" => spread(&target, q_mean),
        "residual" => source.iter().zip(&target).map(residual).sum(),
        _ => {
            let mut letters = what.chars();
            let (cloud, index, axis) = (letters.next()?, letters.next()?, letters.next()?);
            let points = if cloud == 'p' { source } else { target };
            let point = points.get(index.to_digit(10)? as usize)?;
            if axis == 'x' { point.x } else { point.y }
        }
    })
}
