//! Tests of the command line: one binary, one module for each kind of call.

mod commands;
mod dask;
mod estimators;
mod shards;
mod support;
mod worlds;
