//! A registration and a prediction, weighed by what each knows.

use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::scan::is_finite;

/// Smallest information of a registration in any direction: a standard deviation of 3 m or 3 rad.
const FLOOR: f64 = 0.1;

/// A registration and a prediction together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fusion {
    /// The pose between them, `world_from_body`.
    pub pose: SE2,
    /// By how much they disagree: `dᵀ(Λ⁻¹ + Π⁻¹)⁻¹ d`, of three degrees of freedom.
    pub chi2: f64,
}

/// The pose between a registration with its information and a prediction with its covariance.
///
/// With `d = log(R⁻¹ P)` it is `R exp((Λ + Π)⁻¹ Π d)`: Λ is the information of the registration R and Π
/// that of the prediction P, both 3×3, translation first, about the body. None where either is no
/// information.
pub(crate) fn fuse(
    registered: &SE2,
    information: &Matrix3<f64>,
    predicted: &SE2,
    covariance: &Matrix3<f64>,
) -> Option<Fusion> {
    let known = information + Matrix3::identity() * FLOOR;
    let believed = covariance.try_inverse()?;
    let gap = registered.between(predicted).log();
    let joint = (known.try_inverse()? + covariance).try_inverse()?;
    let mixed = (known + believed).try_inverse()?;
    let pose = registered.boxplus(&(mixed * (believed * gap)));
    is_finite(&pose).then(|| Fusion {
        pose,
        chi2: gap.dot(&(joint * gap)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn diagonal(x: f64, y: f64, theta: f64) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(x, y, theta))
    }

    #[test]
    fn along_a_corridor_the_wheels_decide_and_across_it_the_scan() {
        let scan = diagonal(0.0, 1e6, 1e6);
        let wheels = diagonal(1e-4, 1e-4, 1e-4);
        let (slid, driven) = (SE2::new(0.6, 0.02, 0.0), SE2::identity());
        let Fusion { pose, chi2 } = fuse(&slid, &scan, &driven, &wheels).unwrap();
        // 1e-3: the wheels' 1 cm against 3 m, and the scan's 1 mm against the wheels' 1 cm.
        assert!(pose.x().abs() < 1e-3, "{pose:?}");
        assert!((pose.y() - 0.02).abs() < 1e-3 && pose.theta().abs() < 1e-3);
        assert!(chi2 < 11.34, "{chi2}");
    }

    #[test]
    fn wheels_that_jump_disagree_with_a_scan_that_knows() {
        let scan = diagonal(1e4, 1e4, 1e4);
        let wheels = diagonal(1e-3, 1e-3, 1e-3);
        let (seen, jumped) = (SE2::identity(), SE2::new(1.5, 0.0, 0.0));
        let found = fuse(&seen, &scan, &jumped, &wheels).unwrap();
        assert!(found.chi2 > 1000.0, "{found:?}");
    }
}
