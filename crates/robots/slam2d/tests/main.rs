//! Tests of the command line: one binary, one module for each kind of call.

mod commands;
mod dask;
mod doctor;
mod estimators;
mod field_files;
mod files;
mod logs;
mod mark;
mod optimize;
mod recordings;
mod sessions;
mod shards;
mod support;
mod worlds;
