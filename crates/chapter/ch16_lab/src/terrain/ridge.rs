//! Changes of data association: where ICP's cost has a ridge.
//!
//! The cost of a point is the squared distance to its nearest map point. It has a kink where two map points
//! are equally near, and another where the nearest one leaves the reach τ. A shift across such a line changes
//! the point's partner.

use pr_geom::{Point2, Vector2, math};

use super::{TerrainScene, TerrainSettings};
use ch16_slam2d::cloud::NearestMap;

/// A point of the sweep, its partner, and the nearest change of partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partner {
    /// The point at the given shift.
    pub point: Point2<f64>,
    /// Its nearest map point within τ.
    pub partner: Option<Point2<f64>>,
    /// The change within the given reach.
    pub change: Option<PartnerChange>,
}

/// The effect of a small shift on a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PartnerChange {
    /// Another map point becomes the nearest.
    Other(Point2<f64>),
    /// The partner leaves the reach τ.
    Lost,
    /// A map point comes into the reach τ.
    Found(Point2<f64>),
}

impl TerrainScene {
    /// The partners of all points at the shift `offset_m` with the τ and the heading of `settings`, and their
    /// changes under a further shift of at most `within_m`.
    ///
    /// Two map points q and r are equally near on the line between them, whose distance from a point p that
    /// is nearer to q is `(|p − r|² − |p − q|²) / (2 |r − q|)`.
    #[must_use]
    pub fn partners(
        &self,
        settings: &TerrainSettings,
        offset_m: Vector2<f64>,
        within_m: f64,
    ) -> Vec<Partner> {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        self.turned_into(settings.heading_deg, &mut xs, &mut ys);
        let points = xs.into_iter().zip(ys);
        points
            .map(|(x, y)| self.partner(Point2::new(x, y) + offset_m, settings.tau_m, within_m))
            .collect()
    }

    fn partner(&self, point: Point2<f64>, tau_m: f64, within_m: f64) -> Partner {
        let map = self.map();
        let alone = Partner {
            point,
            partner: None,
            change: None,
        };
        let Some(nearest) = map.neighbor(point, tau_m + within_m) else {
            return alone;
        };
        let to = map.point(nearest.index);
        let distance_m = math::sqrt(nearest.distance_squared_m2);
        if distance_m > tau_m {
            return Partner {
                change: Some(PartnerChange::Found(to)),
                ..alone
            };
        }
        let change = match self.rival(point, nearest.index, distance_m, within_m) {
            Some(rival) => Some(PartnerChange::Other(rival)),
            None => (distance_m + within_m > tau_m).then_some(PartnerChange::Lost),
        };
        Partner {
            partner: Some(to),
            change,
            ..alone
        }
    }

    /// The map point that becomes the nearest first, if any does within `within_m`.
    fn rival(
        &self,
        point: Point2<f64>,
        nearest: usize,
        distance_m: f64,
        within_m: f64,
    ) -> Option<Point2<f64>> {
        let map = self.map();
        let partner = map.point(nearest);
        let mut first = None;
        let mut soonest_m = within_m;
        // A rival is at most 2 · within farther away: a shift brings the one closer by its length, and moves
        // the other away by as much.
        map.for_each_within(point, distance_m + 2.0 * within_m, |index| {
            let other = map.point(index);
            let apart_m = (other - partner).norm();
            if index == nearest || apart_m == 0.0 {
                return;
            }
            let ahead_m2 = (other - point).norm_squared() - distance_m * distance_m;
            let shift_m = ahead_m2 / (2.0 * apart_m);
            if shift_m <= soonest_m {
                soonest_m = shift_m;
                first = Some(other);
            }
        });
        first
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{SceneKind, TerrainProbe};

    const WITHIN_M: f64 = 0.005;

    fn scene() -> TerrainScene {
        TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M)
    }

    #[test]
    fn predicted_changes_happen_within_the_reach_and_no_others() {
        let scene = scene();
        let settings = TerrainSettings {
            tau_m: 0.2,
            ..TerrainSettings::default()
        };
        let map = scene.map();
        let nearest = |point: Point2<f64>| map.neighbor(point, settings.tau_m).map(|n| n.index);
        let mut changes = 0;
        for (dx, dy) in [(0.3, -0.3), (0.05, 0.0), (0.11, 0.17), (-0.6, 0.4)] {
            let here = Vector2::new(dx, dy);
            for partner in scene.partners(&settings, here, WITHIN_M) {
                let before = nearest(partner.point);
                assert_eq!(before.map(|index| map.point(index)), partner.partner);
                // In all directions, slightly beyond the reach and slightly within it.
                let changes_at = |reach_m: f64| {
                    (0..64).any(|k| {
                        let angle = f64::from(k) * core::f64::consts::TAU / 64.0;
                        let step = Vector2::new(angle.cos(), angle.sin()) * reach_m;
                        nearest(partner.point + step) != before
                    })
                };
                if partner.change.is_some() {
                    changes += 1;
                    assert!(changes_at(1.01 * WITHIN_M), "{partner:?}");
                } else {
                    assert!(!changes_at(0.99 * WITHIN_M), "{partner:?}");
                }
            }
        }
        assert!(changes > 10, "{changes} changes");
    }

    #[test]
    fn at_the_truth_no_point_of_a_sweep_on_itself_is_about_to_change() {
        let scene = scene();
        let settings = TerrainSettings::default();
        let partners = scene.partners(&settings, Vector2::zeros(), WITHIN_M);
        assert!(partners.iter().all(|partner| partner.change.is_none()));
        assert_eq!(
            TerrainProbe::new(&scene, &settings).icp_cost_m2(Vector2::zeros()),
            0.0
        );
    }
}
