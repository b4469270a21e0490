//! What the widget promises, without a display.

mod model;
mod view;
mod visitor;
