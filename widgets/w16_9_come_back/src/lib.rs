//! Widget w16.9: a robot is switched on anywhere on the map of yesterday.
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
        Box::new(model::ComeBack::new()),
        Box::new(view::ComeBackView),
    )
}
