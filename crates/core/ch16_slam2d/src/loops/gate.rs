//! The χ² gate of an innovation.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::LoopConfig;

/// Result of the χ² gate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GateTest {
    /// `ξᵀ Ω ξ`.
    pub chi2: f64,
    /// The largest value that passes.
    pub gate_chi2: f64,
}

impl GateTest {
    /// Whether the innovation is within the gate.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.chi2 <= self.gate_chi2
    }
}

/// A custom test of the innovation of a loop.
pub trait InnovationGate: Send + Sync {
    /// The squared norm of `innovation` (m, m, rad) over a path of `gap` nodes, which may be at most
    /// [`LoopConfig::gate_chi2`]; NaN rejects the loop.
    fn chi2(&self, innovation: &Vector3<f64>, gap: usize, config: &LoopConfig) -> f64;
}

/// Compares the squared Mahalanobis norm of `innovation` (m, m, rad) with `gate_chi2`.
#[must_use]
pub fn chi_squared_gate(
    innovation: &Vector3<f64>,
    information: &Matrix3<f64>,
    gate_chi2: f64,
) -> GateTest {
    GateTest {
        chi2: innovation.dot(&(information * innovation)),
        gate_chi2,
    }
}
