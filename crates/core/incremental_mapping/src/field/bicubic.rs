//! Bicubic interpolation between the centres of cells, continuously differentiable.

use pr_geom::Vector2;

/// Value and gradient of a field at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSample {
    /// Its value.
    pub value: f64,
    /// Its gradient by x and y, per cell side.
    pub slope: Vector2<f64>,
}

/// The weights of four neighbours at a fraction `t` from the second to the third, and their
/// derivatives by t.
fn weights(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, t3) = (t * t, t * t * t);
    (
        [
            -0.5 * t + t2 - 0.5 * t3,
            1.0 - 2.5 * t2 + 1.5 * t3,
            0.5 * t + 2.0 * t2 - 1.5 * t3,
            -0.5 * t2 + 0.5 * t3,
        ],
        [
            -0.5 + 2.0 * t - 1.5 * t2,
            -5.0 * t + 4.5 * t2,
            0.5 + 4.0 * t - 4.5 * t2,
            -t + 1.5 * t2,
        ],
    )
}

/// The field at the fractions `(tx, ty)` of a cell's side from the second to the third of four values in
/// each of four rows.
///
/// Value and gradient are continuous from cell to cell; at a cell's centre the value is the cell's.
/// Source: Keys, "Cubic convolution interpolation for digital image processing", 1981, a = −½.
#[must_use]
pub fn bicubic(rows: &[[f64; 4]; 4], tx: f64, ty: f64) -> FieldSample {
    let ((wx, dx), (wy, dy)) = (weights(tx), weights(ty));
    let mut value = 0.0;
    let mut slope = Vector2::zeros();
    for (row, (wy, dy)) in rows.iter().zip(wy.into_iter().zip(dy)) {
        let along = |w: &[f64; 4]| row[0] * w[0] + row[1] * w[1] + row[2] * w[2] + row[3] * w[3];
        let here = along(&wx);
        value += wy * here;
        slope.x += wy * along(&dx);
        slope.y += dy * here;
    }
    FieldSample { value, slope }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_interpolated_exactly() {
        // Cubic convolution reproduces polynomials of the second degree (Keys 1981).
        let at = |x: f64, y: f64| 1.0 + 2.0 * x - 3.0 * y + 0.5 * x * x + x * y - y * y;
        let rows = core::array::from_fn(|row| {
            core::array::from_fn(|column| at(column as f64 - 1.0, row as f64 - 1.0))
        });
        for (x, y) in [(0.0, 0.0), (0.3, 0.8), (0.99, 0.01), (1.0, 1.0)] {
            let found = bicubic(&rows, x, y);
            // 1e-13: some dozen roundings of numbers below 30.
            assert!((found.value - at(x, y)).abs() < 1e-13);
            assert!((found.slope.x - (2.0 + x + y)).abs() < 1e-13);
            assert!((found.slope.y - (-3.0 + x - 2.0 * y)).abs() < 1e-13);
        }
    }
}
