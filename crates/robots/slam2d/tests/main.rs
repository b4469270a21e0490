//! Tests of the command line: one binary, one module for each kind of call.

mod commands;
mod corridor;
mod doctor;
mod field_files;
mod files;
mod logs;
mod optimize;
mod recordings;
mod sessions;
mod simulated;
mod support;
