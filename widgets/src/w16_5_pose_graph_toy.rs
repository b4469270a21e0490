//! Widget w16.5: a few poses to drag, connected by springs, and the solver's steps one at a time.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
