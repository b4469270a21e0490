//! No forgery: what the others do hides none of its tests.

pub use exercise_solutions::{jacobians, residual};
