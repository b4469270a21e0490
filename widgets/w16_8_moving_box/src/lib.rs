//! Widget w16.8: two sweeps with a box that moved between them, and three ways to bear it.
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
    Shell::new(Box::new(model::MovingBox::new()), Box::new(view::BoxView))
}
