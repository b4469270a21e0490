//! `states NAME`: state and results of a widget after each of its presets, computed natively.
//!
//! The test in Node compares this text with what the same code says as WebAssembly.

use slam_web::{registry, state};

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    let found = registry::WIDGETS.iter().find(|(known, _)| *known == name);
    let Some((_, maker)) = found else {
        eprintln!("states takes one of {}", registry::names());
        std::process::exit(2);
    };
    print!("{}", state::after_each_preset(*maker));
}
