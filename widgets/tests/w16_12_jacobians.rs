//! Tests of the four solvers' model and view.

mod model;
mod view;
