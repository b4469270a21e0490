//! Widget w16.5: a few poses to drag, tied by springs, and the solver's steps one at a time.
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
        Box::new(model::PoseGraphToy::new()),
        Box::new(view::ToyView),
    )
}
