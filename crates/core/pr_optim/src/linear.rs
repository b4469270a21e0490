//! The linear solver of an iteration: the block factorization and its symbolic analysis.

use nalgebra::Matrix3;

use crate::block_cholesky::BlockCholesky;
use crate::error::OptimizeError;
use crate::marginals::{JointCovariance, all_marginals, all_measured, joint_covariance};
use crate::ordering::minimum_degree;
use crate::problem::Problem;
use crate::structure::Structure;
use crate::system::NormalEquations;

/// The pattern of a graph and its factorization, kept while the graph is unchanged.
#[derive(Debug)]
pub struct LinearSolver {
    structure: Structure,
    cholesky: BlockCholesky,
}

impl LinearSolver {
    /// Orders and analyses the graph of `problem`; poses and measured values do not matter.
    #[must_use]
    pub fn new(problem: &Problem) -> Self {
        Self::renewed(problem, None)
    }

    /// [`new`](Self::new) in the memory of a solver that is no longer needed.
    pub(crate) fn renewed(problem: &Problem, old: Option<Self>) -> Self {
        let structure = Structure::new(problem, minimum_degree(problem));
        let order = BlockCholesky::postordered(&structure);
        let structure = Structure::new(problem, order);
        let cholesky = match old {
            Some(mut old) => {
                old.cholesky.renew(&structure);
                old.cholesky
            }
            None => BlockCholesky::new(&structure),
        };
        Self {
            structure,
            cholesky,
        }
    }

    /// The block pattern, and the elimination order.
    #[must_use]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Whether the analysis belongs to this graph.
    #[must_use]
    pub fn fits(&self, problem: &Problem) -> bool {
        self.structure.fits(problem)
    }

    /// Factorizes `H` with every diagonal entry multiplied by `1 + damping`.
    ///
    /// # Errors
    /// [`OptimizeError::NotPositiveDefinite`] if a pivot is not positive.
    pub fn factorize(
        &mut self,
        equations: &NormalEquations,
        damping: f64,
    ) -> Result<(), OptimizeError> {
        self.cholesky.factorize(&self.structure, equations, damping)
    }

    /// Covariance blocks of two nodes from the last factor, which was made without damping.
    ///
    /// Right perturbations, tangent order x, y, θ. Zero for a fixed node.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> JointCovariance {
        let nodes = [first, second];
        joint_covariance(&self.structure, problem.fixed(), &mut self.cholesky, nodes)
    }

    /// Covariance block of every node from the last factor, which was made without damping.
    #[must_use]
    pub fn marginals(&self, problem: &Problem) -> Vec<Matrix3<f64>> {
        all_marginals(&self.structure, problem.fixed(), &self.cholesky)
    }

    /// Covariance blocks of the two ends of every measurement, in the order of [`Problem::factors`].
    ///
    /// Computes [`joint_covariance`](Self::joint_covariance) for all at once.
    #[must_use]
    pub fn measured_covariances(&self, problem: &Problem) -> Vec<JointCovariance> {
        all_measured(&self.structure, problem, &self.cholesky)
    }

    /// Overwrites three interleaved right-hand sides, in elimination order, with `H⁻¹` times them.
    pub(crate) fn solve_columns(&mut self, columns: &mut [[f64; 3]]) {
        self.cholesky.solve_sides(columns);
    }

    /// Overwrites `rhs`, in elimination order, with `H⁻¹ rhs`.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        self.cholesky.solve(rhs);
    }
}
