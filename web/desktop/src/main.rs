//! Opens a widget in a window of the desktop: `cargo run -p slam_desktop w16.1`.
//!
//! This program replaces the page as host, so features that need a browser are missing: w16.10 reads no log
//! here.

mod window;

use std::process::ExitCode;

use widget_kit::shell::Shell;
use widgets::registry;

fn main() -> ExitCode {
    let shell = match named(std::env::args().skip(1)) {
        Ok(shell) => shell,
        Err(sentence) => {
            eprintln!("{sentence}");
            return ExitCode::from(2);
        }
    };
    match window::run(shell) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("no window can be opened: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The widget named on the command line.
fn named(words: impl IntoIterator<Item = String>) -> Result<Shell, String> {
    let words: Vec<String> = words.into_iter().collect();
    let [name] = words.as_slice() else {
        let names = registry::names();
        return Err(format!("slam_desktop takes the name of a widget: {names}"));
    };
    registry::find(name).map(|make| make())
}
