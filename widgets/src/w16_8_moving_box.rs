//! Widget w16.8: two sweeps with a box that moved between them, and three ways to bear it.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
