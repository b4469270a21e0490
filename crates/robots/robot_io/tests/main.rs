//! Tests of the readers and the evaluation on files.

mod evo;
mod recorded;
mod verdicts;
