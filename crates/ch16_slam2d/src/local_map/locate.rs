//! Pose of a scan by one cost: from the prediction, and from other starts if the scan fits poorly there.

use pr_geom::SE2;

use super::{LocalMap, MapRegistration, MapRegistrationConfig, MotionPrior, PriorTail};
use crate::cloud::PointCloud;
use crate::metrics::position_error_m;
use crate::search::SearchWindow;

/// Without odometry a scan needs at least this fit to be sure of its basin, 0 to 1; `good_score` is lower, because
/// with odometry the prediction is evidence as well.
const SURE_SCORE: f64 = 0.9;
/// Other starts if the prediction is outside of the basin of convergence: offsets along the heading (m) and of the
/// heading (rad).
const STARTS: ([f64; 5], [f64; 9]) = (
    [0.0, -0.5, 0.5, -1.0, 1.0],
    [0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9, -1.2, 1.2],
);

/// Largest slip of the wheels that is looked for, in standard deviations.
const SLIP: f64 = 4.0;
/// Costs within this do not decide, nats: then the pose with the better score is taken, because the cost counts few of a
/// scan's points as independent.
const TIE: f64 = 0.5;
/// A larger prior cost means a deviation of more than three standard deviations.
const MAX_PRIOR_COST: f64 = 6.0;
/// Share of inliers that justifies such a deviation: a few points in unseen space fit any wall.
const MAJORITY: f64 = 0.5;
/// Share of points in observed free space above which a pose contradicts the map.
const MAX_CONTRADICTING: f64 = 0.05;

impl LocalMap {
    /// The pose of lowest cost among the registrations from the prediction, from `others`, and from the best pose of
    /// the window around the prediction.
    #[must_use]
    pub fn locate(
        &mut self,
        scan: &PointCloud,
        prior: &MotionPrior,
        others: &[SE2],
        config: &MapRegistrationConfig,
    ) -> MapRegistration {
        let stages = [config.max_correspondence_m, config.inlier_distance_m];
        let near = &stages[1..];
        let is_justified = |found: &MapRegistration| {
            found.fit.inliers as f64 >= MAJORITY * scan.len() as f64
                || prior.cost(&found.registered.pose) <= MAX_PRIOR_COST
        };
        let cheaper = |one: MapRegistration, other: MapRegistration| {
            if other.cost < one.cost && is_justified(&other) {
                other
            } else {
                one
            }
        };
        let mut best = self.register(scan, prior.pose, &stages, Some(prior), config);
        // With few pairs the registration is pulled farther than its information justifies.
        if prior.cost(&best.registered.pose) > MAX_PRIOR_COST {
            let predicted = self.register(scan, prior.pose, &[], Some(prior), config);
            best = cheaper(predicted, best);
        }
        // A registration from a distant start may slide along a wall although the scan fits better at the prediction.
        if self.fit(scan, &prior.pose, config).score > best.fit.score {
            best = cheaper(
                best,
                self.register(scan, prior.pose, near, Some(prior), config),
            );
        }
        // Odometry may be farther off than pairs of the first stage reach.
        let slip_m = SLIP * prior.sigma_m;
        if prior.tail == PriorTail::Student
            && slip_m > config.max_correspondence_m
            && slip_m <= 2.0 * config.max_correspondence_m
        {
            let reaches = [slip_m, stages[0], stages[1]];
            let slipped = self.register(scan, prior.pose, &reaches, Some(prior), config);
            let (one, other) = (best.registered.pose, slipped.registered.pose);
            let is_other = position_error_m(&one, &other) > config.inlier_distance_m;
            let is_fitting = slipped.fit.score > best.fit.score && slipped.cost < best.cost + TIE;
            if is_other && is_fitting && is_justified(&slipped) {
                best = slipped;
            }
        }
        let is_vague = 2.0 * prior.sigma_m > config.max_correspondence_m;
        if is_vague && best.fit.score < SURE_SCORE {
            for turn_rad in STARTS.1 {
                for ahead_m in STARTS.0 {
                    let start = prior.pose * SE2::new(ahead_m, 0.0, turn_rad);
                    if prior.cost(&start) < best.cost {
                        best = cheaper(
                            best,
                            self.register(scan, start, &stages, Some(prior), config),
                        );
                    }
                }
            }
        }
        let is_poor = |best: &MapRegistration| best.fit.score < config.good_score;
        for start in others {
            if is_poor(&best) {
                best = cheaper(
                    best,
                    self.register(scan, *start, &stages, Some(prior), config),
                );
            }
        }
        // A scan of unseen space fits anywhere: only one that contradicts the map was taken elsewhere.
        let is_contradicted =
            best.fit.contradicting as f64 >= MAX_CONTRADICTING * scan.len() as f64;
        if is_poor(&best) && is_contradicted {
            let window = SearchWindow::around(prior.pose, config.search_m, config.search_rad);
            if let Some(found) = self.search(scan, &window, 0.0) {
                best = cheaper(
                    best,
                    self.register(scan, found.best.pose, near, Some(prior), config),
                );
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use pr_geom::Point2;

    use super::*;
    use crate::local_map::{LocalMapConfig, RangeProfile};

    fn wall(points: i32, at: impl Fn(f64) -> Point2<f64>) -> PointCloud {
        (0..points).map(|k| at(0.05 * f64::from(k))).collect()
    }

    #[test]
    fn a_slip_beyond_the_pairs_of_the_first_stage_is_found() {
        // The end of a corridor: the side walls fit at any place along it.
        let sides = [-1.0, 1.0].map(|y| wall(100, |x| Point2::new(x, y)));
        // Without corners, whose normals would pull along it.
        let end = wall(24, |y| Point2::new(5.5, y - 0.6));
        let hall: PointCloud = sides[0]
            .iter()
            .chain(sides[1].iter())
            .chain(end.iter())
            .collect();
        let profile = Arc::new(RangeProfile::new(&hall));
        let mut map = LocalMap::default();
        map.rebuild([(SE2::identity(), &hall, &profile)]);
        let config = LocalMapConfig::default().registration();
        let found = |sigma_m: f64, map: &mut LocalMap| {
            let prior = MotionPrior {
                pose: SE2::new(0.36, 0.0, 0.0),
                sigma_m,
                sigma_rad: 0.02,
                tail: PriorTail::Student,
            };
            map.locate(&hall, &prior, &[], &config).registered.pose.x()
        };
        // 0.05 m: the spacing of the points.
        assert!(found(0.1, &mut map).abs() < 0.05);
        // 7 standard deviations are no slip that is looked for.
        assert!(found(0.05, &mut map) > 0.3);
    }

    #[test]
    fn an_unmapped_wall_is_not_matched_to_a_mapped_one() {
        // A corridor along x; through its door, three metres behind its wall, the robot sees another wall.
        let south = wall(200, |x| Point2::new(x, -1.0));
        let north = wall(200, |x| Point2::new(x, 1.0));
        let corridor: PointCloud = south.iter().chain(north.iter()).collect();
        let profile = Arc::new(RangeProfile::new(&corridor));
        let mut map = LocalMap::default();
        map.rebuild([(SE2::identity(), &corridor, &profile)]);
        let pose = SE2::new(5.0, 1.6, core::f64::consts::FRAC_PI_2);
        let seen = wall(40, |y| Point2::new(2.0, y - 1.0));
        let prior = MotionPrior {
            pose,
            sigma_m: 0.04,
            sigma_rad: 0.02,
            tail: PriorTail::Student,
        };
        let config = LocalMapConfig::default().registration();
        let others = [pose * SE2::new(-0.5, 0.0, 0.0)];
        let found = map.locate(&seen, &prior, &others, &config);
        assert!(pose.between(&found.registered.pose).step_size() < 0.05);
        // The wall would fit on the corridor's at a quarter turn.
        let laid = SE2::new(5.0, 3.0, -core::f64::consts::FRAC_PI_2);
        assert!(map.fit(&seen, &laid, &config).score > found.fit.score + 0.2);
    }
}
