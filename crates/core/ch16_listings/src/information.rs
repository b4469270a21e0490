//! The information of a registration.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::Correspondence;

/// `Σ J Jᵀ / (σ² · inflate)` with a row `J = (n, (p − c) × n)` for each direction that a pair
/// measures, about the centroid c of all pairs, along the axes of the map; 3×3, translation first.
///
/// `sigma` is the noise of a point, m. `inflate` divides, because neighbouring beams are not independent.
#[must_use]
pub fn icp_information(pairs: &[Correspondence], sigma: f64, inflate: f64) -> Matrix3<f64> {
    let sum: Vector2<f64> = pairs.iter().map(|pair| pair.src.coords).sum();
    let centroid = sum / pairs.len().max(1) as f64;
    let mut information = Matrix3::zeros();
    for pair in pairs {
        for n in pair.constrained_directions() {
            let row = Vector3::new(n.x, n.y, (pair.src.coords - centroid).perp(&n));
            information += row * row.transpose();
        }
    }
    information / (sigma * sigma * inflate)
}

/// The information with `ridge` on its diagonal, scaled so that no diagonal entry exceeds `cap`.
///
/// Scaling keeps the matrix positive definite; clipping single entries would not.
#[must_use]
pub fn regularize(omega: Matrix3<f64>, ridge: f64, cap: f64) -> Matrix3<f64> {
    let ridged = omega + Matrix3::identity() * ridge;
    let largest = ridged.diagonal().max();
    if largest > cap {
        ridged * (cap / largest)
    } else {
        ridged
    }
}
