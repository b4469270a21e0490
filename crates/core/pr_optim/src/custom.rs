//! Gauss–Newton steps with a custom residual and custom Jacobians, for experiments with them.
//!
//! Graph, symbolic analysis and factorization are those of the [`Optimizer`](crate::Optimizer). Only the
//! contribution of a factor to `H δ = −g` is supplied by the caller: `JᵀΩJ` and `JᵀΩe` with any `e` and `J`.
//! There is no damping, no kernel, and no step is reverted.

use nalgebra::{Matrix3, Vector3};
use pr_geom::twist_size;

use crate::error::OptimizeError;
use crate::factor::{Between, Jacobians, PreparedPose};
use crate::linear::LinearSolver;
use crate::problem::Problem;
use crate::report::StepReport;
use crate::settings::Settings;
use crate::structure::FactorSlot;
use crate::system::{Block, NormalEquations};

/// A solver with caller-supplied residuals and Jacobians, and its workspace.
#[derive(Debug, Default)]
pub struct CustomGaussNewton {
    linear: Option<LinearSolver>,
    equations: NormalEquations,
    delta: Vec<f64>,
}

impl CustomGaussNewton {
    /// A solver without a symbolic analysis yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes one full step, whether or not it lowers the cost.
    ///
    /// `change` receives each measurement with its exact residual and Jacobians, and returns the ones to use. The
    /// reported χ² is that of the returned residuals.
    ///
    /// # Errors
    /// If the normal equations are not positive definite or not finite; the poses are unchanged.
    pub fn step(
        &mut self,
        problem: &mut Problem,
        change: impl Fn(&Between, Jacobians) -> Jacobians,
    ) -> Result<StepReport, OptimizeError> {
        if !self
            .linear
            .as_ref()
            .is_some_and(|linear| linear.fits(problem))
        {
            self.linear = None;
        }
        let linear = self
            .linear
            .get_or_insert_with(|| LinearSolver::new(problem));
        let ridge = Settings::default().ridge;
        let poses: Vec<_> = problem.poses().iter().map(PreparedPose::new).collect();
        let equations = &mut self.equations;
        let structure = linear.structure();
        equations.clear(structure, ridge);
        let factors = problem.factors().iter().zip(problem.prepared());
        for ((factor, prepared), slot) in factors.zip(&structure.factor_slots) {
            let exact = prepared.jacobians(&poses[factor.from], &poses[factor.to]);
            let ends = [factor.from, factor.to].map(|node| structure.position_of[node] as usize);
            add(equations, factor, &change(factor, exact), ends, *slot);
        }
        equations.hold_fixed(problem, structure, ridge);
        if !equations.chi2.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        linear.factorize(equations, 0.0)?;
        self.delta.clear();
        self.delta.extend(equations.gradient.iter().map(|g| -g));
        linear.solve(&mut self.delta);
        let predicted_decrease = -(equations.gradient.iter().zip(&self.delta))
            .map(|(g, d)| g * d)
            .sum::<f64>();
        let step_of = |node: usize| {
            let k = 3 * linear.structure().position_of[node] as usize;
            Vector3::new(self.delta[k], self.delta[k + 1], self.delta[k + 2])
        };
        let sizes = (0..poses.len()).map(|node| twist_size(&step_of(node)));
        let largest_step = sizes.fold(0.0, |largest, size| {
            // `max` would ignore a NaN.
            if size > largest || size.is_nan() {
                size
            } else {
                largest
            }
        });
        if !largest_step.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        for (node, pose) in problem.poses_mut().iter_mut().enumerate() {
            *pose = poses[node].boxplus(&step_of(node));
        }
        Ok(StepReport {
            chi2_before: self.equations.chi2,
            cost_before: self.equations.chi2,
            largest_step,
            predicted_decrease,
            damping: 0.0,
            accepted: true,
        })
    }
}

/// Adds `JᵀΩJ`, `JᵀΩe` and `eᵀΩe` of one factor.
fn add(
    equations: &mut NormalEquations,
    factor: &Between,
    parts: &Jacobians,
    [from, to]: [usize; 2],
    slot: FactorSlot,
) {
    let omega = &factor.information;
    let weighed = omega * parts.residual;
    equations.chi2 += parts.residual.dot(&weighed);
    for (jacobian, position) in [(&parts.from, from), (&parts.to, to)] {
        let gradient = jacobian.transpose() * weighed;
        for axis in 0..3 {
            equations.gradient[3 * position + axis] += gradient[axis];
        }
        let block = column_major(jacobian.transpose() * omega * jacobian);
        for (sum, entry) in equations.diagonal[position].iter_mut().zip(block) {
            *sum += entry;
        }
    }
    let to_from = column_major(parts.to.transpose() * omega * parts.from);
    equations.add_off_diagonal(slot, &to_from);
}

fn column_major(matrix: Matrix3<f64>) -> Block {
    let mut block = [0.0; 9];
    block.copy_from_slice(matrix.as_slice());
    block
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factor::JacobianModel;
    use crate::optimizer::Optimizer;
    use pr_geom::SE2;

    /// A bent chain of five poses whose loop disagrees with it.
    fn bent() -> Problem {
        let mut problem = Problem::new();
        let step = SE2::new(1.0, 0.1, 0.8);
        let mut pose = SE2::identity();
        problem.add_fixed_pose(pose);
        let information = Matrix3::new(9.0, 1.0, 0.5, 1.0, 8.0, -0.3, 0.5, -0.3, 20.0);
        for k in 0..4 {
            pose = pose * SE2::new(0.9, 0.2, 0.7);
            problem.add_pose(pose);
            problem.add_factor(Between {
                from: k,
                to: k + 1,
                measurement: step,
                information,
            });
        }
        problem.add_factor(Between {
            from: 4,
            to: 0,
            measurement: SE2::new(0.5, -1.2, 2.6),
            information,
        });
        problem
    }

    #[test]
    fn exact_jacobians_give_the_steps_of_the_optimizer() {
        let (mut own, mut other) = (bent(), bent());
        let mut custom = CustomGaussNewton::new();
        let mut optimizer = Optimizer::new(Settings {
            jacobians: JacobianModel::Exact,
            ..Settings::default()
        });
        for _ in 0..4 {
            let step = custom.step(&mut own, |_, exact| exact).unwrap();
            let reference = optimizer.step(&mut other).unwrap();
            // 1e-9 relative: the blocks are multiplied out in another order.
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
            assert!(near(step.chi2_before, reference.chi2_before));
            assert!(near(step.largest_step, reference.largest_step));
            assert!(near(step.predicted_decrease, reference.predicted_decrease));
            for (a, b) in own.poses().iter().zip(other.poses()) {
                assert!(a.boxminus(b).amax() < 1e-9, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn the_jacobians_agree_with_finite_differences() {
        let problem = bent();
        let h = 1e-6;
        for (factor, prepared) in problem.factors().iter().zip(problem.prepared()) {
            let ends = [factor.from, factor.to].map(|node| problem.poses()[node]);
            let at = |ends: [SE2; 2]| {
                let [from, to] = ends.map(|pose| PreparedPose::new(&pose));
                prepared.residual(&from, &to)
            };
            let [from, to] = ends.map(|pose| PreparedPose::new(&pose));
            let exact = prepared.jacobians(&from, &to);
            assert_eq!(exact.residual, at(ends));
            for (end, jacobian) in [exact.from, exact.to].iter().enumerate() {
                for axis in 0..3 {
                    let moved = |by: f64| {
                        let mut delta = Vector3::zeros();
                        delta[axis] = by;
                        let mut moved = ends;
                        moved[end] = moved[end].boxplus(&delta);
                        at(moved)
                    };
                    let slope = (moved(h) - moved(-h)) / (2.0 * h);
                    // 1e-8: central differences of 1e-6, and rounding over that.
                    assert!((slope - jacobian.column(axis)).amax() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn fixed_poses_and_unsolvable_problems_stay_unchanged() {
        let mut problem = bent();
        let before = problem.poses().to_vec();
        let mut custom = CustomGaussNewton::new();
        custom.step(&mut problem, |_, exact| exact).unwrap();
        assert_eq!(problem.poses()[0], before[0]);
        assert_ne!(problem.poses()[1], before[1]);
        let mut broken = bent();
        let not_a_number = custom.step(&mut broken, |_, mut exact| {
            exact.residual.x = f64::NAN;
            exact
        });
        assert_eq!(not_a_number, Err(OptimizeError::NotFinite));
        assert_eq!(broken.poses(), before);
    }
}
