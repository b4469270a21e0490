//! Registration of a scan on a local map: one cost of point-to-plane distances and a prior.

use nalgebra::{Matrix3, Vector2, Vector3};
use pr_geom::{SE2, math};

use super::{LocalMap, MapFit, MapRegistrationConfig, MotionPrior};
use crate::cloud::{NearestMap, PointCloud, QueryCache};
use crate::loops::{LoopCandidate, LoopVerification, chi_squared_gate};
use crate::scan::MovingSweep;

/// A step below this, m and rad added, ends a stage.
const TOLERANCE: f64 = 1e-4;
/// Largest number of steps of a stage.
const STEPS: usize = 10;
/// Residual beyond which the weight of a pair decreases, m.
const HUBER_M: f64 = 0.05;
/// Smallest information of any direction, 1/m² and 1/rad²: makes the normal equations solvable.
const RIDGE: f64 = 1e-6;

/// A pose by least squares, and the information of its pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Registered {
    /// `map_from_scan`.
    pub pose: SE2,
    /// Information of the pairs alone, body frame, translation first: 1/m², 1/rad².
    pub information: Matrix3<f64>,
    /// Steps made.
    pub iterations: usize,
}

/// A registration with the score for comparisons.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapRegistration {
    /// The pose and its information.
    pub registered: Registered,
    /// The fit of the scan there.
    pub fit: MapFit,
    /// Negative logarithm of the posterior density, up to a constant: misfit and prior.
    pub cost: f64,
}

impl MapRegistration {
    /// This registration as a loop that started at the predicted pose, with the gate of `gate_information`; not rejected.
    pub(crate) fn verification(
        &self,
        from_node: usize,
        candidate: LoopCandidate,
        predicted: SE2,
        gate_information: Matrix3<f64>,
        gate_chi2: f64,
    ) -> LoopVerification {
        let registered = self.registered.pose;
        let innovation = predicted.between(&registered).log();
        LoopVerification {
            from_node,
            candidate,
            predicted,
            initial: predicted,
            registered,
            rmse_m: self.fit.rmse_m,
            inliers: self.fit.inliers,
            iterations: self.registered.iterations,
            score: Some(self.fit.score),
            margin: None,
            innovation,
            gate_information,
            gate: chi_squared_gate(&innovation, &gate_information, gate_chi2),
            information: self.information(),
            rejection: None,
            waits: None,
        }
    }

    /// Information of the pairs, reduced if only part of the scan fits, because that part may fit elsewhere as well:
    /// a score of .84 halves it, and one of .56 leaves a tenth. The fourth power is a rule of thumb; other powers were
    /// not measured.
    #[must_use]
    pub fn information(&self) -> Matrix3<f64> {
        let score = math::max(self.fit.score, 0.0);
        self.registered.information * (score * score * score * score)
    }
}

impl MapRegistrationConfig {
    /// Information of one pair of a scan, 1/m².
    fn pair_information(&self, scan: &PointCloud) -> f64 {
        let share = self.independent_points / scan.len().max(1) as f64;
        math::min(share, 1.0) / (self.point_sigma_m * self.point_sigma_m)
    }

    /// Cost of the misfit of a scan, as a negative log-likelihood.
    ///
    /// A miss is as unlikely as a distance of `inlier_distance_m` with a standard deviation of a third of that.
    #[must_use]
    pub fn misfit_cost(&self, scan: &PointCloud, score: f64) -> f64 {
        let points = math::min(self.independent_points, scan.len() as f64);
        4.5 * points * (1.0 - score)
    }
}

impl LocalMap {
    /// Registers a scan from `start` in stages with these correspondence distances, m, and scores the result.
    #[must_use]
    pub fn register(
        &mut self,
        scan: &PointCloud,
        start: SE2,
        reaches_m: &[f64],
        prior: Option<&MotionPrior>,
        config: &MapRegistrationConfig,
    ) -> MapRegistration {
        let mut registered = Registered {
            pose: start,
            information: Matrix3::zeros(),
            iterations: 0,
        };
        for &max_correspondence_m in reaches_m {
            let start = registered.pose;
            let stage = self.minimize(scan, None, start, max_correspondence_m, prior, config);
            registered = Registered {
                iterations: registered.iterations + stage.iterations,
                ..stage
            };
        }
        let fit = self.fit(scan, &registered.pose, config);
        let prior = prior.map_or(0.0, |prior| prior.cost(&registered.pose));
        MapRegistration {
            registered,
            fit,
            cost: config.misfit_cost(scan, fit.score) + prior,
        }
    }

    /// Registers the sweep of `scan` from `start` by its pose and its velocity together, and scores the result.
    ///
    /// If the velocity of the last scan deskewed this one, the error of one would be that of the next, times the
    /// sweep's share of the period: with sweeps that fill it, a robot at rest would seem to move. Solved together,
    /// an error decreases for every share.
    #[must_use]
    pub fn register_sweep(
        &mut self,
        scan: &PointCloud,
        sweep: &MovingSweep<'_>,
        start: SE2,
        prior: &MotionPrior,
        config: &MapRegistrationConfig,
    ) -> MapRegistration {
        let reach_m = config.max_correspondence_m;
        let far = self.minimize(scan, Some(sweep), start, reach_m, Some(prior), config);
        let reach_m = config.inlier_distance_m;
        let near = self.minimize(scan, Some(sweep), far.pose, reach_m, Some(prior), config);
        let fit = self.fit(&sweep.points(&near.pose), &near.pose, config);
        MapRegistration {
            registered: Registered {
                iterations: far.iterations + near.iterations,
                ..near
            },
            fit,
            cost: config.misfit_cost(scan, fit.score) + prior.cost(&near.pose),
        }
    }

    /// Gauss–Newton on the pairs within `max_correspondence_m` and the prior, reweighted at every step.
    ///
    /// A pair's row is `J = (Rᵀn, p × Rᵀn)` with the point p in the body's frame, for right perturbations. A point of
    /// a sweep t seconds after its first beam also moves with the velocity, which is the motion since the last scan
    /// over its duration T: its row is `J (1 + t/T)`. The information remains that of J, because a velocity that
    /// changes explains no point.
    fn minimize(
        &mut self,
        scan: &PointCloud,
        sweep: Option<&MovingSweep<'_>>,
        start: SE2,
        max_correspondence_m: f64,
        prior: Option<&MotionPrior>,
        config: &MapRegistrationConfig,
    ) -> Registered {
        let weight = config.pair_information(scan);
        let mut cache = vec![QueryCache::default(); scan.len()];
        let mut pose = start;
        let mut iterations = 0;
        loop {
            let rotation = pose.rotation();
            let (mut information, mut gradient) = (Matrix3::zeros(), Vector3::zeros());
            let mut of_velocity = Matrix3::zeros();
            let moved = sweep.map(|sweep| sweep.points(&pose));
            let scan = moved.as_ref().unwrap_or(scan);
            for (index, (point, cache)) in scan.iter().zip(&mut cache).enumerate() {
                let at = pose.transform(point);
                let Some(nearest) = self.points.neighbor_cached(at, max_correspondence_m, cache)
                else {
                    continue;
                };
                let Some(normal) = self.normal(nearest.index, config.normal_radius_m) else {
                    continue;
                };
                let target = self.points.point(nearest.index);
                let residual_m = normal.dot(&Vector2::new(at.x - target.x, at.y - target.y));
                let (nx, ny) = rotation.unrotate(normal.x, normal.y);
                let row = Vector3::new(nx, ny, point.x * ny - point.y * nx);
                let size_m = residual_m.abs();
                let robust = if size_m > HUBER_M {
                    HUBER_M / size_m
                } else {
                    1.0
                };
                let of_pair = row * row.transpose() * (robust * weight);
                information += of_pair;
                let gain = sweep.map_or(1.0, |sweep| sweep.gain(index));
                if sweep.is_some() {
                    of_velocity += of_pair * (gain * gain - 1.0);
                }
                gradient += row * (robust * weight * residual_m * gain);
            }
            let found = Registered {
                pose,
                information,
                iterations,
            };
            if iterations == STEPS {
                return found;
            }
            let mut hessian = information + of_velocity + Matrix3::identity() * RIDGE;
            if let Some(prior) = prior {
                let deviation = prior.deviation(&pose);
                let weights = prior.weights(&deviation);
                hessian += Matrix3::from_diagonal(&weights);
                gradient += weights.component_mul(&deviation);
            }
            let step = hessian.try_inverse().map(|inverse| -(inverse * gradient));
            let Some(step) = step.filter(|step| step.iter().all(|value| value.is_finite())) else {
                return found;
            };
            pose = pose.boxplus(&step);
            iterations += 1;
            if math::norm2(step.x, step.y) + step.z.abs() < TOLERANCE {
                return Registered {
                    pose,
                    iterations,
                    ..found
                };
            }
        }
    }
}
