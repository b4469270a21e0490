//! Errors of a trajectory and of a map.
//!
//! Errors are relative to the simulated truth, without alignment: the first pose is known, so any
//! offset is an error. Map self-disagreement needs no truth: it is the distance between the map of
//! the first pass and the sweeps of the second. It cannot detect a map that is bent but consistent.

use pr_geom::{Point2, SE2, math};

use crate::cloud::{DenseMap, PointCloud};

/// Distance between two positions in metres.
#[must_use]
pub fn position_error_m(estimate: &SE2, truth: &SE2) -> f64 {
    math::norm2(estimate.x() - truth.x(), estimate.y() - truth.y())
}

/// Root mean square of some errors; 0 if there are none.
#[must_use]
pub fn rms(errors: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = errors
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), e| (sum + e * e, count + 1.0));
    if count == 0.0 {
        0.0
    } else {
        math::sqrt(sum / count)
    }
}

/// Settings for the comparison of the two passes of a lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisagreementConfig {
    /// Side of a cell of the first pass' map in metres.
    pub cell_m: f64,
    /// Points kept in a cell.
    pub max_per_cell: usize,
    /// Points without a neighbour within this distance (m) are ignored.
    pub reach_m: f64,
}

impl Default for DisagreementConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.2,
            max_per_cell: 12,
            reach_m: 1.5,
        }
    }
}

/// Map self-disagreement, accumulated sweep by sweep.
///
/// The root mean square distance from the points of the second pass to the nearest of the first.
#[derive(Clone, Debug)]
pub struct MapDisagreement {
    config: DisagreementConfig,
    first_pass: PointCloud,
    map: DenseMap,
    sum_of_squares_m2: f64,
    count: usize,
}

impl MapDisagreement {
    /// A comparison with no points on either side.
    #[must_use]
    pub fn new(config: DisagreementConfig) -> Self {
        Self {
            config,
            first_pass: PointCloud::default(),
            map: DenseMap::new(config.cell_m, config.max_per_cell),
            sum_of_squares_m2: 0.0,
            count: 0,
        }
    }

    /// Restarts with the sweeps of the first pass, each with its `world_from_body`.
    pub fn start<'a>(&mut self, first_pass: impl IntoIterator<Item = (&'a SE2, &'a PointCloud)>) {
        self.first_pass.clear();
        for (pose, cloud) in first_pass {
            self.first_pass.extend_transformed(cloud, pose);
        }
        self.map.rebuild(&self.first_pass);
        self.sum_of_squares_m2 = 0.0;
        self.count = 0;
    }

    /// Compares one sweep of the second pass, seen from `world_from_body`.
    pub fn compare(&mut self, world_from_body: &SE2, cloud: &PointCloud) {
        let rotation = world_from_body.rotation();
        let mut hint = None;
        for (&x, &y) in cloud.xs().iter().zip(cloud.ys()) {
            let (x, y) = rotation.rotate(x, y);
            let point = Point2::new(x + world_from_body.x(), y + world_from_body.y());
            let reach_m = self.config.reach_m;
            if let Some(found) = self.map.neighbor_from(point, reach_m, hint) {
                self.sum_of_squares_m2 += found.distance_squared_m2;
                self.count += 1;
                // The next beam hits close by.
                hint = Some(found.index);
            }
        }
    }

    /// Root mean square distance in metres; `None` before a point of the second pass was compared.
    #[must_use]
    pub fn value_m(&self) -> Option<f64> {
        (self.count > 0).then(|| math::sqrt(self.sum_of_squares_m2 / self.count as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall() -> PointCloud {
        (0..50)
            .map(|k| Point2::new(0.05 * f64::from(k), 0.0))
            .collect()
    }

    #[test]
    fn rms_of_three_and_four_is_the_root_of_twelve_and_a_half() {
        assert_eq!(rms([3.0, -4.0]), 12.5_f64.sqrt());
        assert_eq!(rms([]), 0.0);
    }

    #[test]
    fn a_wall_seen_twice_at_an_offset_disagrees_by_the_offset() {
        let mut disagreement = MapDisagreement::new(DisagreementConfig::default());
        let wall = wall();
        disagreement.start([(&SE2::identity(), &wall)]);
        assert_eq!(disagreement.value_m(), None);
        disagreement.compare(&SE2::from_xy(0.0, 0.3), &wall);
        assert!((disagreement.value_m().unwrap() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn points_beyond_the_reach_are_not_counted() {
        let mut disagreement = MapDisagreement::new(DisagreementConfig::default());
        let wall = wall();
        disagreement.start([(&SE2::identity(), &wall)]);
        disagreement.compare(&SE2::from_xy(0.0, 1.6), &wall);
        assert_eq!(disagreement.value_m(), None);
    }

    #[test]
    fn a_rigid_motion_of_everything_changes_no_error() {
        let mut disagreement = MapDisagreement::new(DisagreementConfig::default());
        let wall = wall();
        let second = SE2::new(0.02, 0.1, 0.05);
        let mut value_after = |motion: SE2| {
            disagreement.start([(&motion, &wall)]);
            disagreement.compare(&(motion * second), &wall);
            disagreement.value_m().unwrap()
        };
        let here = value_after(SE2::identity());
        let there = value_after(SE2::new(3.0, -2.0, 0.0));
        // 1e-12: the coordinates grow by a few metres, cells stay below their limit.
        assert!((here - there).abs() < 1e-12);
    }
}
