//! Tests of the localization's model and view.

mod model;
