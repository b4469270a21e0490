//! Widget w16.1: where registration converges, and where it only seems to.
//!
//! Two sweeps of room A. The reader moves and turns one of them, lets ICP run, and sees which
//! minimum it reaches; the basin map shows the answer for every start at once.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
