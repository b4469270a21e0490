//! The linear solver of an iteration: the chosen factorization and its symbolic analysis.

use nalgebra::Matrix3;

use crate::block_cholesky::BlockCholesky;
use crate::error::OptimizeError;
#[cfg(feature = "faer_cholesky")]
use crate::faer_cholesky::FaerCholesky;
use crate::marginals::{JointCovariance, all_marginals, all_measured, joint_covariance};
use crate::ordering::minimum_degree;
use crate::problem::Problem;
use crate::structure::Structure;
use crate::system::NormalEquations;

/// Which sparse Cholesky factorization solves the normal equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Factorization {
    /// This crate's multifrontal factorization of 3×3 blocks.
    #[default]
    Block,
    /// `faer`'s simplicial factorization of scalars, with the feature `faer_cholesky`.
    #[cfg(feature = "faer_cholesky")]
    Faer,
}

/// The pattern of a graph and its factorization, kept while the graph is unchanged.
#[derive(Debug)]
pub struct LinearSolver {
    structure: Structure,
    cholesky: Cholesky,
}

#[derive(Debug)]
enum Cholesky {
    Block(Box<BlockCholesky>),
    #[cfg(feature = "faer_cholesky")]
    Faer(Box<FaerCholesky>),
}

impl LinearSolver {
    /// Orders and analyses the graph of `problem`; poses and measured values do not matter.
    #[must_use]
    pub fn new(problem: &Problem, factorization: Factorization) -> Self {
        Self::renewed(problem, factorization, None)
    }

    /// [`new`](Self::new) in the memory of a solver that is no longer needed.
    pub(crate) fn renewed(
        problem: &Problem,
        factorization: Factorization,
        old: Option<Self>,
    ) -> Self {
        let structure = Structure::new(problem, minimum_degree(problem));
        let order = BlockCholesky::postordered(&structure);
        let structure = Structure::new(problem, order);
        let cholesky = match factorization {
            Factorization::Block => Cholesky::Block(match old.map(|old| old.cholesky) {
                Some(Cholesky::Block(mut old)) => {
                    old.renew(&structure);
                    old
                }
                _ => Box::new(BlockCholesky::new(&structure)),
            }),
            #[cfg(feature = "faer_cholesky")]
            Factorization::Faer => Cholesky::Faer(Box::new(FaerCholesky::new(&structure))),
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

    /// Whether the analysis belongs to this graph and factorization.
    #[must_use]
    pub fn fits(&self, problem: &Problem, factorization: Factorization) -> bool {
        let kind = match self.cholesky {
            Cholesky::Block(_) => Factorization::Block,
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(_) => Factorization::Faer,
        };
        kind == factorization && self.structure.fits(problem)
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
        match &mut self.cholesky {
            Cholesky::Block(cholesky) => cholesky.factorize(&self.structure, equations, damping),
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(cholesky) => cholesky.factorize(&self.structure, equations, damping),
        }
    }

    /// Covariance blocks of two nodes from the last factor, which was made without damping.
    ///
    /// Right perturbations, tangent order x, y, θ. Zero for a fixed node. `None` if the factorization is `faer`'s,
    /// which does not expose its factor by blocks.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> Option<JointCovariance> {
        match &mut self.cholesky {
            Cholesky::Block(cholesky) => Some(joint_covariance(
                &self.structure,
                problem.fixed(),
                cholesky,
                [first, second],
            )),
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(_) => None,
        }
    }

    /// Covariance block of every node from the last factor, which was made without damping.
    ///
    /// `None` if the factorization is `faer`'s, which does not expose its factor by blocks.
    #[must_use]
    pub fn marginals(&self, problem: &Problem) -> Option<Vec<Matrix3<f64>>> {
        match &self.cholesky {
            Cholesky::Block(cholesky) => {
                Some(all_marginals(&self.structure, problem.fixed(), cholesky))
            }
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(_) => None,
        }
    }

    /// Covariance blocks of the two ends of every measurement, in the order of [`Problem::factors`].
    ///
    /// Computes [`joint_covariance`](Self::joint_covariance) for all at once.
    #[must_use]
    pub fn measured_covariances(&self, problem: &Problem) -> Option<Vec<JointCovariance>> {
        match &self.cholesky {
            Cholesky::Block(cholesky) => Some(all_measured(&self.structure, problem, cholesky)),
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(_) => None,
        }
    }

    /// Overwrites three interleaved right-hand sides, in elimination order, with `H⁻¹` times them.
    ///
    /// `None` if the factorization is `faer`'s, which solves for one at a time.
    pub(crate) fn solve_columns(&mut self, columns: &mut [[f64; 3]]) -> Option<()> {
        match &mut self.cholesky {
            Cholesky::Block(cholesky) => {
                cholesky.solve_sides(columns);
                Some(())
            }
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(_) => None,
        }
    }

    /// Overwrites `rhs`, in elimination order, with `H⁻¹ rhs`.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        match &mut self.cholesky {
            Cholesky::Block(cholesky) => cholesky.solve(rhs),
            #[cfg(feature = "faer_cholesky")]
            Cholesky::Faer(cholesky) => cholesky.solve(rhs),
        }
    }
}
