//! Fuzz targets: functions that take arbitrary bytes and panic if an invariant is violated.
//!
//! The fuzzer in `fuzz/` calls these functions with generated inputs. Inputs worth
//! keeping are in `fuzz/corpus` and `fuzz/found`, and the tests of this package replay them.

pub mod clouds;
pub mod databases;
pub mod files;
pub mod g2o;
pub mod graphs;
pub mod interaction;
pub mod links;
mod listener;
pub mod logs;
pub mod messages;
mod numbers;
pub mod registration;
mod runs;
mod sealed;
mod sentences;
pub mod sessions;
mod solve;
pub mod tables;

/// A fuzz target: takes arbitrary bytes, and panics if the code violates an invariant.
pub type FuzzTarget = fn(&[u8]);

/// All targets by name.
pub const TARGETS: [(&str, FuzzTarget); 12] = [
    ("links", links::fuzz),
    ("messages", messages::fuzz),
    ("g2o", g2o::fuzz),
    ("clouds", clouds::fuzz),
    ("files", files::fuzz),
    ("logs", logs::fuzz),
    ("databases", databases::fuzz),
    ("tables", tables::fuzz),
    ("sessions", sessions::fuzz),
    ("graphs", graphs::fuzz),
    ("registration", registration::fuzz),
    ("interaction", interaction::fuzz),
];
