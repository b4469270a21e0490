//! Files that are committed and written by the build: does the build still write what was committed?

use std::fs;
use std::path::PathBuf;

use crate::run::{Failure, root};

/// The types of the element and the tables of parameters. The README's table of sizes is no part
/// of it: compressed sizes change with the version of Node, as its zlib and brotli do.
const WRITTEN_BY_THE_BUILD: [&str; 2] = ["web/slam-widget.d.ts", "docs/parameters.md"];

/// What a stale file means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strictness {
    /// It is named: whoever changed the parameters commits what was written anew.
    Tell,
    /// It fails the run: what was committed is not what the sources say.
    Fail,
}

impl Strictness {
    /// Strict where CI is set to something other than `false`, as build machines do.
    pub fn of_this_run() -> Self {
        Self::from_ci(std::env::var("CI").ok().as_deref())
    }

    fn from_ci(value: Option<&str>) -> Self {
        match value {
            None | Some("" | "0" | "false") => Self::Tell,
            Some(_) => Self::Fail,
        }
    }
}

/// The files as they are before a build.
pub struct Committed {
    before: Vec<(PathBuf, Option<Vec<u8>>)>,
}

impl Committed {
    /// Reads the files.
    pub fn read() -> Self {
        Self::of(WRITTEN_BY_THE_BUILD.map(|name| root().join(name)))
    }

    fn of(paths: impl IntoIterator<Item = PathBuf>) -> Self {
        let read = |path: PathBuf| {
            let content = fs::read(&path).ok();
            (path, content)
        };
        Self {
            before: paths.into_iter().map(read).collect(),
        }
    }

    /// Compares the files with what a build has left.
    ///
    /// # Errors
    /// One line that names the stale files, where the run is strict.
    pub fn compare(&self, strictness: Strictness) -> Result<(), Failure> {
        let root = root();
        let stale: Vec<_> = self
            .before
            .iter()
            .filter(|(path, before)| fs::read(path).ok() != *before)
            .map(|(path, _)| path.strip_prefix(&root).unwrap_or(path).to_string_lossy())
            .collect();
        if stale.is_empty() {
            return Ok(());
        }
        let message = format!(
            "{}: the build wrote it anew, because its text was not what the sources say; \
             commit what `cargo xtask build` writes",
            stale.join(", ")
        );
        match strictness {
            Strictness::Fail => Err(Failure::new(message)),
            Strictness::Tell => {
                println!("{message}");
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_are_there() {
        for (path, content) in Committed::read().before {
            assert!(content.is_some(), "{}", path.display());
        }
    }

    #[test]
    fn a_file_that_the_build_changed_fails_a_strict_run_and_no_other() {
        let path = root().join(format!("target/xtask-stale-{}", std::process::id()));
        fs::create_dir_all(root().join("target")).unwrap();
        fs::write(&path, "committed").unwrap();
        let committed = Committed::of([path.clone()]);
        let unchanged = committed.compare(Strictness::Fail);
        fs::write(&path, "built").unwrap();
        let strict = committed.compare(Strictness::Fail);
        let told = committed.compare(Strictness::Tell);
        fs::remove_file(&path).unwrap();
        assert!(unchanged.is_ok() && told.is_ok());
        let message = strict.unwrap_err().to_string();
        assert!(message.starts_with("target/xtask-stale-"), "{message}");
        assert_eq!(message.lines().count(), 1);
    }

    #[test]
    fn build_machines_are_strict() {
        for set in ["true", "1", "yes"] {
            assert_eq!(Strictness::from_ci(Some(set)), Strictness::Fail);
        }
        for unset in [None, Some(""), Some("false"), Some("0")] {
            assert_eq!(Strictness::from_ci(unset), Strictness::Tell);
        }
    }
}
