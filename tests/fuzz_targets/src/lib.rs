//! Every target from outside, as a function that takes any bytes and panics where a promise breaks.
//!
//! The fuzzer in `fuzz/` drives these functions with inputs that it makes up. What it found worth
//! keeping lies in `fuzz/corpus` and `fuzz/found`, and the tests of this package replay it.

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

/// A target: takes any bytes, and panics where the code behind it breaks a promise.
pub type Door = fn(&[u8]);

/// Every target with the name of its fuzz target.
pub const TARGETS: [(&str, Door); 11] = [
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
