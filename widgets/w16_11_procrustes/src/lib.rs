//! Widget w16.11: all orthogonal matrices that may bring pairs together, and what a mirror image does to a map.
//!
//! [`model`] holds every rule and no pixel, [`view`] every pixel and no rule.

pub mod model;
pub mod spec;
#[cfg(feature = "view")]
pub mod view;

#[cfg(feature = "view")]
use kit::shell::Shell;

/// The widget, ready to be drawn.
#[cfg(feature = "view")]
#[must_use]
pub fn widget() -> Shell {
    Shell::new(
        Box::new(model::ProcrustesTrace::new()),
        Box::new(view::TraceView),
    )
}
