//! Names the file in an error.

use std::fmt::Display;
use std::path::Path;

use anyhow::anyhow;

/// The result of work on a file.
pub trait InFile<T> {
    /// Puts the file's path before the message of an error.
    ///
    /// # Errors
    /// The error of the work.
    fn in_file(self, path: &Path) -> anyhow::Result<T>;
}

impl<T, E: Display> InFile<T> for Result<T, E> {
    fn in_file(self, path: &Path) -> anyhow::Result<T> {
        self.map_err(|error| anyhow!("{}: {error}", path.display()))
    }
}
