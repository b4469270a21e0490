//! Covariances of poses from the factor of the normal equations.

use nalgebra::Matrix3;

use super::Optimizer;
use crate::error::OptimizeError;
use crate::factor::JacobianModel;
use crate::incremental::{IncrementalCovariances, Prefix};
use crate::kernel::RobustKernel;
use crate::linear::LinearSolver;
use crate::marginals::JointCovariance;
use crate::problem::Problem;

impl Optimizer {
    /// Covariance blocks of two nodes at the present poses, exact to first order.
    ///
    /// Measurements are not weighted by a kernel and have their exact Jacobians. The factor is kept
    /// while the poses are unchanged and the graph grows only at its end, by nodes with one measurement each and a
    /// few loop closures.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    ///
    /// # Panics
    /// If a node does not exist.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> Result<JointCovariance, OptimizeError> {
        self.factor_reuse.invalidate();
        self.update_covariances(problem, Prefix::from_problem(problem))?;
        let covariances = self.covariances.as_ref().expect("just updated");
        let linear = self.linear.as_mut().expect("it was factorized");
        Ok(covariances.joint_covariance(linear, first, second))
    }

    /// Largest correction of any node, m and rad added, by the measurements added since the poses were last
    /// moved.
    ///
    /// To first order, without a kernel, and assuming that the poses were optimal then. Infinite if more
    /// measurements were added than the kept factor can be updated for.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn largest_move_since(&mut self, problem: &Problem) -> Result<f64, OptimizeError> {
        let is_later = |prefix: Prefix| prefix.factors > problem.optimized_factors();
        let prefix = Prefix::from_problem(problem);
        if is_later(prefix) {
            return Ok(f64::INFINITY);
        }
        self.factor_reuse.invalidate();
        self.update_covariances(problem, prefix)?;
        let covariances = self.covariances.as_ref().expect("just updated");
        // If a loop cannot be added, the prefix is the whole graph.
        Ok(if is_later(covariances.prefix()) {
            f64::INFINITY
        } else {
            covariances.largest_move()
        })
    }

    /// Covariance block of every node at the present poses, exact to first order; zero for fixed ones.
    ///
    /// Same conventions as [`joint_covariance`](Self::joint_covariance).
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn marginals(&mut self, problem: &Problem) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        Ok(self.factorize_plain(problem)?.marginals(problem))
    }

    /// Covariance blocks of the two ends of every measurement, in the order of [`Problem::factors`].
    ///
    /// Computes [`joint_covariance`](Self::joint_covariance) for all at once.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn measured_covariances(
        &mut self,
        problem: &Problem,
    ) -> Result<Vec<JointCovariance>, OptimizeError> {
        Ok(self.factorize_plain(problem)?.measured_covariances(problem))
    }

    /// Covariance of every node, as [`marginals`](Self::marginals), beside that with three linear functions of all
    /// nodes; zero for fixed ones.
    ///
    /// The functions are `Σ Aᵢᵀ δᵢ`, with `Aᵢ` in `functions`, by node.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    ///
    /// # Panics
    /// If there is not one block for each node.
    pub fn marginals_with(
        &mut self,
        problem: &Problem,
        functions: &[Matrix3<f64>],
    ) -> Result<Vec<[Matrix3<f64>; 2]>, OptimizeError> {
        assert_eq!(functions.len(), problem.node_count());
        let linear = self.factorize_plain(problem)?;
        let marginals = linear.marginals(problem);
        let positions = linear.structure().position_of.clone();
        let free = || (0..functions.len()).filter(|&node| !problem.fixed()[node]);
        let row_of = |node: usize| 3 * positions[node] as usize;
        let mut columns = vec![[0.0; 3]; 3 * positions.len()];
        for node in free() {
            for row in 0..3 {
                columns[row_of(node) + row] =
                    core::array::from_fn(|column| functions[node][(row, column)]);
            }
        }
        linear.solve_columns(&mut columns);
        let mut covariances: Vec<_> = marginals
            .into_iter()
            .map(|marginal| [marginal, Matrix3::zeros()])
            .collect();
        for node in free() {
            covariances[node][1] =
                Matrix3::from_fn(|row, column| columns[row_of(node) + row][column]);
        }
        Ok(covariances)
    }

    /// Factorizes H at the present poses, without kernel or damping.
    pub(crate) fn factorize_plain(
        &mut self,
        problem: &Problem,
    ) -> Result<&mut LinearSolver, OptimizeError> {
        self.factor_reuse.invalidate();
        self.analyse(problem);
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

    /// Updates the covariances to this graph at its present poses, with this prefix.
    fn update_covariances(
        &mut self,
        problem: &Problem,
        prefix: Prefix,
    ) -> Result<(), OptimizeError> {
        let ridge = self.settings.ridge;
        if let (Some(covariances), Some(linear)) = (&mut self.covariances, &mut self.linear)
            && covariances.is_prefix_of(problem, prefix, ridge)
            && covariances.extend(problem, linear).is_ok()
        {
            return Ok(());
        }
        let whole = Prefix::whole(problem);
        self.restart_covariances(problem, prefix).or_else(|error| {
            // A measurement that is too ill conditioned to be added becomes part of the prefix.
            if prefix == whole {
                return Err(error);
            }
            self.restart_covariances(problem, whole)
        })
    }

    fn restart_covariances(
        &mut self,
        problem: &Problem,
        prefix: Prefix,
    ) -> Result<(), OptimizeError> {
        let start = problem.prefix(prefix.nodes, prefix.factors);
        let ridge = self.settings.ridge;
        let linear = self.factorize_plain(&start)?;
        let mut covariances = IncrementalCovariances::new(start, prefix, ridge, linear);
        covariances.extend(problem, linear)?;
        self.covariances = Some(covariances);
        Ok(())
    }
}
