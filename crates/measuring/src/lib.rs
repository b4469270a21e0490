//! What the programs that check and measure share: a clock of the thread's own time, the list of what
//! a run skipped, and the blocks of a page that a command writes.

pub mod cpu_clock;
pub mod generated;
pub mod process;
pub mod skip;

pub use cpu_clock::{CpuClock, timed};
