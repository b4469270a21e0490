//! Foxglove's WebSocket protocol over sockets: a robot that drives, and the map that is shown meanwhile.
//!
//! [`Connection`] is a socket to a robot's server, and [`Listener`] feeds what comes over it to a
//! [`Drive`](robot_io::live::drive::Drive); the page has the socket of its browser instead.
//! [`Server`] shows clients such as Foxglove the latest messages of some topics, which [`Cdr`] writes.

use std::io::{self, ErrorKind};

mod cdr;
mod connection;
mod listener;
mod server;

pub use cdr::{Cdr, nanoseconds};
pub use connection::{Address, Connection};
pub use listener::{Event, Listener};
pub use server::{Channel, Server};

/// Whether a read ended because its time was over or a signal came.
fn is_wait(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
