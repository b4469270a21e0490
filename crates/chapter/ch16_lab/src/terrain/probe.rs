//! Cost, score and their slopes at single shifts.

use pr_geom::{Point2, Vector2};

use super::{TerrainScene, TerrainSettings};
use ch16_slam2d::cloud::NearestMap;

/// Which landscape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Objective {
    /// Mean of `min(d², τ²)`, m²: smaller is better.
    IcpCost,
    /// Mean NDT score, no unit: larger is better.
    NdtScore,
}

/// A value of a landscape and its gradient over `(Δx, Δy)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// Cost in m², or score.
    pub value: f64,
    /// Its gradient: 1/m times the unit of the value.
    pub gradient: Vector2<f64>,
}

/// The landscapes of a scene, evaluated one shift at a time.
#[derive(Clone, Debug)]
pub struct TerrainProbe<'a> {
    scene: &'a TerrainScene,
    tau_m: f64,
    xs: Vec<f64>,
    ys: Vec<f64>,
}

impl<'a> TerrainProbe<'a> {
    /// A probe with the τ and the heading of `settings`.
    #[must_use]
    pub fn new(scene: &'a TerrainScene, settings: &TerrainSettings) -> Self {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        scene.turned_into(settings.heading_deg, &mut xs, &mut ys);
        Self {
            scene,
            tau_m: settings.tau_m,
            xs,
            ys,
        }
    }

    /// Value and gradient of a landscape at the shift `(Δx, Δy)`.
    #[must_use]
    pub fn slope(&self, objective: Objective, offset_m: Vector2<f64>) -> Slope {
        match objective {
            Objective::IcpCost => self.icp_slope(offset_m),
            Objective::NdtScore => self.ndt_slope(offset_m),
        }
    }

    /// Mean of `min(d², τ²)` at the shift `(Δx, Δy)`, m².
    #[must_use]
    pub fn icp_cost_m2(&self, offset_m: Vector2<f64>) -> f64 {
        self.icp_slope(offset_m).value
    }

    /// Mean NDT score at the shift `(Δx, Δy)`.
    #[must_use]
    pub fn ndt_score(&self, offset_m: Vector2<f64>) -> f64 {
        let sum: f64 = self
            .moved(offset_m)
            .map(|point| self.scene.ndt().score_point(point.x, point.y))
            .sum();
        sum / self.count()
    }

    /// The gradient holds the pairs fixed: exact, except where a pair changes.
    fn icp_slope(&self, offset_m: Vector2<f64>) -> Slope {
        let map = self.scene.map();
        let (mut value, mut gradient) = (0.0, Vector2::zeros());
        for point in self.moved(offset_m) {
            if let Some(nearest) = map.neighbor(point, self.tau_m) {
                value += nearest.distance_squared_m2;
                gradient += 2.0 * (point - map.point(nearest.index));
            } else {
                value += self.tau_m * self.tau_m;
            }
        }
        Slope {
            value: value / self.count(),
            gradient: gradient / self.count(),
        }
    }

    fn ndt_slope(&self, offset_m: Vector2<f64>) -> Slope {
        let (mut value, mut gradient) = (0.0, Vector2::zeros());
        for point in self.moved(offset_m) {
            for (gaussian, added) in self.scene.ndt().scores_around(point.x, point.y) {
                value += added;
                gradient -= gaussian.information * (point - gaussian.mean) * added;
            }
        }
        Slope {
            value: value / self.count(),
            gradient: gradient / self.count(),
        }
    }

    fn moved(&self, offset_m: Vector2<f64>) -> impl Iterator<Item = Point2<f64>> + '_ {
        let points = self.xs.iter().zip(&self.ys);
        points.map(move |(x, y)| Point2::new(x + offset_m.x, y + offset_m.y))
    }

    fn count(&self) -> f64 {
        self.xs.len().max(1) as f64
    }
}
