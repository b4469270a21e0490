//! `--world`: a built-in world, or a file with walls, start and way points.

use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use ch16_lab::lap::{BuiltInWorld, Choice};
use pr_sim::{Course, CourseError};
use thiserror::Error;

/// A world on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WorldArg {
    /// A built-in world.
    BuiltIn(BuiltInWorld),
    /// A custom world file.
    File(PathBuf),
}

impl FromStr for WorldArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match BuiltInWorld::named(text) {
            Some(world) => Ok(Self::BuiltIn(world)),
            None if text.ends_with(".json") => Ok(Self::File(text.into())),
            None => {
                let known = BuiltInWorld::ALL.iter().map(|world| world.name());
                let known = known.collect::<Vec<_>>().join(", ");
                Err(format!("expected {known} or a .json file"))
            }
        }
    }
}

/// Why a world cannot be used.
#[derive(Debug, Error)]
pub enum WorldError {
    /// The system cannot read it.
    #[error("{path}: {source}")]
    Read {
        /// The file.
        path: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// The file is not a valid course.
    #[error("{path}: {source}")]
    Course {
        /// The file.
        path: String,
        /// The problem, its position and what to do.
        source: CourseError,
    },
}

impl WorldArg {
    /// The world and the path through it.
    ///
    /// # Errors
    /// If the file cannot be used.
    pub fn course(&self) -> Result<Course, WorldError> {
        let file = match self {
            Self::BuiltIn(world) => return Ok(world.course()),
            Self::File(file) => file,
        };
        let path = || file.display().to_string();
        let text = fs::read(file).map_err(|source| WorldError::Read {
            path: path(),
            source,
        })?;
        Course::from_json(&text).map_err(|source| WorldError::Course {
            path: path(),
            source,
        })
    }
}
