//! Widget w16.12: one pose graph solved with exact and wrong Jacobians, and with a wrong residual.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
