//! The experiments together with what they judge: one binary, one module for each.

mod exact_gate;
mod icp_laws;
mod plane_step;
mod random_laps;
mod terrain_rows;
