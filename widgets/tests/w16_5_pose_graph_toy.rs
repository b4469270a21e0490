//! Tests of the toy's model and view.

mod model;
