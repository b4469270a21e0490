//! What the rest of a graph says about a loop, by exact covariances.

use nalgebra::Matrix3;

use crate::error::OptimizeError;
use crate::factor::Between;
use crate::linear::LinearSolver;
use crate::marginals::JointCovariance;
use crate::optimizer::Optimizer;
use crate::problem::Problem;

/// Whether a measurement is part of the graph that judges it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It is: its own say is taken out.
    Kept,
    /// It is not.
    Dropped,
}

/// The factor of a graph, to ask it about loops.
pub struct MarginalGate<'a> {
    problem: &'a Problem,
    linear: &'a mut LinearSolver,
}

impl<'a> MarginalGate<'a> {
    /// Factorizes the graph at its present poses.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    pub fn new(optimizer: &'a mut Optimizer, problem: &'a Problem) -> Result<Self, OptimizeError> {
        let linear = optimizer.factorize_plain(problem)?;
        Ok(Self { problem, linear })
    }

    /// `eᵀ(Ω⁻¹ + Σ)⁻¹e` for the residual e of a loop: by so much χ² grows, to first order, where the
    /// loop joins the graph.
    ///
    /// Σ is the covariance of the relative pose by the rest of the graph. Of a loop that is part of
    /// it the graph knows Σ′ instead, and `eᵀ(Ω⁻¹ − Σ′)⁻¹e` is by how much χ² shrinks where it goes.
    /// Not a number where that matrix has no inverse.
    pub fn chi2(&mut self, factor: &Between, standing: Standing) -> f64 {
        let joint = self
            .linear
            .joint_covariance(self.problem, factor.from, factor.to);
        joint.map_or(f64::NAN, |joint| {
            marginal_chi2(self.problem, factor, &joint, standing)
        })
    }

    /// The same for every measurement of the graph, as a part of it.
    pub fn all_kept(&self) -> Vec<f64> {
        let joints = self.linear.measured_covariances(self.problem);
        let factors = self.problem.factors().iter();
        factors
            .zip(joints.unwrap_or_default())
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
    // (Ω⁻¹ ± Σ)⁻¹ = Ω(1 ± ΣΩ)⁻¹, where Ω need not have an inverse.
    let spread = Matrix3::identity() + joint.relative(from, to) * factor.information * sign;
    spread.try_inverse().map_or(f64::NAN, |inverse| {
        e.dot(&(factor.information * (inverse * e)))
    })
}
