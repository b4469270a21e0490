//! What a run left out: tests append lines to one file, and the suite prints them at its end.
//!
//! The protocol, for tests in any language: where `SLAM_NO_SKIP` is set to anything but nothing, `0` and
//! `false`, a test that would skip fails; else it appends one line, `name: reason`, to the file that
//! `SLAM_SKIPPED` names, where it names one.

use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::run::{Failure, root};

/// The file that the tests of this run write to.
pub struct SkipList {
    path: PathBuf,
}

impl SkipList {
    /// An empty list.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn begin() -> Result<Self, Failure> {
        let folder = root().join("target/xtask");
        let path = folder.join("skipped.txt");
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&path, ""))
            .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
        Ok(Self { path })
    }

    /// Tells a program where to write.
    pub fn told_to<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        command.env("SLAM_SKIPPED", &self.path)
    }
}

impl fmt::Display for SkipList {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = fs::read_to_string(&self.path).unwrap_or_default();
        formatter.write_str(&summary(&text))
    }
}

fn summary(text: &str) -> String {
    let mut lines: Vec<_> = text.lines().filter(|line| !line.is_empty()).collect();
    lines.sort_unstable();
    lines.dedup();
    if lines.is_empty() {
        return "Nothing was skipped".to_owned();
    }
    let list: String = lines.iter().map(|line| format!("\n   {line}")).collect();
    format!("Skipped (SLAM_NO_SKIP=1 makes these failures):{list}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_skipped_is_listed_once_and_in_order() {
        assert_eq!(summary("\n"), "Nothing was skipped");
        let listed = summary("b: no data\na: no valgrind\nb: no data\n");
        let expected =
            "Skipped (SLAM_NO_SKIP=1 makes these failures):\n   a: no valgrind\n   b: no data";
        assert_eq!(listed, expected);
    }
}
