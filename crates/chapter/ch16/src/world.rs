//! `--world`: a built-in world, or a file with walls, start and waypoints.

use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use ch16_lab::lap::{BuiltInWorld, NamedChoice};
use pr_sim::Course;

use command_line::in_file::InFile as _;

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
                let known = BuiltInWorld::all().map(|world| world.name());
                let known = known.collect::<Vec<_>>().join(", ");
                Err(format!("expected {known} or a .json file"))
            }
        }
    }
}

impl WorldArg {
    /// The world and the path through it.
    ///
    /// # Errors
    /// If the file cannot be used.
    pub fn course(&self) -> anyhow::Result<Course> {
        let file = match self {
            Self::BuiltIn(world) => return Ok(world.course()),
            Self::File(file) => file,
        };
        let text = fs::read(file).in_file(file)?;
        Course::from_json(&text).in_file(file)
    }
}
