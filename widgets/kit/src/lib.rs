//! What the widgets share.
//!
//! The half without egui is what a widget's `model.rs` speaks: [`param`], [`spec`], [`model`],
//! [`scene`], [`chart`], [`playback`], [`run`], [`palette`]. Nothing in it may use the other half: the models are
//! tested headless.
//!
//! The other half draws. [`draw`] puts a scene on any [`surface::Surface`], of which there are
//! two, [`egui_surface`] for the live picture and [`svg`] for the static one. [`shell`] adds the
//! words, the [`controls`], the [`transport`] bar and the [`readout`], and handles the
//! [`pointer`]; [`desktop`] opens it as a window.

pub mod chart;
pub mod model;
pub mod palette;
pub mod param;
pub mod playback;
pub mod run;
pub mod scene;
pub mod spec;

pub mod audit;
pub mod draw;
pub mod layout;
pub mod picture;
pub mod surface;
pub mod svg;
pub mod ticks;
pub mod transform;
pub mod view;
pub mod zoom;

pub mod controls;
#[cfg(not(target_arch = "wasm32"))]
pub mod desktop;
pub mod egui_surface;
pub mod hot;
pub mod pointer;
pub mod readout;
pub mod shell;
pub mod style;
pub mod transport;
