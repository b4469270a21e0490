//! The widget from outside: its model, its texts, its view. One binary, one module for each.

mod common;
mod edge;
mod fence;
mod maps;
mod model;
mod texts;
mod view;
