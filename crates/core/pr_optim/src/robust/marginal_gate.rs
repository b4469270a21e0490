//! Test of a loop against the rest of a graph, by exact covariances.

use nalgebra::Matrix3;

use crate::error::OptimizeError;
use crate::factor::Between;
use crate::linear::LinearSolver;
use crate::marginals::JointCovariance;
use crate::optimizer::Optimizer;
use crate::problem::Problem;

/// Whether a measurement is part of the graph that tests it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It is part of the graph: its own contribution is removed.
    Kept,
    /// It is not part of the graph.
    Dropped,
}

/// The factor of a graph, for tests of loops.
pub struct MarginalGate<'a> {
    problem: &'a Problem,
    linear: &'a mut LinearSolver,
}

impl<'a> MarginalGate<'a> {
    /// Factorizes the graph at its present poses.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn new(optimizer: &'a mut Optimizer, problem: &'a Problem) -> Result<Self, OptimizeError> {
        let linear = optimizer.factorize_plain(problem)?;
        Ok(Self { problem, linear })
    }

    /// `eᵀ(Ω⁻¹ + Σ)⁻¹e` for the residual e of a loop: the increase of χ², to first order, if the loop is
    /// added.
    ///
    /// Σ is the covariance of the relative pose by the rest of the graph. For a loop that is part of the graph,
    /// the covariance Σ′ includes it, and `eᵀ(Ω⁻¹ − Σ′)⁻¹e` is the decrease of χ² if it is removed. NaN if that
    /// matrix has no inverse.
    pub fn chi2(&mut self, factor: &Between, standing: Standing) -> f64 {
        let joint = self
            .linear
            .joint_covariance(self.problem, factor.from, factor.to);
        marginal_chi2(self.problem, factor, &joint, standing)
    }

    /// [`chi2`](Self::chi2) of every measurement, as part of the graph.
    pub fn all_kept(&self) -> Vec<f64> {
        let joints = self.linear.measured_covariances(self.problem);
        let factors = self.problem.factors().iter();
        factors
            .zip(joints)
            .map(|(factor, joint)| marginal_chi2(self.problem, factor, &joint, Standing::Kept))
            .collect()
    }
}

fn marginal_chi2(
    problem: &Problem,
    factor: &Between,
    joint: &JointCovariance,
    standing: Standing,
) -> f64 {
    let [from, to] = [factor.from, factor.to].map(|node| &problem.poses()[node]);
    let e = (factor.measurement.inverse() * from.between(to)).log();
    let sign = match standing {
        Standing::Kept => -1.0,
        Standing::Dropped => 1.0,
    };
    // (Ω⁻¹ ± Σ)⁻¹ = Ω(1 ± ΣΩ)⁻¹, because Ω may have no inverse.
    let spread = Matrix3::identity() + joint.relative(from, to) * factor.information * sign;
    spread.try_inverse().map_or(f64::NAN, |inverse| {
        e.dot(&(factor.information * (inverse * e)))
    })
}
