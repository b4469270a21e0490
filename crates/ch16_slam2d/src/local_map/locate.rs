//! Pose of a scan by one cost: from the prediction, and from other starts if the scan fits poorly there.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};

use super::tuning::BASIN;
use super::{LocalMap, MapRegistration, MapRegistrationConfig, MotionPrior};
use crate::cloud::PointCloud;
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

/// A larger prior cost means a deviation of more than three standard deviations.
const MAX_PRIOR_COST: f64 = 6.0;
/// Share of inliers that justifies such a deviation: a few points in unseen space fit any wall.
const MAJORITY: f64 = 0.5;
/// Share of points in observed free space above which a pose contradicts the map.
const MAX_CONTRADICTING: f64 = 0.05;

/// Registrations of a scan from different starts.
struct Candidates<'a> {
    scan: &'a PointCloud,
    prior: &'a MotionPrior,
    best: MapRegistration,
    /// Pose and cost of each.
    tried: Vec<(SE2, f64)>,
}

impl<'a> Candidates<'a> {
    fn new(scan: &'a PointCloud, prior: &'a MotionPrior, first: MapRegistration) -> Self {
        Self {
            scan,
            prior,
            best: first,
            tried: vec![(first.registered.pose, first.cost)],
        }
    }

    /// Adds a registration unless its deviation from the prediction is not justified; it is the best if it is cheaper.
    fn add(&mut self, other: MapRegistration) {
        let is_justified = other.fit.inliers as f64 >= MAJORITY * self.scan.len() as f64
            || self.prior.cost(&other.registered.pose) <= MAX_PRIOR_COST;
        if !is_justified {
            return;
        }
        self.tried.push((other.registered.pose, other.cost));
        if other.cost < self.best.cost {
            self.best = other;
        }
    }

    /// The best one, with the scatter of the others about it: `Σ wᵢ dᵢdᵢᵀ` over one pose of each basin, with
    /// the weights of their posterior densities.
    fn into_best(mut self) -> MapRegistration {
        let here = self.best.registered.pose;
        self.tried.sort_by(|one, other| one.1.total_cmp(&other.1));
        let mut basins = vec![here];
        let (mut total, mut scatter) = (1.0, Matrix3::zeros());
        for (pose, cost) in self.tried {
            if basins
                .iter()
                .any(|other| other.between(&pose).step_size() < BASIN)
            {
                continue;
            }
            basins.push(pose);
            let weight = math::exp(math::min(self.best.cost - cost, 0.0));
            let off = here.between(&pose).log();
            total += weight;
            scatter += off * off.transpose() * weight;
        }
        MapRegistration {
            spread: scatter / total,
            ..self.best
        }
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
        // With few pairs the registration is pulled farther than its information justifies.
        let mut found = if prior.cost(&first.registered.pose) > MAX_PRIOR_COST {
            let predicted = self.register(scan, prior.pose, &[], Some(prior), config);
            let mut found = Candidates::new(scan, prior, predicted);
            found.add(first);
            found
        } else {
            Candidates::new(scan, prior, first)
        };
        // A registration from a distant start may slide along a wall although the scan fits better at the prediction.
        if self.fit(scan, &prior.pose, config).score > found.best.fit.score {
            found.add(self.register(scan, prior.pose, near, Some(prior), config));
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
        let is_poor = |found: &Candidates<'_>| found.best.fit.score < config.good_score;
        for start in others {
            if is_poor(&found) {
                found.add(self.register(scan, *start, &stages, Some(prior), config));
            }
        }
        // A scan of unseen space fits anywhere: only one that contradicts the map was taken elsewhere.
        let is_contradicted =
            found.best.fit.contradicting as f64 >= MAX_CONTRADICTING * scan.len() as f64;
        if is_poor(&found) && is_contradicted {
            let window = SearchWindow::around(prior.pose, config.search_m, config.search_rad);
            if let Some(searched) = self.search(scan, &window, 0.0) {
                let start = searched.best.pose;
                found.add(self.register(scan, start, near, Some(prior), config));
            }
        }
        found.into_best()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use pr_geom::Point2;

    use super::*;
    use crate::local_map::{PriorTail, RangeProfile};
    use crate::slam::RobotConfig;

    fn wall(points: i32, at: impl Fn(f64) -> Point2<f64>) -> PointCloud {
        (0..points).map(|k| at(0.05 * f64::from(k))).collect()
    }

    fn prior(pose: SE2) -> MotionPrior {
        MotionPrior {
            pose,
            sigma_m: 0.04,
            sigma_rad: 0.02,
            tail: PriorTail::Student,
            slip: None,
        }
    }

    #[test]
    fn a_pose_with_an_equal_rival_has_their_scatter_and_a_clear_one_has_none() {
        let scan = wall(40, |x| Point2::new(x, 0.0));
        let prior = prior(SE2::identity());
        let at = |x: f64, cost: f64| {
            let mut map = LocalMap::default();
            let profile = Arc::new(RangeProfile::new(&scan));
            map.rebuild([(SE2::identity(), &scan, &profile)]);
            let config = RobotConfig::default().registration();
            let there = map.register(&scan, SE2::translation(x, 0.0), &[], None, &config);
            MapRegistration { cost, ..there }
        };
        let spread = |rivals: &[MapRegistration]| {
            let mut found = Candidates::new(&scan, &prior, at(0.0, 5.0));
            rivals.iter().for_each(|rival| found.add(*rival));
            found.into_best().spread
        };
        // Half a metre away with probability ½; a second start in its basin adds nothing, nor does the pose itself.
        let rivals = [at(0.5, 5.0), at(0.52, 5.5), at(0.01, 5.1)];
        assert!((spread(&rivals)[(0, 0)] - 0.5 * 0.25).abs() < 1e-12);
        // e⁻¹⁰ of a quarter square metre.
        let unlikely = spread(&[at(0.5, 15.0)])[(0, 0)];
        assert!((1e-6..2e-5).contains(&unlikely), "{unlikely}");
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
        let prior = prior(pose);
        let config = RobotConfig::default().registration();
        let others = [pose * SE2::new(-0.5, 0.0, 0.0)];
        let found = map.locate(&seen, &prior, &others, &config);
        assert!(pose.between(&found.registered.pose).step_size() < 0.05);
        // The wall would fit on the corridor's at a quarter turn.
        let laid = SE2::new(5.0, 3.0, -core::f64::consts::FRAC_PI_2);
        assert!(map.fit(&seen, &laid, &config).score > found.fit.score + 0.2);
    }
}
