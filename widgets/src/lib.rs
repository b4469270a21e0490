//! The widgets of the chapter, a module each, and their [`registry`].
//!
//! Each module has the same parts: `spec` contains the texts and the parameters, `model` the logic, `view`
//! the layout.

mod from_modules;
mod icp_variant;
mod loop_arc;
mod pose_handle;
mod reader_orders;
pub mod registry;
mod sweep_bounds;
mod xy;

pub mod w16_10_own_robot;
pub mod w16_11_procrustes;
pub mod w16_12_jacobians;
pub mod w16_1_basin_explorer;
pub mod w16_2_full_lap;
pub mod w16_3_cost_terraces;
pub mod w16_4_control_room;
pub mod w16_5_pose_graph_toy;
pub mod w16_6_whole_window;
pub mod w16_7_place_recognition;
pub mod w16_8_moving_box;
pub mod w16_9_relocalization;
