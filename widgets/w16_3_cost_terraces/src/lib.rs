//! Widget w16.3: the cost terraces of ICP beside the smooth hills of NDT.
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
        Box::new(model::CostTerraces::new()),
        Box::new(view::TerracesView),
    )
}
