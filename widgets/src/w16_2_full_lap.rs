//! Widget w16.2: one lap of the Apartment, before and after its loops close.
//!
//! The reader scrubs over the lap, changes noise, seed and gate, and sees the effect of a loop: it moves the
//! history until the map is consistent, and leaves most of the path's error as it was. [`model`] contains the
//! logic, [`view`] the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
