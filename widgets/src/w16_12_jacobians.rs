//! Widget w16.12: one pose graph solved with exact and wrong Jacobians, and with a wrong residual.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
