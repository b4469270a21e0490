//! Integration tests of the experiments: one binary, one module for each.

mod any_sensor;
mod edge_information;
mod exact_gate;
mod heading_errors;
mod icp_laws;
mod incremental;
mod laps;
mod local_map;
mod localize;
mod map;
mod path_errors;
mod pending_loops;
mod plane_step;
mod random_laps;
mod ring;
mod sweeps;
mod terrain_rows;
mod turned_frame;
mod window_search;
