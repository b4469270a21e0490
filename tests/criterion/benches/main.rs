//! What criterion times: `cargo bench -- FILTER`, where the filter is a part of a name.
//!
//! One program for all: each would be linked with all widgets, and the suite compiles them to see that they do.

mod lap;
mod registration;
mod solve;
mod workloads;

use criterion::{criterion_group, criterion_main};

criterion_group!(
    benches,
    workloads::all,
    registration::register,
    registration::maps,
    registration::corridor,
    lap::parts,
    lap::cold_solve,
    solve::parts_of_an_iteration,
    solve::whole_solves,
);
criterion_main!(benches);
