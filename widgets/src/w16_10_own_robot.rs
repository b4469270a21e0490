//! Widget w16.10: a log of the reader's own robot, mapped, asked for its evidence, and corrected by hand.
//!
//! The mapping itself is done elsewhere, in a worker beside the page: [`model`] shows what that tells
//! ([`kit::outside`]) and puts what the reader wants into orders. [`view`] holds every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
