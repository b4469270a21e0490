//! The rows of the point-to-plane step, one by one, and what they know of a pose.

use ch16_slam2d::icp::{IcpConfig, Pair, centroid, correspondences};
use nalgebra::{Matrix3, Vector3};
use pr_geom::{Point2, SE2, Vector2, math};

use super::information::PoseInformation;
use super::scene::{RANGE_SIGMA_M, TerrainScene};

/// Below this share of the largest eigenvalue there is nothing but rounding.
const ROUNDING_SHARE: f64 = 1e-9;

/// One row, `(n_x, n_y, p × n)`: `p` is the arm from the centroid of all pairs, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneRow {
    /// The point, m.
    pub point: Point2<f64>,
    /// The normal of the wall that it lies on, a unit vector.
    pub normal: Vector2<f64>,
    /// `p × n`, m.
    pub lever_m: f64,
}

/// All rows of a scene at the truth, in the order of the beams.
///
/// The walls of the scenes stand along the axes. Each row takes its wall's own normal, and not what noise
/// makes of it: so what the rows do not hold is held by nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRows {
    /// The centroid of all pairs, m.
    pub centroid: Point2<f64>,
    /// The rows.
    pub rows: Vec<PlaneRow>,
}

/// What some rows know of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowsKnow {
    /// Independent rows among them: up to 3.
    pub rank: usize,
    /// The motion `(v_x, v_y, ω)` about the centroid that every row takes to nothing, a unit vector with
    /// m and rad for its units and `v_x` not below nothing; where there is just one.
    pub null: Option<Vector3<f64>>,
    /// Standard deviation of the position along x, m; where the rank is full.
    pub along_m: Option<f64>,
}

impl PlaneRows {
    /// The rows of a scene with pairs up to `tau_m`.
    #[must_use]
    pub fn from_scene(scene: &TerrainScene, tau_m: f64) -> Self {
        let config = IcpConfig {
            tau_m: tau_m,
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

    /// What the first `taken` rows know, for the scene's range noise, with a row of odometry
    /// `(1, 0, 0)` of weight `1/σ²` where its deviation σ (m) is given.
    #[must_use]
    pub fn know(&self, taken: usize, odometry_sigma_m: Option<f64>) -> RowsKnow {
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
        RowsKnow {
            rank,
            null: (rank == 2).then(|| {
                let null = known.eigenvectors.column(0).into_owned();
                if null.x < 0.0 { -null } else { null }
            }),
            along_m: covariance.map(|covariance| math::sqrt(covariance.m11)),
        }
    }
}

/// The axis that a measured normal is nearest to, with its sign.
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
    fn every_row_of_the_corridor_takes_the_step_along_it_to_nothing() {
        let corridor = rows(SceneKind::LongCorridor);
        assert!(corridor.rows.len() > 40, "{}", corridor.rows.len());
        assert!(corridor.rows.iter().all(|row| row.normal.x == 0.0));
        let ranks: Vec<usize> = (0..=corridor.rows.len())
            .map(|taken| corridor.know(taken, None).rank)
            .collect();
        assert_eq!(ranks[..3], [0, 1, 2]);
        assert!(ranks[2..].iter().all(|&rank| rank == 2));
        let all = corridor.know(usize::MAX, None);
        let null = all.null.unwrap();
        // 1e-12: roundings of an eigenvector whose other entries are nothing.
        assert!((null.x - 1.0).abs() < 1e-12 && null.y.abs() + null.z.abs() < 1e-12);
        assert_eq!(all.along_m, None);
    }

    #[test]
    fn one_row_of_odometry_restores_the_rank_and_is_believed_to_its_deviation() {
        let corridor = rows(SceneKind::LongCorridor);
        for sigma_m in [0.01, 0.05, 0.5] {
            let all = corridor.know(usize::MAX, Some(sigma_m));
            assert_eq!((all.rank, all.null), (3, None));
            // 1e-9: the inverse divides by a determinant of 1e17.
            assert!((all.along_m.unwrap() / sigma_m - 1.0).abs() < 1e-9);
        }
        // The room's walls hold every direction: odometry of 0.5 m adds little to a millimetre.
        let room = rows(SceneKind::Room);
        let (without, with) = (room.know(200, None), room.know(200, Some(0.5)));
        assert_eq!(without.rank, 3);
        assert!(without.along_m.unwrap() < 0.003);
        assert!(with.along_m.unwrap() / without.along_m.unwrap() > 0.999);
    }
}
