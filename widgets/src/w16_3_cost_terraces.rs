//! Widget w16.3: the cost terraces of ICP beside the smooth hills of NDT.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
