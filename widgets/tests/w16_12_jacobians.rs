//! The rules of the four solvers and their view.

mod model;
mod view;
