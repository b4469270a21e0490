//! Why a session cannot be used.

use std::io;

use thiserror::Error;

use super::VERSION;

/// Why a session cannot be used, in one sentence.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The system could not give its bytes.
    #[error("{name}: {source}")]
    Io {
        /// The file's name.
        name: String,
        /// What the system says.
        source: io::Error,
    },
    /// There is nothing in it.
    #[error("{name} is empty; give a session, as slam2d run LOG -o DIR writes one")]
    Empty {
        /// The file's name.
        name: String,
    },
    /// It does not begin as a session does.
    #[error(
        "{name} is no session: it does not begin with SLAM2D; give one that slam2d run LOG -o DIR wrote"
    )]
    Foreign {
        /// The file's name.
        name: String,
    },
    /// Another version of the format.
    #[error(
        "{name} is a session of version {version}, and this program reads version {VERSION}; use the program that wrote it, or run the log again"
    )]
    Version {
        /// The file's name.
        name: String,
        /// Its version.
        version: u32,
    },
    /// Bytes are missing at its end.
    #[error("{name} ends at byte {has} of {needs}; copy it again, or run the log again")]
    CutOff {
        /// The file's name.
        name: String,
        /// Bytes that are there.
        has: usize,
        /// Bytes that it says it has.
        needs: u64,
    },
    /// Something follows it.
    #[error("{name} goes on after its end at byte {end}; copy it again, or run the log again")]
    Longer {
        /// The file's name.
        name: String,
        /// Where it should end.
        end: u64,
    },
    /// No session is so large.
    #[error(
        "{name} is larger than 512 MB, which no session is; give one that slam2d run LOG -o DIR wrote"
    )]
    TooLarge {
        /// The file's name.
        name: String,
    },
    /// The checksum is another one.
    #[error("{name} is damaged: its checksum does not fit; copy it again, or run the log again")]
    Damaged {
        /// The file's name.
        name: String,
    },
    /// Bytes that nobody wrote, with a checksum that fits.
    #[error("{name}: byte {byte}: {expected}; run the log again")]
    Content {
        /// The file's name.
        name: String,
        /// Where.
        byte: usize,
        /// What was expected, and what stands there.
        expected: String,
    },
    /// Its parts do not fit together.
    #[error("{name}: {problem}; run the log again")]
    Contradiction {
        /// The file's name.
        name: String,
        /// What does not fit.
        problem: String,
    },
}
