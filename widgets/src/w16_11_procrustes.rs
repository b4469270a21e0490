//! Widget w16.11: all orthogonal matrices that may bring pairs together, and what a mirror image does to a map.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
