//! Tests of the box's model and view.

mod model;
mod view;
