//! Widget w16.1: the basin of convergence of a registration, and its false minima.
//!
//! Two sweeps of room A. The reader moves and turns one of them, runs ICP, and sees which minimum it reaches;
//! the basin map shows the result for every start at once.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
