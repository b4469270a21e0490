//! The infrastructure that the widgets share.
//!
//! The half without egui is for a widget's `model.rs`: [`param`], [`values`], [`spec`], [`model`], [`scene`],
//! [`chart`], [`controls`], [`plural`], [`disclosure`], [`host_messages`], [`playback`], [`playback_param`], [`invariants`],
//! [`run`], [`ticks`], [`timeline`], [`palette`]. It must not use the other half, because the models are tested headless.
//!
//! The other half draws, with the feature `view`. [`draw`] renders a scene on any [`surface::Surface`]:
//! [`egui_surface`] for the live picture, [`svg`] for the static one. [`shell`] handles the [`pointer`]. Texts and controls
//! are the host's; [`side_panel`] is for a host without a page.

pub mod chart;
pub mod controls;
pub mod disclosure;
pub mod host_messages;
pub mod invariants;
pub mod model;
pub mod palette;
pub mod param;
pub mod playback;
pub mod playback_param;
pub mod plural;
pub mod run;
pub mod scene;
pub mod spec;
mod table;
pub mod ticks;
pub mod timeline;
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
pub mod egui_surface;
#[cfg(feature = "view")]
pub mod pointer;
#[cfg(feature = "view")]
pub mod shell;
#[cfg(feature = "view")]
pub mod side_panel;
