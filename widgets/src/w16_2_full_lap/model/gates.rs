//! Both gates of a loop: the drift model of each, and the region in which it accepts the measured position.

use ch16_lab::lap::{LapTrace, RecordedLoopAttempt};
use ch16_slam2d::chapter::{marginal_information, path_information};
use ch16_slam2d::graph::PoseGraph;
use ch16_slam2d::loops::{GateModel, GateTest, LoopConfig, LoopVerification, chi_squared_gate};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use pr_geom::{SE2, math};

/// The result of one gate for a loop, whether it decided or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Its drift model.
    pub model: GateModel,
    /// Information of the innovation under that drift, S⁻¹; x, y, θ in m and rad.
    pub information: Matrix3<f64>,
    /// Its verdict.
    pub test: GateTest,
}

/// Both gates for the same loop, on the graph before the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gates {
    /// The chapter's path approximation.
    pub path: Gate,
    /// The exact covariance of the relative pose.
    pub exact: Gate,
}

/// The ellipse `center + A u`, |u| ≤ 1, in the frame of the loop's old node, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Centre.
    pub center: [f64; 2],
    /// Columns of A: conjugate half axes, not the principal ones.
    pub half_axes: [[f64; 2]; 2],
}

impl Gates {
    /// Both gates for an attempt of `lap`.
    pub fn new(lap: &LapTrace, attempt: &RecordedLoopAttempt, config: &LoopConfig) -> Self {
        Self::on(&mut lap.graph_before(attempt), attempt, config)
    }

    /// Both gates for an attempt, on the graph before it.
    pub fn on(graph: &mut PoseGraph, attempt: &RecordedLoopAttempt, config: &LoopConfig) -> Self {
        let loop_ = &attempt.verification;
        let marginal = marginal_information(graph, loop_.candidate.node, loop_.from_node);
        let gate = |model, information| Gate {
            model,
            information,
            test: chi_squared_gate(&loop_.innovation, &information, config.gate_chi2),
        };
        Self {
            path: gate(
                GateModel::PathApproximation,
                path_information(loop_.gap(), config),
            ),
            // Zero if the graph has no covariance, that is, no information.
            exact: gate(GateModel::ExactMarginal, marginal.unwrap_or_default()),
        }
    }
}

impl Gate {
    /// The positions that the gate accepts at the registered heading: the measured one is inside exactly if
    /// the gate accepts it. `None` if that heading is rejected at every position.
    ///
    /// With the innovation split into position ρ and heading θ and S⁻¹ into blocks P, c and h, the gate `ξᵀ
    /// S⁻¹ ξ ≤ g` reads `(ρ − ρ₀)ᵀ P (ρ − ρ₀) ≤ g − (h − cᵀ P⁻¹ c) θ²` with `ρ₀ = −P⁻¹ c θ`. It is a section
    /// of the ellipsoid at θ, smaller than its projection. `exp` maps ρ to a displacement, linearly at a
    /// given θ.
    pub fn region(&self, loop_: &LoopVerification) -> Option<Region> {
        let theta = loop_.innovation.z;
        let position: Matrix2<f64> = self.information.fixed_view::<2, 2>(0, 0).into();
        let coupling: Vector2<f64> = self.information.fixed_view::<2, 1>(0, 2).into();
        let covariance = position.try_inverse()?;
        let drag = covariance * coupling;
        let heading = (self.information[(2, 2)] - coupling.dot(&drag)) * theta * theta;
        let left = self.test.gate_chi2 - heading;
        if left <= 0.0 {
            return None;
        }
        let at = |rho: Vector2<f64>| {
            let pose = loop_.predicted * SE2::exp(&Vector3::new(rho.x, rho.y, theta));
            Vector2::new(pose.x(), pose.y())
        };
        let center = at(-drag * theta);
        let half_axes =
            lower_root(&(covariance * left)).map(|axis| at(axis - drag * theta) - center);
        Some(Region {
            center: center.into(),
            half_axes: half_axes.map(Into::into),
        })
    }
}

/// The columns of the Cholesky factor L, `L Lᵀ = matrix`.
fn lower_root(matrix: &Matrix2<f64>) -> [Vector2<f64>; 2] {
    let first = math::sqrt(matrix[(0, 0)]);
    let below = matrix[(1, 0)] / first;
    let second = math::sqrt(matrix[(1, 1)] - below * below);
    [Vector2::new(first, below), Vector2::new(0.0, second)]
}
