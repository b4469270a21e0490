//! Widget w16.3: the cost terraces of ICP beside the hills of NDT.
//!
//! [`model`] contains the logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
