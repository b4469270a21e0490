//! Tests of the comparison's model and view.

mod model;
