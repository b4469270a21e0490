//! Integration tests of the widgets: requirements for all of them, and the rules of each one. One binary.

mod conformance;
mod side_panel;
mod support;
mod w16_10_own_robot;
mod w16_11_procrustes;
mod w16_12_jacobians;
mod w16_1_basin_explorer;
mod w16_2_full_lap;
mod w16_3_cost_terraces;
mod w16_4_control_room;
mod w16_5_pose_graph_toy;
mod w16_6_whole_window;
mod w16_7_place_recognition;
mod w16_8_moving_box;
mod w16_9_relocalization;
mod your_code;
