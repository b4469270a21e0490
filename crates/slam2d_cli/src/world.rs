//! `--world`: one of the built-in worlds, or a file.

use std::convert::Infallible;
use std::path::PathBuf;
use std::str::FromStr;

use pr_sim::{Course, CourseError};
use thiserror::Error;

/// What stands after `--world`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WorldName {
    /// The chapter's flat.
    Apartment,
    /// Corridors around a block.
    Ring,
    /// Anything else is the name of a file; a file `ring` is `./ring`.
    File(PathBuf),
}

/// Why there is no world.
#[derive(Debug, Error)]
pub enum WorldFailure {
    /// The file cannot be read.
    #[error(
        "{}: {source}: --world takes apartment, ring or the name of a file",
        path.display()
    )]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file does not describe a course.
    #[error("{}: {source}", path.display())]
    Course {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        source: CourseError,
    },
}

impl FromStr for WorldName {
    type Err = Infallible;

    fn from_str(word: &str) -> Result<Self, Infallible> {
        Ok(match word {
            "apartment" => Self::Apartment,
            "ring" => Self::Ring,
            path => Self::File(path.into()),
        })
    }
}

impl WorldName {
    /// The course of that name.
    ///
    /// # Errors
    /// Where the file cannot be read, or what it holds cannot be driven.
    pub fn course(&self) -> Result<Course, WorldFailure> {
        let path = match self {
            Self::Apartment => return Ok(Course::apartment()),
            Self::Ring => return Ok(Course::ring()),
            Self::File(path) => path.clone(),
        };
        let text = match std::fs::read(&path) {
            Ok(text) => text,
            Err(source) => return Err(WorldFailure::File { path, source }),
        };
        Course::from_json(&text).map_err(|source| WorldFailure::Course { path, source })
    }
}
