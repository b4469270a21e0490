//! Widget w16.2: one lap of the Apartment, before and after its loops close.
//!
//! The reader scrubs over the lap, changes noise, seed and gate, and sees what a loop does: it
//! moves the history until the map agrees with itself, and leaves most of the path as wrong as it
//! was. [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
