//! A measurement between two nodes that are there already.
//!
//! With its Jacobian J, its information Ω and the covariance C of all else, the covariance with it is
//!
//! ```text
//! C − U G Uᵀ,   U = C Jᵀ,   G = (Ω⁻¹ + J U)⁻¹ = Ω (1 + J U Ω)⁻¹
//! ```
//!
//! It is the update of a Kalman filter, or Woodbury's identity. Where the measurement says far more than was
//! known, the difference has no digits left.
//!
//! Source: Golub & Van Loan, "Matrix Computations", 2013, section 2.1.4.

use nalgebra::{Matrix3, Vector3};

use super::tail::{Propagation, at, put};
use crate::error::OptimizeError;
use crate::factor::PreparedPose;
use crate::problem::Problem;

/// A measurement that says so many times more than was known leaves half of a number's digits.
const MOST_KNOWN: f64 = 1e8;

/// A measurement that was added to what is known of a graph.
#[derive(Clone, Debug)]
pub(super) struct Closing {
    /// Its node that is named in errors.
    node: usize,
    /// Positions of its ends, with the Jacobian by each; zero by a fixed one.
    ends: [(usize, Matrix3<f64>); 2],
    /// e, at the poses of the graph.
    residual: Vector3<f64>,
    information: Matrix3<f64>,
    /// U, by position.
    columns: Vec<Matrix3<f64>>,
    /// G.
    gain: Matrix3<f64>,
}

impl Closing {
    /// Linearizes a factor; its columns are yet to come.
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
    pub fn put_columns(&self, columns: &mut [[f64; 3]]) {
        for (place, jacobian) in self.ends {
            put(columns, place, jacobian.transpose());
        }
    }

    /// Takes U, without what earlier closings take off it.
    pub fn take_columns(&mut self, columns: &[[f64; 3]]) {
        let places = 0..columns.len() / 3;
        self.columns = places.map(|place| at(columns, place)).collect();
    }

    /// Works out G, once U is there.
    ///
    /// # Errors
    /// Where the measurement leaves the covariance of its ends without enough digits, or not positive definite.
    pub fn weigh(&mut self) -> Result<(), OptimizeError> {
        let error = OptimizeError::NotPositiveDefinite { node: self.node };
        let known = self.across(&self.ends);
        let spread = Matrix3::identity() + known * self.information;
        let inverse = spread.try_inverse().ok_or(error)?;
        let gain = self.information * inverse;
        self.gain = 0.5 * (gain + gain.transpose());
        let left = known - known * self.gain * known;
        let is_sound = spread.amax() < MOST_KNOWN && left.cholesky().is_some();
        if is_sound { Ok(()) } else { Err(error) }
    }

    /// What it takes off a block of C.
    pub fn block(&self, places: [usize; 2]) -> Matrix3<f64> {
        let [row, column] = places.map(|place| &self.columns[place]);
        row * self.gain * column.transpose()
    }

    /// Turns the U of a later measurement without this one into that with it.
    pub fn take_off(&self, later: &mut Self) {
        let weighed = self.gain * later.across(&self.ends);
        for (sum, columns) in later.columns.iter_mut().zip(&self.columns) {
            *sum -= columns * weighed;
        }
    }

    /// Moves the nodes, by position, from where they would go without the measurement to where they go with it.
    pub fn correct(&self, moves: &mut [Vector3<f64>]) {
        let ends = self.ends.iter();
        let predicted: Vector3<f64> = ends.map(|(place, jacobian)| jacobian * moves[*place]).sum();
        let weighed = self.gain * (self.residual + predicted);
        for (sum, columns) in moves.iter_mut().zip(&self.columns) {
            *sum -= columns * weighed;
        }
    }

    /// `J U` for the J of a measurement with these ends.
    fn across(&self, ends: &[(usize, Matrix3<f64>); 2]) -> Matrix3<f64> {
        let ends = ends.iter();
        ends.map(|(place, jacobian)| jacobian * self.columns[*place])
            .sum()
    }

    /// Goes on to a node that hangs on the one at `parent`.
    pub fn carry_on(&mut self, link: &Propagation, parent: usize) {
        // The zero is what a solve begins with: −0 becomes 0.
        self.columns
            .push(Matrix3::zeros() + link.map * self.columns[parent]);
    }
}
