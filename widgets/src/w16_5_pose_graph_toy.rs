//! Widget w16.5: a few poses to drag, tied by springs, and the solver's steps one at a time.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
