//! What the widgets share.
//!
//! The half without egui is what a widget's `model.rs` speaks: [`param`], [`values`], [`spec`], [`model`],
//! [`scene`], [`chart`], [`counted`], [`layers`], [`outside`], [`playback`], [`played`], [`promises`], [`run`], [`ticks`],
//! [`palette`]. Nothing in it may use the other half: the models are tested headless.
//!
//! The other half draws, and is compiled with the feature `view`. [`draw`] puts a scene on any
//! [`surface::Surface`], of which there are two, [`egui_surface`] for the live picture and [`svg`]
//! for the static one. [`shell`] adds the words, the [`controls`], the [`transport`] bar and the
//! [`readout`], and handles the [`pointer`].

pub mod chart;
pub mod counted;
pub mod layers;
pub mod model;
pub mod outside;
pub mod palette;
pub mod param;
pub mod playback;
pub mod played;
pub mod promises;
pub mod run;
pub mod scene;
pub mod spec;
pub mod ticks;
pub mod values;

#[cfg(feature = "view")]
pub mod audit;
#[cfg(feature = "view")]
pub mod draw;
#[cfg(feature = "view")]
pub mod layout;
#[cfg(feature = "view")]
pub mod picture;
#[cfg(feature = "view")]
pub mod surface;
#[cfg(feature = "view")]
pub mod svg;
#[cfg(feature = "view")]
pub mod transform;
#[cfg(feature = "view")]
pub mod view;
#[cfg(feature = "view")]
pub mod zoom;

#[cfg(feature = "view")]
pub mod controls;
#[cfg(feature = "view")]
pub mod egui_surface;
#[cfg(feature = "view")]
pub mod hot;
#[cfg(feature = "view")]
pub mod pointer;
#[cfg(feature = "view")]
pub mod readout;
#[cfg(feature = "view")]
pub mod shell;
#[cfg(feature = "view")]
pub mod style;
#[cfg(feature = "view")]
pub mod transport;
