//! Registration on an NDT map: damped Gauss–Newton on the negative score.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{Rotation, SE2, twist_size};

use super::NdtMap;
use crate::cloud::PointCloud;

/// Added to every diagonal entry, so that the system of a cloud far from every cell is solvable.
const RIDGE: f64 = 1e-9;
/// Smallest damping after successful steps.
const MIN_DAMPING: f64 = 1e-6;
/// Smaller terms are left out of gradient and Hessian.
const MIN_TERM: f64 = 1e-9;
/// A point is in a cell if it scores more there: within 3σ of the mean.
const IN_CELL: f64 = 0.011;
/// Share of the Hessian's mean diagonal up to which a direction is rounding.
const ROUNDING: f64 = 1e-10;

/// The settings of [`ndt_align`]; the defaults are the chapter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NdtConfig {
    /// Largest number of steps.
    pub max_iterations: usize,
    /// Gradient below which the run ends, `‖g_xy‖ + |g_θ|`.
    pub gradient_tolerance: f64,
    /// Initial damping λ: diagonal entries grow by the factor 1 + λ.
    pub initial_damping: f64,
    /// Dampings tried for one step, each six times the previous one.
    pub max_tries: usize,
    /// With fewer points in cells the run ends without a result; at least 1.
    pub min_points: usize,
}

impl Default for NdtConfig {
    fn default() -> Self {
        Self {
            max_iterations: 25,
            gradient_tolerance: 1e-6,
            initial_damping: 1e-4,
            max_tries: 10,
            min_points: 16,
        }
    }
}

/// Why an NDT registration ended, with the measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NdtStop {
    /// The gradient is below the tolerance: a maximum.
    SmallGradient {
        /// `‖g_xy‖ + |g_θ|`.
        gradient: f64,
        /// [`NdtConfig::gradient_tolerance`].
        tolerance: f64,
    },
    /// No damping led to a higher score: a maximum to the last digits, or a cell border.
    NoBetterStep {
        /// The damping tried last.
        damping: f64,
    },
    /// The limit of steps was reached.
    IterationLimit {
        /// [`NdtConfig::max_iterations`].
        max_iterations: usize,
    },
    /// Too few points lie in cells: the score there is flat, or that of a few points.
    TooFewPoints {
        /// Points within 3σ of a cell's mean at the last pose.
        points: usize,
        /// [`NdtConfig::min_points`].
        min_points: usize,
    },
    /// A maximum, but the score does not change in a direction, as for points that coincide.
    Unobservable,
}

impl NdtStop {
    /// Whether the pose is a maximum that the points in cells measure in every direction. [`Self::NoBetterStep`] may be
    /// one, or the border of a cell. That it is the right maximum, and not a false one nearby, no stop can claim: compare
    /// the score with that of the map's own points.
    #[must_use]
    pub fn converged(&self) -> bool {
        matches!(self, Self::SmallGradient { .. })
    }

    /// Whether the pose is a result of the points in any direction; otherwise it is no better than the guess.
    #[must_use]
    pub fn is_supported(&self) -> bool {
        !matches!(self, Self::TooFewPoints { .. })
    }
}

impl core::fmt::Display for NdtStop {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SmallGradient {
                gradient,
                tolerance,
            } => write!(f, "gradient {gradient:.2e} below {tolerance:.2e}"),
            Self::NoBetterStep { damping } => {
                write!(f, "no better step up to a damping of {damping:.2e}")
            }
            Self::IterationLimit { max_iterations } => {
                write!(f, "limit of {max_iterations} iterations")
            }
            Self::TooFewPoints { points, min_points } => write!(
                f,
                "{points} points in cells, at least {min_points} are needed"
            ),
            Self::Unobservable => write!(f, "the score does not change in a direction"),
        }
    }
}

/// The state after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NdtStep {
    /// `map_from_cloud`.
    pub pose: SE2,
    /// Sum of the points' scores.
    pub score: f64,
    /// Set once the registration has ended.
    pub stop: Option<NdtStop>,
}

/// The outcome of an NDT registration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NdtResult {
    /// `map_from_cloud`.
    pub pose: SE2,
    /// Sum of the points' scores.
    pub score: f64,
    /// Iterations started; the last one may have found no better step.
    pub iterations: usize,
    /// The poses from the initial guess on.
    pub trace: Vec<SE2>,
    /// Why the registration ended.
    pub stop: NdtStop,
}

/// Registers `cloud` on `map` from the guess `init = map_from_cloud`.
///
/// With `d = R p + t − μ` and `J = [I, R' p]`, the gradient of the negative score is
/// `Σ e Jᵀ Σ⁻¹ d` and its Gauss–Newton Hessian `Σ e Jᵀ Σ⁻¹ J`, `e = exp(−½ dᵀ Σ⁻¹ d)`. The step is
/// added to `(t_x, t_y, θ)`.
#[must_use]
pub fn ndt_align(cloud: &PointCloud, map: &NdtMap, init: SE2, config: &NdtConfig) -> NdtResult {
    let mut registration = NdtAlign::new(cloud, map, init, config);
    let mut trace = vec![init];
    loop {
        let step = registration.step();
        if trace.last() != Some(&step.pose) {
            trace.push(step.pose);
        }
        if let Some(stop) = step.stop {
            return NdtResult {
                pose: step.pose,
                score: step.score,
                iterations: registration.iterations,
                trace,
                stop,
            };
        }
    }
}

/// A running NDT registration.
#[derive(Clone, Debug)]
pub struct NdtAlign<'a> {
    cloud: &'a PointCloud,
    map: &'a NdtMap,
    config: NdtConfig,
    pose: SE2,
    score: f64,
    /// Derivatives at the pose, if they were computed together with the score.
    slope: Option<Slope>,
    damping: f64,
    iterations: usize,
    stop: Option<NdtStop>,
}

/// Gradient and Gauss–Newton Hessian of the negative score over `(t_x, t_y, θ)`.
#[derive(Clone, Copy, Debug)]
struct Slope {
    gradient: Vector3<f64>,
    hessian: Matrix3<f64>,
    /// Points in cells.
    points: usize,
}

impl<'a> NdtAlign<'a> {
    /// Scores the guess `init = map_from_cloud`; no step is made yet.
    #[must_use]
    pub fn new(cloud: &'a PointCloud, map: &'a NdtMap, init: SE2, config: &NdtConfig) -> Self {
        let (score, slope) = score_with_slope(cloud, map, &init);
        Self {
            cloud,
            map,
            config: *config,
            pose: init,
            score,
            slope: Some(slope),
            damping: config.initial_damping,
            iterations: 0,
            stop: None,
        }
    }

    /// Iterations started so far.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Takes one step, unless the registration has ended.
    pub fn step(&mut self) -> NdtStep {
        if self.stop.is_none() {
            self.stop = self.advance();
        }
        NdtStep {
            pose: self.pose,
            score: self.score,
            stop: self.stop,
        }
    }

    fn advance(&mut self) -> Option<NdtStop> {
        let NdtConfig {
            max_iterations,
            gradient_tolerance: tolerance,
            max_tries,
            ..
        } = self.config;
        if max_iterations == 0 {
            return Some(NdtStop::IterationLimit { max_iterations });
        }
        self.iterations += 1;
        let at_pose = self.slope.take();
        let Slope {
            gradient,
            hessian,
            points,
        } = at_pose.unwrap_or_else(|| score_with_slope(self.cloud, self.map, &self.pose).1);
        let size = twist_size(&gradient);
        if size < tolerance {
            let gradient = size;
            let level = NdtStop::SmallGradient {
                gradient,
                tolerance,
            };
            return Some(self.supported(points, &hessian, level));
        }
        for tried in 0..max_tries {
            let mut damped = hessian;
            for k in 0..3 {
                damped[(k, k)] = hessian[(k, k)] * (1.0 + self.damping) + RIDGE;
            }
            if let Some(factor) = damped.cholesky() {
                let step = factor.solve(&-gradient);
                let pose = SE2::new(
                    self.pose.x() + step.x,
                    self.pose.y() + step.y,
                    self.pose.theta() + step.z,
                );
                // The first try is nearly always accepted, and the next step starts with its derivatives.
                let (score, slope) = if tried == 0 {
                    let (score, slope) = score_with_slope(self.cloud, self.map, &pose);
                    (score, Some(slope))
                } else {
                    (self.map.score(self.cloud, &pose), None)
                };
                if score > self.score {
                    self.pose = pose;
                    self.score = score;
                    self.slope = slope;
                    self.damping = (0.5 * self.damping).max(MIN_DAMPING);
                    return (self.iterations >= max_iterations)
                        .then_some(NdtStop::IterationLimit { max_iterations });
                }
            }
            self.damping *= 6.0;
        }
        let damping = self.damping;
        Some(self.supported(points, &hessian, NdtStop::NoBetterStep { damping }))
    }

    /// `stop`, if the points in cells measure every direction.
    fn supported(&self, points: usize, hessian: &Matrix3<f64>, stop: NdtStop) -> NdtStop {
        let min_points = self.config.min_points.max(1);
        let floor = RIDGE + ROUNDING * hessian.trace();
        if points < min_points {
            NdtStop::TooFewPoints { points, min_points }
        } else if (hessian - Matrix3::identity() * floor).cholesky().is_none() {
            NdtStop::Unobservable
        } else {
            stop
        }
    }
}

/// The score of [`NdtMap::score`] and its derivatives, in one pass over the cloud.
fn score_with_slope(cloud: &PointCloud, map: &NdtMap, pose: &SE2) -> (f64, Slope) {
    let Rotation { cos, sin } = pose.rotation();
    let (mut score, mut points) = (0.0, 0);
    let (mut gx, mut gy, mut gw) = (0.0, 0.0, 0.0);
    let (mut xx, mut xy, mut yy, mut xw, mut yw, mut ww) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (&px, &py) in cloud.xs().iter().zip(cloud.ys()) {
        let (rx, ry) = (cos * px - sin * py, sin * px + cos * py);
        let (x, y) = (rx + pose.x(), ry + pose.y());
        let mut is_in_cell = false;
        for (gaussian, e) in map.scores_around(x, y) {
            score += e;
            is_in_cell |= e > IN_CELL;
            if e < MIN_TERM {
                continue;
            }
            let (dx, dy) = (x - gaussian.mean.x, y - gaussian.mean.y);
            let m = &gaussian.information;
            let (qx, qy) = (m.m11 * dx + m.m12 * dy, m.m12 * dx + m.m22 * dy);
            // The derivative of R p by θ is R p rotated by a quarter turn: (−ry, rx).
            let (ux, uy) = (m.m12 * rx - m.m11 * ry, m.m22 * rx - m.m12 * ry);
            gx += e * qx;
            gy += e * qy;
            gw += e * (qy * rx - qx * ry);
            xx += e * m.m11;
            xy += e * m.m12;
            yy += e * m.m22;
            xw += e * ux;
            yw += e * uy;
            ww += e * (uy * rx - ux * ry);
        }
        points += usize::from(is_in_cell);
    }
    let slope = Slope {
        gradient: Vector3::new(gx, gy, gw),
        hessian: Matrix3::new(xx, xy, xw, xy, yy, yw, xw, yw, ww),
        points,
    };
    (score, slope)
}

#[cfg(test)]
mod tests;
