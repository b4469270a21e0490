//! `states NAME`: state and results of a widget after each of its presets, computed natively.
//!
//! The test in Node compares this text with that of the same code in WebAssembly.

use slam_web::state;
use widgets::registry;

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    match registry::find(&name) {
        Ok(maker) => print!("{}", state::after_each_preset(maker)),
        Err(problem) => {
            eprintln!("{problem}");
            std::process::exit(2);
        }
    }
}
