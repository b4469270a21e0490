//! Opens a widget in a window of the desktop: `cargo run -p slam_desktop w16.1`.
//!
//! This program replaces the page as host, so features that need a browser are missing: w16.10 reads no log
//! here.

mod panel;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn asked_for(words: &[&str]) -> Result<&'static str, String> {
        let shell = named(words.iter().map(|word| (*word).to_owned()))?;
        Ok(shell.model().spec().id)
    }

    #[test]
    fn a_widget_is_opened_by_its_name_and_an_unknown_one_lists_the_names() {
        assert_eq!(asked_for(&["w16.11"]), Ok("w16.11"));
        let rejected = asked_for(&["w16.99"]).unwrap_err();
        assert!(
            rejected.starts_with("there is no widget `w16.99`; there are w16.1, w16.2"),
            "{rejected}"
        );
        for words in [&[][..], &["w16.1", "w16.2"]] {
            let rejected = asked_for(words).unwrap_err();
            assert!(
                rejected.starts_with("slam_desktop takes the name"),
                "{rejected}"
            );
        }
    }
}
