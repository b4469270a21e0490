//! The worker of w16.10: a robot's log, mapped piece by piece beside the page.
//!
//! A module of its own, without egui, which is fetched when a reader opens a log. [`engine`] reads the
//! file as it is asked for, drives the estimator and answers orders; what changed goes to the widget as
//! [`update`]s, plain numbers and text. [`given`] is what the reader gives it. [`links`] are the loops with their evidence and verdict,
//! [`editing`] makes a graph of them, [`picture`] paints the map, [`grade`] compares with a reference,
//! [`whereabouts`] looks for the robot of another log on the map, [`files`] writes what the reader saves,
//! and [`sample`] holds the logs that stand on the page.
//!
//! All of it is plain Rust and tested natively; the browser half hands a file in and updates out.

pub mod editing;
pub mod engine;
pub mod files;
pub mod given;
pub mod grade;
pub mod graph_log;
pub mod links;
pub mod picture;
pub mod sample;
pub mod update;
pub mod whereabouts;

#[cfg(target_arch = "wasm32")]
mod browser;
