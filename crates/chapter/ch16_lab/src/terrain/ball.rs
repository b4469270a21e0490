//! A ball that rolls down a landscape: a picture of gradient descent.

use pr_geom::{Vector2, math};

use super::{Objective, Slope, TerrainProbe};

/// The settings of a [`Ball`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallConfig {
    /// Longest step, m: short enough not to jump over a ridge.
    pub max_step_m: f64,
    /// The ball stops if no longer step than this leads downhill, m.
    pub min_step_m: f64,
    /// The ground counts as level below this slope: m for ICP's cost, 1/m for NDT's score.
    pub min_slope: f64,
    /// Largest number of steps.
    pub max_steps: usize,
}

impl Default for BallConfig {
    fn default() -> Self {
        Self {
            max_step_m: 0.04,
            min_step_m: 1e-4,
            min_slope: 1e-6,
            max_steps: 400,
        }
    }
}

/// Why a ball stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallStop {
    /// No step leads lower: a local minimum, not necessarily the global one.
    Settled {
        /// The shortest step that was tried, m.
        step_m: f64,
    },
    /// The ground is level, without a slope to follow.
    Level {
        /// Size of the gradient.
        slope: f64,
    },
    /// The limit of steps is reached.
    StepLimit {
        /// [`BallConfig::max_steps`].
        max_steps: usize,
    },
}

/// The ball after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallStep {
    /// The shift `(Δx, Δy)`, m.
    pub offset_m: Vector2<f64>,
    /// Cost in m², or score.
    pub value: f64,
    /// Why it stopped; `None` while it rolls.
    pub stop: Option<BallStop>,
}

/// Gradient descent on ICP's cost, or ascent on NDT's score, from a chosen shift.
///
/// A step `−α g` follows the gradient g. Its rate `α = sᵀs / sᵀy` comes from the last step s and the change y
/// of the gradient over it (Barzilai & Borwein 1988), which avoids zigzags in a narrow valley. A step that
/// would lead higher is halved, and steps are limited in length. The ball has no momentum: a minimum that it
/// cannot leave stops gradient descent, too.
#[derive(Clone, Debug)]
pub struct Ball {
    objective: Objective,
    config: BallConfig,
    offset_m: Vector2<f64>,
    /// Cached value and slope at the ball.
    here: Option<Slope>,
    /// α; infinite if the curvature is not positive, so the step limit applies.
    rate: f64,
    path: Vec<Vector2<f64>>,
    stop: Option<BallStop>,
}

impl Ball {
    /// A ball at the shift `start_m`.
    #[must_use]
    pub fn new(objective: Objective, start_m: Vector2<f64>, config: BallConfig) -> Self {
        Self {
            objective,
            config,
            offset_m: start_m,
            here: None,
            rate: f64::INFINITY,
            path: vec![start_m],
            stop: None,
        }
    }

    /// All shifts so far, from the start.
    #[must_use]
    pub fn path(&self) -> &[Vector2<f64>] {
        &self.path
    }

    /// The landscape of the ball.
    #[must_use]
    pub fn objective(&self) -> Objective {
        self.objective
    }

    /// Rolls one step, unless the ball has stopped.
    pub fn step(&mut self, probe: &TerrainProbe<'_>) -> BallStep {
        let mut here = match self.here {
            Some(slope) => slope,
            None => probe.slope(self.objective, self.offset_m),
        };
        if self.stop.is_none() {
            match self.roll(probe, &here) {
                Ok(slope) => here = slope,
                Err(stop) => self.stop = Some(stop),
            }
        }
        self.here = Some(here);
        BallStep {
            offset_m: self.offset_m,
            value: here.value,
            stop: self.stop,
        }
    }

    /// Rolls until the ball stops.
    pub fn run(&mut self, probe: &TerrainProbe<'_>) -> BallStep {
        loop {
            let step = self.step(probe);
            if step.stop.is_some() {
                return step;
            }
        }
    }

    /// Moves the ball to lower ground and returns the slope there.
    fn roll(&mut self, probe: &TerrainProbe<'_>, here: &Slope) -> Result<Slope, BallStop> {
        let BallConfig {
            max_step_m,
            min_step_m,
            min_slope,
            max_steps,
        } = self.config;
        if self.path.len() > max_steps {
            return Err(BallStop::StepLimit { max_steps });
        }
        let uphill = self.uphill(here);
        let slope = math::norm2(uphill.x, uphill.y);
        if slope < min_slope {
            return Err(BallStop::Level { slope });
        }
        let mut step_m = (self.rate * slope).min(max_step_m);
        loop {
            let step = -uphill * (step_m / slope);
            let there = probe.slope(self.objective, self.offset_m + step);
            let lower = match self.objective {
                Objective::IcpCost => there.value < here.value,
                Objective::NdtScore => there.value > here.value,
            };
            if lower {
                let bend = step.dot(&(self.uphill(&there) - uphill));
                self.rate = if bend > 0.0 {
                    step.norm_squared() / bend
                } else {
                    f64::INFINITY
                };
                self.offset_m += step;
                self.path.push(self.offset_m);
                return Ok(there);
            }
            if step_m < min_step_m {
                return Err(BallStop::Settled { step_m });
            }
            step_m *= 0.5;
        }
    }

    /// The gradient of the function that the ball descends.
    fn uphill(&self, slope: &Slope) -> Vector2<f64> {
        match self.objective {
            Objective::IcpCost => slope.gradient,
            Objective::NdtScore => -slope.gradient,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{SceneKind, TerrainScene, TerrainSettings};

    fn rest(objective: Objective, kind: SceneKind, tau_m: f64, start: (f64, f64)) -> BallStep {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let settings = TerrainSettings {
            tau_m,
            ..TerrainSettings::default()
        };
        let probe = TerrainProbe::new(&scene, &settings);
        let start_m = Vector2::new(start.0, start.1);
        let mut ball = Ball::new(objective, start_m, BallConfig::default());
        let mut last = probe.slope(objective, start_m).value;
        loop {
            let step = ball.step(&probe);
            let (before, now) = match objective {
                Objective::IcpCost => (last, step.value),
                Objective::NdtScore => (-last, -step.value),
            };
            assert!(now <= before, "the ball climbed from {before} to {now}");
            last = step.value;
            if step.stop.is_some() {
                assert_eq!(step.value, probe.slope(objective, step.offset_m).value);
                return step;
            }
        }
    }

    #[test]
    fn on_the_same_slope_icps_ball_sticks_and_ndts_reaches_the_truth() {
        let start = (0.3, -0.3);
        let icp = rest(Objective::IcpCost, SceneKind::Room, 0.15, start);
        let ndt = rest(Objective::NdtScore, SceneKind::Room, 0.15, start);
        assert!(icp.offset_m.norm() > 0.15, "{icp:?}");
        assert!(matches!(icp.stop, Some(BallStop::Level { .. })), "{icp:?}");
        assert!(ndt.offset_m.norm() < 0.02, "{ndt:?}");
    }

    #[test]
    fn a_ball_in_a_narrow_valley_does_not_zigzag() {
        // The valley along the corridor is as narrow as the wall is thick, 1.3 m long, and the longest step
        // is 0.04 m: at least 33 steps, and four times as many are still a straight path.
        let ball = rest(Objective::IcpCost, SceneKind::Corridor, 1.6, (1.2, 0.05));
        assert!(!matches!(ball.stop, Some(BallStop::StepLimit { .. })));
        let scene = TerrainScene::new(SceneKind::Corridor, 0.8);
        let probe = TerrainProbe::new(&scene, &TerrainSettings::default());
        let config = BallConfig {
            max_steps: 132,
            ..BallConfig::default()
        };
        let mut ball = Ball::new(Objective::NdtScore, Vector2::new(0.8, 0.02), config);
        let last = ball.run(&probe);
        assert!(
            last.offset_m.norm() < 0.12,
            "{last:?} after {}",
            ball.path().len()
        );
    }

    #[test]
    fn far_from_every_wall_the_ground_is_level() {
        let step = rest(Objective::NdtScore, SceneKind::Corridor, 0.6, (0.0, 0.6));
        assert!(
            matches!(step.stop, Some(BallStop::Level { .. })),
            "{step:?}"
        );
        assert_eq!(step.offset_m, Vector2::new(0.0, 0.6));
    }
}
