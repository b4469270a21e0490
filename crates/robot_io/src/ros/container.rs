//! What a file of recorded messages yields, whatever its format.

use std::io;

use super::bag_file::Connections;
use super::mcap_file::Records;
use super::wire::Wire;

/// Longer records, and chunks that unpack to more, are no recording of a robot's laser.
pub const MOST_BYTES: usize = 1 << 28;

/// One message as it was recorded.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Where it was published.
    pub topic: String,
    /// Its type as `package/Name`.
    pub kind: String,
    /// How its fields are written.
    pub wire: Wire,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// When it was recorded, s.
    pub recorded_s: f64,
}

/// Why a container ends early.
#[derive(Debug)]
pub enum ContainerError {
    /// The system could not give its bytes.
    Io(io::Error),
    /// The file ends in the middle of a record.
    CutOff(String),
    /// A record is not what it has to be.
    Broken(String),
    /// The same, and the next call goes on behind it.
    Skipped(String),
}

impl ContainerError {
    /// Whether messages may follow.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::Skipped(_))
    }
}

/// The topics of a file by their numbers, which may be announced again at its end.
#[derive(Clone, Debug)]
pub enum Announced {
    /// Of an MCAP file.
    Mcap(Records),
    /// Of a bag.
    Bag(Connections),
}

/// Messages in the order of the file.
pub trait Container {
    /// The next message; none at the end.
    ///
    /// # Errors
    /// Where a part or the rest cannot be read. Nothing comes after an error but
    /// [`ContainerError::Skipped`].
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError>;

    /// Bytes read so far: where an error is.
    fn offset(&self) -> u64;

    /// The topics that are known now, if messages were lost because their topic was not known before.
    fn announced(&self) -> Option<Announced> {
        None
    }

    /// What stands in the file in place of messages of ROS; none where it has such messages or nothing.
    fn instead(&self) -> Option<String> {
        None
    }
}

/// `package/Name` of a type: ROS 2 writes `package/msg/Name`.
pub fn kind_of(name: &str) -> String {
    name.replace("/msg/", "/")
}
