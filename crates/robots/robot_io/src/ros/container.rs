//! Interface of a file of recorded messages, for all formats.

use std::io;

use super::wire::Wire;

/// Longer records, and chunks that decompress to more, are not from a robot's laser.
pub const MAX_BYTES: usize = 1 << 28;

/// A recorded message.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Topic.
    pub topic: String,
    /// Type as `package/Name`.
    pub kind: String,
    /// Serialization of its fields.
    pub wire: Wire,
    /// Serialized bytes.
    pub bytes: Vec<u8>,
    /// Time of recording, s.
    pub recorded_s: f64,
}

/// An error of a container.
#[derive(Debug)]
pub enum ContainerError {
    /// The bytes could not be read.
    Io(io::Error),
    /// The file ends within a record.
    CutOff(String),
    /// A record is malformed, and the rest cannot be read.
    Broken(String),
    /// A record is malformed, and reading continues after it.
    Skipped(String),
}

impl ContainerError {
    /// Whether messages may follow.
    pub fn is_recoverable(&self) -> bool {
        matches!(self, Self::Skipped(_))
    }
}

/// A reader of messages in the order of the file.
pub trait Container {
    /// Returns the next message; `None` at the end.
    ///
    /// # Errors
    /// If a part or the rest cannot be read. No message follows an error other than
    /// [`ContainerError::Skipped`].
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError>;

    /// Bytes read so far: the position of an error.
    fn offset(&self) -> u64;

    /// What the file contains instead of ROS messages; `None` if it has ROS messages or none at all.
    fn instead(&self) -> Option<String> {
        None
    }
}

/// `package/Name` of a type; ROS 2 writes `package/msg/Name`.
pub fn kind_of(name: &str) -> String {
    name.replace("/msg/", "/")
}
