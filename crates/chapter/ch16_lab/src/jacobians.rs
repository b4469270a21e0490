//! One pose graph, solved in four ways: the effect of a wrong Jacobian and of a wrong residual.
//!
//! Gauss–Newton converges where `Σ JᵀΩe = 0`. A Jacobian that is wrong by a factor does not move this point,
//! only the steps to it. One that is right up to `O(e)` moves it by `O(e²)`, the square of the contradiction
//! among the measurements. A residual that is wrong to first order moves it by `O(e)`, however exact its own
//! Jacobian is. Without contradiction `e = 0` at the end, and none of this shows.
//!
//! The graph is a ring of eight poses. Odometry turns too little at every edge, and a correct loop ties the
//! last pose to the first.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use pr_optim::{
    Between, CustomGaussNewton, JacobianModel, Jacobians, Method, OptimizeError, Optimizer,
    Problem, Settings, StepReport,
};
use pr_sim::Rng;

/// Poses of the ring.
pub const RING_POSES: usize = 8;
/// Length of an edge, m.
pub const RING_SIDE_M: f64 = 1.0;
/// Standard deviation of an edge: along each axis in m, and of its heading in degrees.
pub const EDGE_STD: (f64, f64) = (0.05, 2.0);
/// The optimization ends at a step below this, m and rad added.
pub const REST: f64 = 1e-9;

/// The contradiction in a ring, and the start of its optimization.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingConfig {
    /// By how much each edge of odometry turns too little, rad.
    pub turn_bias_rad: f64,
    /// Standard deviation of the noise added to the poses before the first step, m and rad.
    pub scatter: f64,
    /// Seed of that noise.
    pub seed: u32,
}

impl Default for RingConfig {
    fn default() -> Self {
        Self {
            turn_bias_rad: 6.0_f64.to_radians(),
            scatter: 0.2,
            seed: 1,
        }
    }
}

/// A Jacobian that is wrong on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrongJacobian {
    /// `2 J`: each step goes half as far.
    TwiceTooLong,
    /// `Jl⁻¹(e)` in place of `Jr⁻¹(e)`: the perturbation on the wrong side, right at `e = 0`.
    LeftForRight,
}

/// The residual and Jacobians with which the graph is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recipe {
    /// `log(Z⁻¹ Tᵢ⁻¹ Tⱼ)` with its exact Jacobians.
    Exact,
    /// The same residual with the chapter's Jacobians, `−Ad(Z⁻¹)` and `I`.
    Approximate,
    /// The same residual with wrong Jacobians.
    WrongJacobian(WrongJacobian),
    /// `log(Tᵢ⁻¹ Tⱼ Z⁻¹) = Ad(Z) e` with its own exact Jacobians: the measurement is inverted on the wrong
    /// side, and Ω weights the residual in the wrong frame.
    WrongResidual,
}

/// The graph after some number of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Iterate {
    /// The poses.
    pub poses: Vec<SE2>,
    /// χ² = Σ eᵀΩe of the right residual.
    pub chi2: f64,
    /// Largest distance of a pose from its optimum, m.
    pub off_m: f64,
}

/// The optimization from its start to convergence.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// The start, and the graph after each step.
    pub iterates: Vec<Iterate>,
    /// Whether it converged within the given number of steps.
    pub rests: bool,
}

impl Descent {
    /// Steps to the end.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.iterates.len() - 1
    }

    /// The graph at the end.
    #[must_use]
    pub fn end(&self) -> &Iterate {
        &self.iterates[self.steps()]
    }
}

/// The ring with the poses at which the optimization starts.
#[must_use]
pub fn ring(config: &RingConfig) -> Problem {
    let turn = core::f64::consts::TAU / RING_POSES as f64;
    let true_step = SE2::new(RING_SIDE_M, 0.0, turn);
    let measured = SE2::new(RING_SIDE_M, 0.0, turn - config.turn_bias_rad);
    let (along_m, turn_deg) = EDGE_STD;
    let weight = |deviation: f64| 1.0 / (deviation * deviation);
    let information = Matrix3::from_diagonal(&nalgebra::Vector3::new(
        weight(along_m),
        weight(along_m),
        weight(turn_deg.to_radians()),
    ));
    let mut rng = Rng::new(config.seed);
    let mut problem = Problem::new();
    let mut driven = SE2::identity();
    problem.add_fixed_pose(driven);
    let mut last_from_first = SE2::identity();
    for from in 0..RING_POSES - 1 {
        driven = driven * measured;
        last_from_first = last_from_first * true_step;
        let [x, y, theta] = [0; 3].map(|_| config.scatter * rng.normal(0.0, 1.0));
        problem.add_pose(SE2::new(
            driven.x() + x,
            driven.y() + y,
            driven.theta() + theta,
        ));
        problem.add_factor(Between {
            from,
            to: from + 1,
            measurement: measured,
            information,
        });
    }
    problem.add_factor(Between {
        from: 0,
        to: RING_POSES - 1,
        measurement: last_from_first,
        information,
    });
    problem
}

/// Finds the minimum of χ² below the present poses, to the last digits: the poses there, and χ².
///
/// It never raises χ², and stops if no step can be computed.
#[must_use]
pub fn optimum(problem: &Problem) -> (Vec<SE2>, f64) {
    let mut problem = problem.clone();
    let mut optimizer = Optimizer::new(Settings {
        method: Method::LevenbergMarquardt {
            initial_damping: 1e-3,
        },
        jacobians: JacobianModel::Exact,
        max_iterations: 100,
        step_tolerance: 1e-3 * REST,
        ..Settings::default()
    });
    let report = optimizer.run(&mut problem);
    (problem.poses().to_vec(), report.chi2)
}

/// Solves the graph by a recipe, in at most the given number of steps.
#[must_use]
pub fn descend(start: &Problem, recipe: Recipe, optimum: &[SE2], max_steps: usize) -> Descent {
    let mut problem = start.clone();
    let mut solver = Solver::new(recipe);
    let mut iterates = vec![iterate(&problem, optimum)];
    let mut rests = false;
    while !rests && iterates.len() <= max_steps {
        let Ok(step) = solver.step(&mut problem) else {
            break;
        };
        let next = iterate(&problem, optimum);
        if !(next.chi2.is_finite() && next.off_m.is_finite()) {
            break;
        }
        iterates.push(next);
        rests = step.largest_step < REST;
    }
    Descent { iterates, rests }
}

fn iterate(problem: &Problem, optimum: &[SE2]) -> Iterate {
    let off = |(pose, best): (&SE2, &SE2)| math::norm2(pose.x() - best.x(), pose.y() - best.y());
    let offs = problem.poses().iter().zip(optimum).map(off);
    Iterate {
        poses: problem.poses().to_vec(),
        chi2: problem.chi2(),
        off_m: offs.fold(0.0, math::max),
    }
}

/// The library's own solver if it supports the recipe, else its steps with other derivatives.
enum Solver {
    Own(Box<Optimizer>),
    Changed(Box<CustomGaussNewton>, fn(&Between, Jacobians) -> Jacobians),
}

impl Solver {
    fn new(recipe: Recipe) -> Self {
        let own = |jacobians| {
            let settings = Settings {
                jacobians,
                ..Settings::default()
            };
            Self::Own(Box::new(Optimizer::new(settings)))
        };
        let changed = |change| Self::Changed(Box::default(), change);
        match recipe {
            Recipe::Exact => own(JacobianModel::Exact),
            Recipe::Approximate => own(JacobianModel::Chapter),
            Recipe::WrongJacobian(WrongJacobian::TwiceTooLong) => changed(twice_too_long),
            Recipe::WrongJacobian(WrongJacobian::LeftForRight) => changed(left_for_right),
            Recipe::WrongResidual => changed(on_the_wrong_side),
        }
    }

    fn step(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        match self {
            Self::Own(optimizer) => optimizer.step(problem),
            Self::Changed(solver, change) => solver.step(problem, *change),
        }
    }
}

fn twice_too_long(_: &Between, exact: Jacobians) -> Jacobians {
    Jacobians {
        from: exact.from * 2.0,
        to: exact.to * 2.0,
        ..exact
    }
}

/// `Jl⁻¹(e) = Ad(exp(e))⁻¹ Jr⁻¹(e)`: both are functions of the same matrix.
fn left_for_right(_: &Between, exact: Jacobians) -> Jacobians {
    let turned = SE2::exp(&-exact.residual).adjoint();
    Jacobians {
        from: turned * exact.from,
        to: turned * exact.to,
        ..exact
    }
}

/// `log(Z E Z⁻¹) = Ad(Z) log(E)`, and so are its derivatives.
fn on_the_wrong_side(factor: &Between, exact: Jacobians) -> Jacobians {
    let moved = factor.measurement.adjoint();
    Jacobians {
        residual: moved * exact.residual,
        from: moved * exact.from,
        to: moved * exact.to,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWICE: Recipe = Recipe::WrongJacobian(WrongJacobian::TwiceTooLong);
    const LEFT: Recipe = Recipe::WrongJacobian(WrongJacobian::LeftForRight);
    const ALL: [Recipe; 5] = [
        Recipe::Exact,
        Recipe::Approximate,
        TWICE,
        LEFT,
        Recipe::WrongResidual,
    ];

    fn run(bias_deg: f64, recipe: Recipe) -> Descent {
        let problem = ring(&RingConfig {
            turn_bias_rad: bias_deg.to_radians(),
            ..RingConfig::default()
        });
        descend(&problem, recipe, &optimum(&problem).0, 60)
    }

    #[test]
    fn a_jacobian_twice_too_long_ends_at_the_optimum_after_many_more_steps() {
        let (exact, twice) = (run(6.0, Recipe::Exact), run(6.0, TWICE));
        assert!(exact.rests && twice.rests);
        // Steps below 1e-9, of which the doubled one goes half the way.
        assert!(exact.end().off_m < 1e-8 && twice.end().off_m < 1e-8);
        assert!(twice.steps() > 3 * exact.steps());
        assert!((twice.end().chi2 - exact.end().chi2).abs() < 1e-9);
    }

    #[test]
    fn a_wrong_jacobian_moves_the_end_by_the_square_of_the_contradiction_and_a_wrong_residual_by_itself()
     {
        let off = |recipe| [1.0, 2.0].map(|bias_deg| run(bias_deg, recipe).end().off_m);
        let growth = |recipe| {
            let [once, twice] = off(recipe);
            twice / once
        };
        // To a tenth: the next order of the expansion, at two degrees.
        for recipe in [Recipe::Approximate, LEFT] {
            assert!((growth(recipe) - 4.0).abs() < 0.4, "{}", growth(recipe));
        }
        let residual = growth(Recipe::WrongResidual);
        assert!((residual - 2.0).abs() < 0.2, "{residual}");
        assert!(off(Recipe::WrongResidual)[0] > 20.0 * off(Recipe::Approximate)[0]);
    }

    #[test]
    fn where_measurements_agree_all_recipes_end_at_the_same_place() {
        for recipe in ALL {
            let descent = run(0.0, recipe);
            assert!(descent.rests && descent.end().off_m < 1e-8, "{recipe:?}");
        }
    }

    #[test]
    fn no_end_is_better_than_the_optimum() {
        let best = run(6.0, Recipe::Exact).end().chi2;
        for recipe in ALL {
            assert!(
                run(6.0, recipe).end().chi2 >= best * (1.0 - 1e-12),
                "{recipe:?}"
            );
        }
        assert!(run(6.0, Recipe::WrongResidual).end().chi2 > 1.1 * best);
    }

    #[test]
    fn changed_measurements_take_the_log_of_the_changed_motion() {
        let problem = ring(&RingConfig::default());
        for factor in problem.factors() {
            let [from, to] = [factor.from, factor.to].map(|node| problem.poses()[node]);
            let seen = from.between(&to);
            let wrong = (seen * factor.measurement.inverse()).log();
            let right = (factor.measurement.inverse() * seen).log();
            let changed = factor.measurement.adjoint() * right;
            assert!((wrong - changed).amax() < 1e-12);
        }
    }
}
