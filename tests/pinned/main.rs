//! Tests against every reference file; one binary, one module for each JSON file.

mod architecture;
mod basin;
mod graph;
mod lap;
mod ndt;
mod normals;
mod optimum;
mod page;
mod palette;
mod rng;
mod scan;
mod teaching;
mod terrain;
mod worlds;
