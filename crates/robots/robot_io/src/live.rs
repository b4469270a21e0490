//! A robot that drives, heard over a network: what the command and the page share.
//!
//! [`protocol`] has the messages of Foxglove's WebSocket protocol, [`drive`] subscribes to what is read, records it and
//! passes it on, [`queue`] is the stream from there to [`LogFormat::open_live`](crate::log_format::LogFormat::open_live),
//! and [`network`] has the sentences on what a network does. The connection itself is the host's.

pub mod drive;
pub mod network;
pub mod protocol;
pub mod queue;

/// How long to wait for the first scan, and for a lost connection, s, unless the user says otherwise.
pub const WAIT_S: f64 = 30.0;
/// Longest message that is taken, bytes: a cloud of a million points.
pub const MAX_MESSAGE: usize = 1 << 25;
/// Name of the recording of a drive.
pub const RECORDING: &str = "recording.mcap";
