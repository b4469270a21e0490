//! The rows of the point-to-plane step one by one, and the information that they add.

use ch16_slam2d::icp::{IcpConfig, Pair, centroid, correspondences};
use nalgebra::{Matrix3, Vector3};
use pr_geom::{Point2, SE2, Vector2, math};

use super::information::PoseInformation;
use super::scene::{RANGE_SIGMA_M, TerrainScene};

/// Eigenvalues below this share of the largest are rounding.
const ROUNDING_SHARE: f64 = 1e-9;

/// One row, `(n_x, n_y, p × n)`: `p` is the arm from the centroid of all pairs, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneRow {
    /// The point, m.
    pub point: Point2<f64>,
    /// The normal of its wall, a unit vector.
    pub normal: Vector2<f64>,
    /// `p × n`, m.
    pub lever_m: f64,
}

/// All rows of a scene at the truth, in the order of the beams.
///
/// The walls of the scenes are parallel to the axes. Each row takes the true normal of its wall instead of
/// the noisy one, so a degenerate direction is exactly degenerate.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRows {
    /// The centroid of all pairs, m.
    pub centroid: Point2<f64>,
    /// The rows.
    pub rows: Vec<PlaneRow>,
}

/// The constraints that some rows put on a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowConstraints {
    /// Number of independent rows, up to 3.
    pub rank: usize,
    /// The motion `(v_x, v_y, ω)` about the centroid that no row constrains, a unit vector in m and rad with
    /// `v_x ≥ 0`; `None` unless there is exactly one.
    pub null: Option<Vector3<f64>>,
    /// Standard deviation of the position along x, m; `None` unless the rank is full.
    pub along_m: Option<f64>,
}

impl PlaneRows {
    /// The rows of a scene with pairs up to `tau_m`.
    #[must_use]
    pub fn from_scene(scene: &TerrainScene, tau_m: f64) -> Self {
        let config = IcpConfig {
            tau_m,
            ..IcpConfig::default()
        };
        let pairs = correspondences(scene.cloud(), scene.map(), SE2::identity(), &config);
        let centroid = centroid(&pairs);
        let row = |pair: &Pair| {
            let normal = wall_normal(pair.normal?);
            let arm = pair.source - centroid;
            Some(PlaneRow {
                point: pair.source,
                normal,
                lever_m: arm.x * normal.y - arm.y * normal.x,
            })
        };
        Self {
            centroid,
            rows: pairs.iter().filter_map(row).collect(),
        }
    }

    /// The constraints of the first `taken` rows, for the scene's range noise, with a row of odometry `(1, 0,
    /// 0)` of weight `1/σ²` if its standard deviation σ (m) is given.
    #[must_use]
    pub fn constraints(&self, taken: usize, odometry_sigma_m: Option<f64>) -> RowConstraints {
        let mut information = Matrix3::zeros();
        for row in self.rows.iter().take(taken) {
            let h = Vector3::new(row.normal.x, row.normal.y, row.lever_m);
            information += h * h.transpose() / (RANGE_SIGMA_M * RANGE_SIGMA_M);
        }
        if let Some(sigma_m) = odometry_sigma_m {
            information.m11 += 1.0 / (sigma_m * sigma_m);
        }
        let known = PoseInformation::new(information);
        let floor = ROUNDING_SHARE * known.eigenvalues[2];
        let rank = known.eigenvalues.iter().filter(|&&e| e > floor).count();
        let covariance = information.try_inverse().filter(|_| rank == 3);
        RowConstraints {
            rank,
            null: (rank == 2).then(|| {
                let null = known.eigenvectors.column(0).into_owned();
                if null.x < 0.0 { -null } else { null }
            }),
            along_m: covariance.map(|covariance| math::sqrt(covariance.m11)),
        }
    }
}

/// The axis closest to a measured normal, with its sign.
fn wall_normal(measured: Vector2<f64>) -> Vector2<f64> {
    if measured.x.abs() > measured.y.abs() {
        Vector2::new(measured.x.signum(), 0.0)
    } else {
        Vector2::new(0.0, measured.y.signum())
    }
}

#[cfg(test)]
mod tests {
    use super::super::SceneKind;
    use super::*;

    fn rows(kind: SceneKind) -> PlaneRows {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        PlaneRows::from_scene(&scene, 0.6)
    }

    #[test]
    fn no_row_of_the_corridor_constrains_the_step_along_it() {
        let corridor = rows(SceneKind::LongCorridor);
        assert!(corridor.rows.len() > 40, "{}", corridor.rows.len());
        assert!(corridor.rows.iter().all(|row| row.normal.x == 0.0));
        let ranks: Vec<usize> = (0..=corridor.rows.len())
            .map(|taken| corridor.constraints(taken, None).rank)
            .collect();
        assert_eq!(ranks[..3], [0, 1, 2]);
        assert!(ranks[2..].iter().all(|&rank| rank == 2));
        let all = corridor.constraints(usize::MAX, None);
        let null = all.null.unwrap();
        // 1e-12: roundings of an eigenvector whose other entries are zero.
        assert!((null.x - 1.0).abs() < 1e-12 && null.y.abs() + null.z.abs() < 1e-12);
        assert_eq!(all.along_m, None);
    }

    #[test]
    fn one_row_of_odometry_restores_the_rank_with_its_own_deviation() {
        let corridor = rows(SceneKind::LongCorridor);
        for sigma_m in [0.01, 0.05, 0.5] {
            let all = corridor.constraints(usize::MAX, Some(sigma_m));
            assert_eq!((all.rank, all.null), (3, None));
            // 1e-9: the inverse divides by a determinant of 1e17.
            assert!((all.along_m.unwrap() / sigma_m - 1.0).abs() < 1e-9);
        }
        // The room's walls constrain every direction: odometry of 0.5 m adds little to a millimetre.
        let room = rows(SceneKind::Room);
        let (without, with) = (
            room.constraints(200, None),
            room.constraints(200, Some(0.5)),
        );
        assert_eq!(without.rank, 3);
        assert!(without.along_m.unwrap() < 0.003);
        assert!(with.along_m.unwrap() / without.along_m.unwrap() > 0.999);
    }
}
