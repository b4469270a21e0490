//! The trace's rules and its view.

mod model;
mod view;
