//! Tests of the trace's model and view.

mod model;
mod view;
