//! What the factor of the normal equations says of the poses' covariances.

use nalgebra::Matrix3;

use super::Optimizer;
use crate::error::OptimizeError;
use crate::factor::JacobianModel;
use crate::growth::{Growth, GrowthStart};
use crate::kernel::RobustKernel;
use crate::linear::{Factorization, LinearSolver};
use crate::marginals::JointCovariance;
use crate::problem::Problem;

impl Optimizer {
    /// Covariance blocks of two nodes at the present poses, exact to first order.
    ///
    /// The measurements count unweighted by any kernel, with their exact Jacobians. The factor is
    /// this crate's own, whatever the settings name. It is kept while the poses stay and the graph grows at
    /// its end, by nodes with one measurement each and a few that close loops.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    ///
    /// # Panics
    /// Where a node does not exist.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> Result<JointCovariance, OptimizeError> {
        self.held.lose();
        self.follow(problem, GrowthStart::from_problem(problem))?;
        let growth = self.growth.as_ref().expect("it follows the problem");
        let linear = self.linear.as_mut().expect("it was factorized");
        Ok(growth.joint_covariance(linear, first, second))
    }

    /// How far the farthest node would move, m and rad added, if the measurements since the poses were last moved
    /// corrected them.
    ///
    /// That is to first order, without a kernel, and from poses that were the best ones then. Infinite where more
    /// were added than are kept beside the factor.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    pub fn largest_move_since(&mut self, problem: &Problem) -> Result<f64, OptimizeError> {
        let is_later = |start: GrowthStart| start.factors > problem.optimized_factors();
        let start = GrowthStart::from_problem(problem);
        if is_later(start) {
            return Ok(f64::INFINITY);
        }
        self.held.lose();
        self.follow(problem, start)?;
        let growth = self.growth.as_ref().expect("it follows the problem");
        // Where a loop cannot be added, all of the graph is the beginning.
        Ok(if is_later(growth.start()) {
            f64::INFINITY
        } else {
            growth.largest_move()
        })
    }

    /// Covariance block of every node at the present poses, exact to first order; zero for fixed ones.
    ///
    /// By the rules of [`joint_covariance`](Self::joint_covariance).
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    pub fn marginals(&mut self, problem: &Problem) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        let marginals = self.factorize_plain(problem)?.marginals(problem);
        Ok(marginals.expect("the block factorization shows its factor"))
    }

    /// Covariance blocks of the two ends of every measurement, in the order of [`Problem::factors`].
    ///
    /// By the rules of [`joint_covariance`](Self::joint_covariance), but all at once.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    pub fn measured_covariances(
        &mut self,
        problem: &Problem,
    ) -> Result<Vec<JointCovariance>, OptimizeError> {
        let measured = self.factorize_plain(problem)?.measured_covariances(problem);
        Ok(measured.expect("the block factorization shows its factor"))
    }

    /// Factorizes H at the present poses without kernel or damping, by blocks.
    pub(crate) fn factorize_plain(
        &mut self,
        problem: &Problem,
    ) -> Result<&mut LinearSolver, OptimizeError> {
        self.held.lose();
        self.analyse(problem, Factorization::Block);
        let linear = self.linear.as_mut().expect("it was analysed");
        self.equations.assemble(
            problem,
            linear.structure(),
            JacobianModel::Exact,
            RobustKernel::None,
            self.settings.ridge,
        );
        linear.factorize(&self.equations, 0.0)?;
        Ok(linear)
    }

    /// Makes the growth stand for that graph, at its present poses, from that beginning on.
    fn follow(&mut self, problem: &Problem, start: GrowthStart) -> Result<(), OptimizeError> {
        let ridge = self.settings.ridge;
        if let (Some(growth), Some(linear)) = (&mut self.growth, &mut self.linear)
            && growth.goes_on_to(problem, start, ridge)
            && growth.extend(problem, linear).is_ok()
        {
            return Ok(());
        }
        let whole = GrowthStart::whole(problem);
        self.begin(problem, start).or_else(|error| {
            // What is too ill conditioned to be added is a part of the beginning.
            if start == whole {
                return Err(error);
            }
            self.begin(problem, whole)
        })
    }

    fn begin(&mut self, problem: &Problem, start: GrowthStart) -> Result<(), OptimizeError> {
        let of = problem.beginning(start.nodes, start.factors);
        let ridge = self.settings.ridge;
        let linear = self.factorize_plain(&of)?;
        let mut growth = Growth::new(of, start, ridge, linear);
        growth.extend(problem, linear)?;
        self.growth = Some(growth);
        Ok(())
    }
}
