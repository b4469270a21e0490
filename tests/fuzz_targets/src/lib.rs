//! Every fuzz target as a function that takes any bytes and panics if a guarantee is violated.
//!
//! The fuzzer in `fuzz/` calls these functions with generated inputs. `fuzz/corpus` and `fuzz/found` contain
//! the inputs worth keeping, and the tests of this package replay them.

pub mod clouds;
pub mod databases;
pub mod files;
pub mod g2o;
pub mod graphs;
pub mod hands;
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

/// A target: takes any bytes, and panics if the code violates a guarantee.
pub type FuzzTarget = fn(&[u8]);

/// Every target with the name of its fuzz target.
pub const TARGETS: [(&str, FuzzTarget); 11] = [
    ("links", links::fuzz),
    ("messages", messages::fuzz),
    ("g2o", g2o::fuzz),
    ("clouds", clouds::fuzz),
    ("files", files::fuzz),
    ("logs", logs::fuzz),
    ("databases", databases::fuzz),
    ("sessions", sessions::fuzz),
    ("graphs", graphs::fuzz),
    ("registration", registration::fuzz),
    ("hands", hands::fuzz),
];
