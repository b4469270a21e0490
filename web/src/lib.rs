//! The widgets compiled to WebAssembly: one module for all, one instance of it per widget.
//!
//! [`schema`] and [`state`] write JSON about the widgets for the host page; [`story`] and [`outcomes`] run laps for the
//! pictures that the page draws itself, [`candidates`] are loops for the reader to judge, and [`matcher`] runs ICP from
//! where the reader left a sweep. All of it is plain Rust and tested natively. The browser half adapts a widget to eframe
//! and to JavaScript; the code of the host page is in `web/ts`.

pub mod candidates;
pub mod matcher;
pub mod outcomes;
pub mod schema;
pub mod state;
pub mod story;

#[cfg(target_arch = "wasm32")]
mod app;
#[cfg(target_arch = "wasm32")]
mod fonts;
#[cfg(target_arch = "wasm32")]
mod handle;
#[cfg(target_arch = "wasm32")]
mod questions;
