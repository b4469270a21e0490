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
/// Costs that differ by more than this, nats, refute a pose that the returns alone prefer: odds of 20 to 1.
const SURE: f64 = 3.0;
/// Share of inliers that justifies such a deviation: a few points in unseen space fit any wall.
const MAJORITY: f64 = 0.5;
/// Share of points in observed free space above which a pose contradicts the map.
const MAX_CONTRADICTING: f64 = 0.05;

/// Registrations of a scan from different starts, of which the best is kept.
struct Candidates<'a> {
    scan: &'a PointCloud,
    prior: &'a MotionPrior,
    config: &'a MapRegistrationConfig,
    best: MapRegistration,
}

impl Candidates<'_> {
    /// Keeps another one if it is cheaper.
    fn add(&mut self, other: MapRegistration) {
        if other.cost < self.best.cost && self.is_justified(&other) {
            self.best = other;
        }
    }

    /// Keeps one elsewhere if the scan fits better there and their costs do not decide against it.
    fn add_slip(&mut self, other: MapRegistration) {
        let is_fitting = other.fit.score > self.best.fit.score && other.cost < self.best.cost + TIE;
        if self.is_elsewhere(&other) && is_fitting && self.is_justified(&other) {
            self.best = other;
        }
    }

    fn is_justified(&self, found: &MapRegistration) -> bool {
        found.fit.inliers as f64 >= MAJORITY * self.scan.len() as f64 || !self.deviates(found)
    }

    fn deviates(&self, found: &MapRegistration) -> bool {
        self.prior.cost(&found.registered.pose) > MAX_PRIOR_COST
    }

    fn is_elsewhere(&self, other: &MapRegistration) -> bool {
        let [one, other] = [&self.best, other].map(|found| found.registered.pose);
        position_error_m(&one, &other) > self.config.inlier_distance_m
    }

    fn is_poor(&self) -> bool {
        self.best.fit.score < self.config.good_score
    }
}

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
        let first = self.register(scan, prior.pose, &stages, Some(prior), config);
        let mut found = Candidates {
            scan,
            prior,
            config,
            best: first,
        };
        // With few pairs the registration is pulled farther than its information justifies.
        if found.deviates(&first) {
            found.best = self.register(scan, prior.pose, &[], Some(prior), config);
            found.add(first);
        }
        // A registration from a distant start may slide along a wall although the scan fits better at the prediction.
        if self.fit(scan, &prior.pose, config).score > found.best.fit.score {
            found.add(self.register(scan, prior.pose, near, Some(prior), config));
        }
        // Odometry may be farther off than pairs of the first stage reach.
        let slip_m = SLIP * prior.sigma_m;
        if prior.tail == PriorTail::Student
            && slip_m > config.max_correspondence_m
            && slip_m <= 2.0 * config.max_correspondence_m
        {
            let reaches = [slip_m, stages[0], stages[1]];
            found.add_slip(self.register(scan, prior.pose, &reaches, Some(prior), config));
        }
        let is_vague = 2.0 * prior.sigma_m > config.max_correspondence_m;
        if is_vague && found.best.fit.score < SURE_SCORE {
            for turn_rad in STARTS.1 {
                for ahead_m in STARTS.0 {
                    let start = prior.pose * SE2::new(ahead_m, 0.0, turn_rad);
                    if prior.cost(&start) < found.best.cost {
                        found.add(self.register(scan, start, &stages, Some(prior), config));
                    }
                }
            }
        }
        for start in others {
            if found.is_poor() {
                found.add(self.register(scan, *start, &stages, Some(prior), config));
            }
        }
        // A scan of unseen space fits anywhere: only one that contradicts the map was taken elsewhere.
        let is_contradicted =
            found.best.fit.contradicting as f64 >= MAX_CONTRADICTING * scan.len() as f64;
        if found.is_poor() && is_contradicted {
            let window = SearchWindow::around(prior.pose, config.search_m, config.search_rad);
            if let Some(searched) = self.search(scan, &window, 0.0) {
                let start = searched.best.pose;
                found.add(self.register(scan, start, near, Some(prior), config));
            }
        }
        if prior.tail == PriorTail::Student && found.deviates(&found.best) {
            self.without_slip(&mut found);
        }
        found.best
    }

    /// Replaces a pose that contradicts the odometry by that of wheels that do not slip, if that is cheaper on walls.
    fn without_slip(&mut self, found: &mut Candidates<'_>) {
        let (scan, config) = (found.scan, found.config);
        let rolling = MotionPrior {
            tail: PriorTail::Normal,
            ..*found.prior
        };
        let stages = [config.max_correspondence_m, config.inlier_distance_m];
        let other = self.register(scan, rolling.pose, &stages, Some(&rolling), config);
        if !found.is_elsewhere(&other) {
            return;
        }
        let [on_walls, other_on_walls] = [&found.best, &other].map(|found_at| {
            let pose = &found_at.registered.pose;
            let fit = self.fit_on_walls(scan, pose, config);
            config.misfit_cost(scan, fit.score) + found.prior.cost(pose)
        });
        if other_on_walls + SURE < on_walls {
            found.best = other;
        }
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

    /// A scan of two walls 6 m apart, of beams 4° apart: the same at any place between them.
    fn grazed_corridor() -> PointCloud {
        let bearings = (-40..=40).map(|beam| (4.0 * f64::from(beam)).to_radians());
        let returns = bearings.map(|bearing| {
            let range_m = 3.0 / bearing.sin().abs();
            Point2::new(range_m * bearing.cos(), range_m * bearing.sin())
        });
        returns.filter(|at| at.x.abs() < 30.0).collect()
    }

    #[test]
    fn returns_that_meet_those_of_the_last_scan_do_not_hold_a_rolling_robot() {
        let scan = grazed_corridor();
        let profile = Arc::new(RangeProfile::new(&scan));
        let mut map = LocalMap::default();
        map.rebuild([(SE2::identity(), &scan, &profile)]);
        let config = LocalMapConfig::default().registration();
        let prior = MotionPrior {
            pose: SE2::new(1.0, 0.0, 0.0),
            sigma_m: 0.06,
            sigma_rad: 0.03,
            tail: PriorTail::Student,
        };
        let [at_rest, rolled] = [SE2::identity(), prior.pose]
            .map(|pose| map.register(&scan, pose, &[], Some(&prior), &config));
        // At rest every return lies on one of the last scan; a metre on, most fall between those.
        assert!(at_rest.cost < rolled.cost);
        let mut found = Candidates {
            scan: &scan,
            prior: &prior,
            config: &config,
            best: at_rest,
        };
        map.without_slip(&mut found);
        let off_m = (found.best.registered.pose.x() - 1.0).abs();
        // 0.06 m: a standard deviation of the odometry, which alone determines it.
        assert!(off_m < 0.06, "{:?}", found.best);
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
