//! Widget w16.11: all orthogonal matrices that may align pairs, and the effect of a reflection on a map.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
