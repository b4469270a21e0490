//! Widget w16.7: place recognition on the keyframes of a lap, pair by pair.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
