//! Errors of reading a session.

use std::io;

use thiserror::Error;

use super::VERSION;

/// Why a session cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SessionError {
    /// The bytes could not be read.
    #[error("{name}: {source}")]
    Io {
        /// The file's name.
        name: String,
        /// The system's error.
        source: io::Error,
    },
    /// The file is empty.
    #[error("{name} is empty; give a session, as slam2d run LOG -o DIR writes one")]
    Empty {
        /// The file's name.
        name: String,
    },
    /// The file does not begin with the magic.
    #[error(
        "{name} is not a session: it does not begin with SLAM2D; give one that slam2d run LOG -o DIR wrote"
    )]
    Foreign {
        /// The file's name.
        name: String,
    },
    /// The version of the format is not supported.
    #[error(
        "{name} is a session of version {version}, but this program reads version {VERSION}; use the program that wrote it, or run the log again"
    )]
    Version {
        /// The file's name.
        name: String,
        /// Its version.
        version: u32,
    },
    /// The file is truncated.
    #[error("{name} ends at byte {has} of {needs}; copy it again, or run the log again")]
    CutOff {
        /// The file's name.
        name: String,
        /// Bytes present.
        has: usize,
        /// Bytes that the header states.
        needs: u64,
    },
    /// Bytes follow the session.
    #[error("{name} continues after its end at byte {end}; copy it again, or run the log again")]
    Longer {
        /// The file's name.
        name: String,
        /// Stated end.
        end: u64,
    },
    /// The file is larger than any session.
    #[error(
        "{name} is larger than 512 MB, more than any session; give one that slam2d run LOG -o DIR wrote"
    )]
    TooLarge {
        /// The file's name.
        name: String,
    },
    /// The checksum does not match.
    #[error("{name} is damaged: its checksum does not match; copy it again, or run the log again")]
    Damaged {
        /// The file's name.
        name: String,
    },
    /// The content is invalid although the checksum matches.
    #[error("{name}: {problem}; run the log again")]
    Content {
        /// The file's name.
        name: String,
        /// What is invalid or inconsistent.
        problem: String,
    },
}
