//! Widget w16.9: a robot is switched on anywhere on the map of an earlier day.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
