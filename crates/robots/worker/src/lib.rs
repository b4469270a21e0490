//! The worker of w16.10, which maps a robot's log piece by piece in the background of the page, and the core in the worker
//! of a reader's function.
//!
//! The module has no egui and is fetched when a user opens a log, or lets a function drive a widget. [`engine`] reads
//! the file on demand, runs the estimator and executes orders; changes go out as [`update`]s: reports to the widget, and
//! what the page shows itself. [`given`] is the user's input. [`links`] are the loops with evidence and decision,
//! [`editing`] builds a graph from them, [`picture`] paints the map, [`grade`] evaluates against a reference,
//! [`localization`] localizes another log on the map, [`files`] writes what the user saves, and [`sample`] generates the
//! sample logs of the page.
//!
//! All modules but the browser interface are plain Rust and tested natively.

pub mod editing;
pub mod engine;
pub mod files;
pub mod given;
pub mod grade;
pub mod graph_log;
pub mod links;
pub mod localization;
pub mod picture;
pub mod sample;
pub mod update;

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(target_arch = "wasm32")]
mod reader_code;
