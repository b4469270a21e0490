//! What the factor of the normal equations says of the poses' covariances.

use nalgebra::Matrix3;

use super::Optimizer;
use crate::error::OptimizeError;
use crate::factor::JacobianModel;
use crate::kernel::RobustKernel;
use crate::linear::{Factorization, LinearSolver};
use crate::marginals::JointCovariance;
use crate::problem::Problem;
use crate::tail::{Tail, TailStart};

/// What the linear solver holds the factor of, without kernel or damping.
#[derive(Debug)]
pub(super) struct PlainFactor {
    of: Problem,
    ridge: f64,
}

impl Optimizer {
    /// Covariance blocks of two nodes at the present poses, exact to first order.
    ///
    /// The measurements count unweighted by any kernel, with their exact Jacobians. The factor is
    /// this crate's own, whatever the settings name. It is kept while the graph only grows at its end, by
    /// nodes with one measurement each.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite, as far as the two nodes depend on them.
    ///
    /// # Panics
    /// Where a node does not exist.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> Result<JointCovariance, OptimizeError> {
        let start = TailStart::of(problem);
        let tail = Tail::new(problem, start, [first, second], self.settings.ridge)?;
        let [first, second] = tail.roots();
        let linear = self.factorize_beginning(problem, start)?;
        let joint = linear.joint_covariance(problem, first, second);
        Ok(tail.joint(&joint.expect("the block factorization shows its factor")))
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

    /// The same of the graph before its tail, unless that is what was factorized last.
    fn factorize_beginning(
        &mut self,
        problem: &Problem,
        start: TailStart,
    ) -> Result<&mut LinearSolver, OptimizeError> {
        let ridge = self.settings.ridge;
        let is_kept = self.plain.as_ref().is_some_and(|plain| {
            plain.ridge == ridge
                && plain.of.node_count() == start.nodes
                && plain.of.factors().len() == start.factors
                && problem.begins_with(&plain.of)
        });
        if !is_kept {
            let of = problem.beginning(start.nodes, start.factors);
            self.factorize_plain(&of)?;
            self.plain = Some(PlainFactor { of, ridge });
        }
        Ok(self.linear.as_mut().expect("it was analysed"))
    }
}
