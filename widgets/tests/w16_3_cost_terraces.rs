//! The widget from outside: its model and its shell. One binary, one module for each.

mod model;
mod places;
mod shell;
