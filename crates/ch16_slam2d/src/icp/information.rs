//! How much a registration knows, for the edges of the pose graph.

use nalgebra::{Matrix3, Vector2};
use pr_geom::Rotation;

use super::Pair;
use super::align::PlaneHessian;

/// Added to the diagonal by [`regularize`], so that no direction is without any information.
const RIDGE: f64 = 1.0;
/// Largest diagonal entry that [`regularize`] leaves.
const MAX_DIAGONAL: f64 = 2500.0;

/// The information of a registration, `Σ J Jᵀ / (σ² · inflate)`, 3×3, translation first.
///
/// A pair with a normal contributes the row `J = (Rᵀ n, lever)`, one without the rows of both axes.
/// `lever` is the turn of the point about the centroid of all pairs, seen along the row's direction
/// (m), and `R` is the rotation of heading `body_theta` (rad), so that the matrix belongs to
/// perturbations in the body's frame. `sigma` is the range noise in metres. `inflate` accounts for
/// pairs that are not independent.
#[must_use]
pub fn icp_information(pairs: &[Pair], sigma: f64, inflate: f64, body_theta: f64) -> Matrix3<f64> {
    let centroid = pairs
        .iter()
        .fold(Vector2::zeros(), |sum, pair| sum + pair.source)
        / pairs.len().max(1) as f64;
    let body = Rotation::new(body_theta);
    let mut hessian = PlaneHessian::default();
    let weight = 1.0 / (sigma * sigma * inflate);
    for pair in pairs {
        let arm = pair.source - centroid;
        let mut add = |direction: Vector2<f64>| {
            let (nx, ny) = body.unrotate(direction.x, direction.y);
            let lever = arm.x * direction.y - arm.y * direction.x;
            hessian.add(nx, ny, lever, weight);
        };
        match pair.normal {
            Some(normal) => add(normal),
            None => {
                add(Vector2::x());
                add(Vector2::y());
            }
        }
    }
    hessian.matrix()
}

/// Makes an information matrix safe for the graph: adds 1 to the diagonal, then scales the whole
/// so that no diagonal entry exceeds 2500.
#[must_use]
pub fn regularize(information: &Matrix3<f64>) -> Matrix3<f64> {
    let ridged = information + Matrix3::identity() * RIDGE;
    let largest = ridged.diagonal().max();
    if largest > MAX_DIAGONAL {
        ridged * (MAX_DIAGONAL / largest)
    } else {
        ridged
    }
}
