//! Tests of the readers and the evaluation on files.

mod evo;
mod recorded;
mod support;
mod travelling;
mod verdicts;
