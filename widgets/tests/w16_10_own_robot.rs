//! Tests of the widget, without a display.

mod model;
mod view;
mod visitor;
