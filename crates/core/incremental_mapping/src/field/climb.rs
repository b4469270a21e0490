//! Hill climbing of a scan on a field.

use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};
use pr_geom::{SE2, math, twist_size, wrap_angle};

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::scan::is_finite;

/// Damping of the first step, as a share of the curvature.
const FIRST_DAMPING: f64 = 1e-3;
/// Factor on the damping after a step that led downhill.
const DAMPING_GROWTH: f64 = 10.0;
/// Factor on the damping after a step that led uphill.
const DAMPING_DECAY: f64 = 0.2;
/// Largest damping; if it is exceeded, the climb ends.
const MAX_DAMPING: f64 = 1e8;
/// Smallest curvature in any direction: in flat regions the step is long and gets damped.
const MIN_CURVATURE: f64 = 1e-6;

/// Score of one point on a field, with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointScore {
    /// Its score: larger is better.
    pub score: f64,
    /// Gradient of the score by the point's x and y, 1/m.
    pub slope: Vector2<f64>,
    /// Negative curvature of the score, 2×2, positive semidefinite, 1/m²; may be approximate.
    pub bend: Matrix2<f64>,
}

/// A field with a score for every point.
pub trait PointScores {
    /// The score at a point, m, in the field's frame.
    fn at(&self, point: Point2<f64>) -> PointScore;
}

/// Prior of the pose.
///
/// It adds `−½ eᵀ Ω e` to the sum over the points, with `e = (R̂ᵀ(t − t̂), θ − θ̂)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosePrior {
    /// The mean (t̂, θ̂), `field_from_scan`.
    pub pose: SE2,
    /// Ω, 3×3, translation first.
    pub information: Matrix3<f64>,
}

/// Stop rules of a climb, and the weight of points relative to the prior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimbConfig {
    /// Factor on every point's score, because points of one scan are correlated.
    pub weight: f64,
    /// Largest number of steps.
    pub max_steps: usize,
    /// A step shorter than this (m + rad) ends the climb.
    pub tolerance: f64,
}

/// Why a climb ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClimbStop {
    /// The last step was shorter than the tolerance.
    SmallStep {
        /// Its length, m + rad.
        step: f64,
    },
    /// No step raises the objective.
    Summit,
    /// The limit of steps was reached.
    MaxSteps,
    /// The objective is not finite at the pose.
    NotFinite,
}

impl core::fmt::Display for ClimbStop {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SmallStep { step } => write!(f, "step {step:.2e} below the tolerance"),
            Self::Summit => write!(f, "no step raises the objective"),
            Self::MaxSteps => write!(f, "limit of steps"),
            Self::NotFinite => write!(f, "the objective is not finite"),
        }
    }
}

/// Result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimbStep {
    /// The pose after it, `field_from_scan`.
    pub pose: SE2,
    /// The objective there.
    pub objective: f64,
    /// Whether it raised the objective; if not, the pose is unchanged.
    pub is_uphill: bool,
}

/// Result of a climb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Climb {
    /// The pose at its end, `field_from_scan`.
    pub pose: SE2,
    /// The objective there: weighted scores and prior.
    pub objective: f64,
    /// Negative curvature of the objective at the pose, 3×3, translation first, in the tangent space of the pose:
    /// the information of the registration.
    pub bend: Matrix3<f64>,
    /// Number of tried steps.
    pub steps: usize,
    /// Why it ended.
    pub stop: ClimbStop,
}

/// The objective at a pose with its derivatives by δ in `T exp(δ)` at δ = 0.
#[derive(Clone, Copy, Debug)]
struct Derivatives {
    value: f64,
    slope: Vector3<f64>,
    bend: Matrix3<f64>,
}

/// Hill climbing of `F(T) = w Σ_k s(T p_k) − ½ eᵀ Ω e` over the pose T of a scan.
///
/// The direction is the gradient, `Σ Jᵀ ∇s` with `J = R (I | −p_y, p_x)ᵀ`, scaled by the inverse
/// curvature; a step that leads downhill is reverted and shortened (Levenberg 1944). It finds the local maximum
/// in whose basin it starts.
pub struct ScanClimb<'a, F: PointScores> {
    field: &'a F,
    scan: &'a PointCloud,
    prior: Option<PosePrior>,
    config: ClimbConfig,
    pose: SE2,
    here: Derivatives,
    damping: f64,
    steps: usize,
    stop: Option<ClimbStop>,
}

impl<'a, F: PointScores> ScanClimb<'a, F> {
    /// A climb from `start`, `field_from_scan`.
    #[must_use]
    pub fn new(
        field: &'a F,
        scan: &'a PointCloud,
        start: SE2,
        prior: Option<PosePrior>,
        config: ClimbConfig,
    ) -> Self {
        let mut climb = Self {
            field,
            scan,
            prior,
            config,
            pose: start,
            here: Derivatives {
                value: 0.0,
                slope: Vector3::zeros(),
                bend: Matrix3::zeros(),
            },
            damping: FIRST_DAMPING,
            steps: 0,
            stop: None,
        };
        climb.here = climb.derivatives(&start);
        if !climb.here.value.is_finite() {
            climb.stop = Some(ClimbStop::NotFinite);
        }
        climb
    }

    /// Tries one step; `None` once the climb has ended.
    pub fn step(&mut self) -> Option<ClimbStep> {
        if self.stop.is_none() && self.steps >= self.config.max_steps {
            self.stop = Some(ClimbStop::MaxSteps);
        }
        if self.stop.is_some() {
            return None;
        }
        self.steps += 1;
        let is_uphill = self.try_step();
        Some(ClimbStep {
            pose: self.pose,
            objective: self.here.value,
            is_uphill,
        })
    }

    /// Climbs to the end.
    #[must_use]
    pub fn run(mut self) -> Climb {
        while self.step().is_some() {}
        Climb {
            pose: self.pose,
            objective: self.here.value,
            bend: self.here.bend,
            steps: self.steps,
            stop: self.stop.unwrap_or(ClimbStop::MaxSteps),
        }
    }

    /// The objective at a pose and its gradient by δ in `T exp(δ)`, translation first.
    #[must_use]
    pub fn objective(&self, pose: &SE2) -> (f64, Vector3<f64>) {
        let ascent = self.derivatives(pose);
        (ascent.value, ascent.slope)
    }

    fn try_step(&mut self) -> bool {
        let mut damped = self.here.bend;
        for k in 0..3 {
            damped[(k, k)] =
                damped[(k, k)] * (1.0 + self.damping) + MIN_CURVATURE * (1.0 + self.damping);
        }
        let Some(inverse) = damped.try_inverse() else {
            self.stop = Some(ClimbStop::Summit);
            return false;
        };
        let delta = inverse * self.here.slope;
        let pose = self.pose.boxplus(&delta);
        let there = self.derivatives(&pose);
        let is_uphill = there.value > self.here.value && is_finite(&pose);
        if is_uphill {
            let length = twist_size(&delta);
            (self.pose, self.here) = (pose, there);
            self.damping = math::max(self.damping * DAMPING_DECAY, 1e-9);
            if length < self.config.tolerance {
                self.stop = Some(ClimbStop::SmallStep { step: length });
            }
        } else {
            self.damping *= DAMPING_GROWTH;
            let length = twist_size(&delta);
            if self.damping > MAX_DAMPING || length < self.config.tolerance {
                self.stop = Some(ClimbStop::Summit);
            }
        }
        is_uphill
    }

    fn derivatives(&self, pose: &SE2) -> Derivatives {
        let rotation = pose.rotation();
        let (mut value, mut slope, mut bend) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for point in self.scan.iter() {
            let score = self.field.at(pose.transform(point));
            value += score.score;
            if score.slope == Vector2::zeros() {
                continue;
            }
            // Slope and curvature in the body's frame.
            let (sx, sy) = rotation.unrotate(score.slope.x, score.slope.y);
            slope += Vector3::new(sx, sy, point.x * sy - point.y * sx);
            let turn = rotation_matrix(rotation.cos, rotation.sin);
            let b = turn.transpose() * score.bend * turn;
            let lever = b * Vector2::new(-point.y, point.x);
            let around = lever.y * point.x - lever.x * point.y;
            bend += Matrix3::new(
                b.m11, b.m12, lever.x, //
                b.m21, b.m22, lever.y, //
                lever.x, lever.y, around,
            );
        }
        let weight = self.config.weight;
        let (mut value, mut slope, mut bend) = (weight * value, slope * weight, bend * weight);
        if let Some(prior) = &self.prior {
            let (x, y) = (pose.x() - prior.pose.x(), pose.y() - prior.pose.y());
            let (x, y) = prior.pose.rotation().unrotate(x, y);
            let gap = Vector3::new(x, y, wrap_angle(pose.theta() - prior.pose.theta()));
            // de/dδ: the translation is rotated from one body frame to the other.
            let (sin, cos) = math::sin_cos(gap.z);
            let jacobian = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
            let pull = prior.information * gap;
            value -= 0.5 * gap.dot(&pull);
            slope -= jacobian.transpose() * pull;
            bend += jacobian.transpose() * prior.information * jacobian;
        }
        Derivatives { value, slope, bend }
    }
}

fn rotation_matrix(cos: f64, sin: f64) -> Matrix2<f64> {
    Matrix2::new(cos, -sin, sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A round hill of height 1 at (1, 2).
    struct Hill;

    impl PointScores for Hill {
        fn at(&self, point: Point2<f64>) -> PointScore {
            let (x, y) = (point.x - 1.0, point.y - 2.0);
            PointScore {
                score: 1.0 - 0.5 * (x * x + 3.0 * y * y),
                slope: Vector2::new(-x, -3.0 * y),
                bend: Matrix2::new(1.0, 0.0, 0.0, 3.0),
            }
        }
    }

    const CONFIG: ClimbConfig = ClimbConfig {
        weight: 0.7,
        max_steps: 50,
        tolerance: 1e-9,
    };

    fn scan() -> PointCloud {
        let points = [(0.4, 0.1), (-0.2, 0.9), (0.3, -1.1)];
        points.map(|(x, y)| Point2::new(x, y)).into_iter().collect()
    }

    fn prior() -> PosePrior {
        PosePrior {
            pose: SE2::new(0.4, 1.0, 2.9),
            information: Matrix3::new(4.0, 1.0, 0.2, 1.0, 3.0, 0.0, 0.2, 0.0, 2.0),
        }
    }

    #[test]
    fn the_gradient_agrees_with_finite_differences_with_and_without_a_prior() {
        let scan = scan();
        for prior in [None, Some(prior())] {
            let climb = ScanClimb::new(&Hill, &scan, SE2::identity(), prior, CONFIG);
            for pose in [SE2::new(0.3, 1.7, -2.8), SE2::new(-1.0, 0.2, 0.6)] {
                let (_, slope) = climb.objective(&pose);
                for k in 0..3 {
                    let step = 1e-6;
                    let moved = |sign: f64| {
                        let mut delta = Vector3::zeros();
                        delta[k] = sign * step;
                        climb.objective(&pose.boxplus(&delta)).0
                    };
                    let difference = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                    // 1e-7: 1e-12 of the third derivative, and rounding of 1e-15 · 20 / 1e-6.
                    assert!((difference - slope[k]).abs() < 1e-7, "{k} {difference}");
                }
            }
        }
    }

    #[test]
    fn a_climb_ends_at_zero_gradient_and_every_step_raises_the_objective() {
        let scan = scan();
        let start = SE2::new(-2.0, 3.0, 1.0);
        let mut climb = ScanClimb::new(&Hill, &scan, start, Some(prior()), CONFIG);
        let mut last = climb.objective(&start).0;
        while let Some(step) = climb.step() {
            assert!(step.objective > last || !step.is_uphill);
            last = step.objective;
        }
        let found = climb.run();
        let again = ScanClimb::new(&Hill, &scan, found.pose, Some(prior()), CONFIG);
        assert!(again.objective(&found.pose).1.norm() < 1e-6);
        assert!(found.objective > again.objective(&start).0);
    }
}
