//! Widget w16.8: two sweeps with a box that moved between them, and three treatments of its outliers.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
