//! Tests of the search's model and view.

mod model;
