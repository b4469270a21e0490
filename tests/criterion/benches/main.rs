//! The criterion benchmarks: `cargo bench -- FILTER`, where the filter is a part of a name.
//!
//! They are one program, because each program would link all widgets, and the test suite compiles them.

mod solve;
mod workloads;

use criterion::{criterion_group, criterion_main};

criterion_group!(
    benches,
    workloads::all,
    solve::parts_of_an_iteration,
    solve::whole_solves,
);
criterion_main!(benches);
