//! The worker of w16.10: maps a robot's log piece by piece beside the page.
//!
//! It is a separate module without egui, which the page fetches when a reader opens a log. [`engine`] reads
//! the file on demand, drives the estimator and executes orders; changes go to the widget as [`update`]s,
//! plain numbers and text. [`input`] is the reader's input, [`links`] are the loops with their evidence and
//! verdict, [`editing`] builds a graph of them, [`picture`] paints the map, [`grade`] compares with a
//! reference, [`other_log`] localizes the robot of another log on the map, [`files`] writes the saved
//! files, and [`sample`] contains the logs of the page.
//!
//! All of it is plain Rust and tested natively; the browser half passes files in and updates out.

pub mod editing;
pub mod engine;
pub mod files;
pub mod grade;
pub mod graph_log;
pub mod input;
pub mod links;
pub mod other_log;
pub mod picture;
pub mod sample;
pub mod update;

#[cfg(target_arch = "wasm32")]
mod browser;
