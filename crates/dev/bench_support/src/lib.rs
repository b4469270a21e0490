//! Shared by tests and benchmarks: a clock of CPU time, the list of skipped tests, and generated
//! blocks in documents.

pub mod cpu_clock;
pub mod generated;
pub mod process;
pub mod program;
pub mod skip;

pub use cpu_clock::{CpuClock, timed};
