//! Update of a covariance by a measurement between two existing nodes.
//!
//! With its Jacobian J, its information Ω and the prior covariance C, the posterior covariance is
//!
//! ```text
//! C − U G Uᵀ,   U = C Jᵀ,   G = (Ω⁻¹ + J U)⁻¹ = Ω (1 + J U Ω)⁻¹
//! ```
//!
//! This is the update of a Kalman filter, or Woodbury's identity. If the measurement is far more informative than
//! the prior, the difference loses all digits.
//!
//! Source: Golub & Van Loan, "Matrix Computations", 2013, section 2.1.4.

use nalgebra::{Matrix3, Vector3};

use super::tail::{Propagation, at, put};
use crate::error::OptimizeError;
use crate::factor::PreparedPose;
use crate::problem::Problem;

/// Largest ratio of the information of a measurement to that of the prior: leaves half of a number's digits.
const MAX_INFORMATION_RATIO: f64 = 1e8;

/// The low-rank update by one measurement.
#[derive(Clone, Debug)]
pub(super) struct LoopUpdate {
    /// The node that errors name.
    node: usize,
    /// Positions of both ends, with the Jacobian with respect to each; zero for a fixed one.
    ends: [(usize, Matrix3<f64>); 2],
    /// e, at the poses of the graph.
    residual: Vector3<f64>,
    information: Matrix3<f64>,
    /// U, by position.
    columns: Vec<Matrix3<f64>>,
    /// G.
    gain: Matrix3<f64>,
}

impl LoopUpdate {
    /// Linearizes a factor; its columns are set later.
    pub fn new(problem: &Problem, factor: usize, positions: &[u32]) -> Self {
        let between = &problem.factors()[factor];
        let nodes = [between.from, between.to];
        let [from, to] = nodes.map(|node| PreparedPose::new(&problem.poses()[node]));
        let jacobians = problem.prepared()[factor].jacobians(&from, &to);
        let end = |node: usize, jacobian: Matrix3<f64>| {
            let is_free = !problem.fixed()[node];
            let jacobian = if is_free { jacobian } else { Matrix3::zeros() };
            (positions[node] as usize, jacobian)
        };
        Self {
            node: between.to,
            ends: [end(nodes[0], jacobians.from), end(nodes[1], jacobians.to)],
            residual: jacobians.residual,
            information: between.information,
            columns: Vec::new(),
            gain: Matrix3::zeros(),
        }
    }

    /// Writes Jᵀ into columns of zeros.
    pub fn write_columns(&self, columns: &mut [[f64; 3]]) {
        for (position, jacobian) in self.ends {
            put(columns, position, jacobian.transpose());
        }
    }

    /// Sets U, before the updates by earlier loops.
    pub fn set_columns(&mut self, columns: &[[f64; 3]]) {
        let positions = 0..columns.len() / 3;
        self.columns = positions.map(|position| at(columns, position)).collect();
    }

    /// Computes G from U.
    ///
    /// # Errors
    /// If the posterior covariance of its ends has too few digits or is not positive definite.
    pub fn compute_gain(&mut self) -> Result<(), OptimizeError> {
        let error = OptimizeError::NotPositiveDefinite { node: self.node };
        let known = self.across(&self.ends);
        let spread = Matrix3::identity() + known * self.information;
        let inverse = spread.try_inverse().ok_or(error)?;
        let gain = self.information * inverse;
        self.gain = 0.5 * (gain + gain.transpose());
        let left = known - known * self.gain * known;
        let is_sound = spread.amax() < MAX_INFORMATION_RATIO && left.cholesky().is_some();
        if is_sound { Ok(()) } else { Err(error) }
    }

    /// The part that it subtracts from a block of C.
    pub fn block(&self, positions: [usize; 2]) -> Matrix3<f64> {
        let [row, column] = positions.map(|position| &self.columns[position]);
        row * self.gain * column.transpose()
    }

    /// Applies this update to the U of a later measurement.
    pub fn subtract_from(&self, later: &mut Self) {
        let correction = self.gain * later.across(&self.ends);
        for (sum, columns) in later.columns.iter_mut().zip(&self.columns) {
            *sum -= columns * correction;
        }
    }

    /// Corrects the moves of the nodes, by position, by this measurement.
    pub fn correct(&self, moves: &mut [Vector3<f64>]) {
        let ends = self.ends.iter();
        let predicted: Vector3<f64> = ends
            .map(|(position, jacobian)| jacobian * moves[*position])
            .sum();
        let correction = self.gain * (self.residual + predicted);
        for (sum, columns) in moves.iter_mut().zip(&self.columns) {
            *sum -= columns * correction;
        }
    }

    /// `J U` for the J of a measurement with these ends.
    fn across(&self, ends: &[(usize, Matrix3<f64>); 2]) -> Matrix3<f64> {
        let ends = ends.iter();
        ends.map(|(position, jacobian)| jacobian * self.columns[*position])
            .sum()
    }

    /// Appends a node whose only measurement is from the node at `parent`.
    pub fn propagate(&mut self, link: &Propagation, parent: usize) {
        // A solve starts from +0, so −0 becomes 0.
        self.columns
            .push(Matrix3::zeros() + link.map * self.columns[parent]);
    }
}
