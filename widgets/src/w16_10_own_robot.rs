//! Widget w16.10: a log of the reader's own robot: mapped, inspected, and corrected by hand.
//!
//! A worker beside the page does the mapping. [`model`] shows its reports ([`widget_kit::host_messages`]) and sends the
//! reader's commands as orders. [`view`] contains the layout.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;
