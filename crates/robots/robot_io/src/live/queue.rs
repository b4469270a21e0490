//! The stream between the connection and the estimator, which holds a bounded number of scans and bytes.

use std::io::{self, BufRead, ErrorKind, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

/// Most scans that wait for the estimator: 100 s at ten a second.
const MAX_SCANS: usize = 1000;
/// Most bytes that wait.
const MAX_BYTES: usize = 1 << 26;

/// What waits.
#[derive(Debug, Default)]
struct Load {
    scans: AtomicUsize,
    bytes: AtomicUsize,
}

/// The connection's end of the stream.
pub struct Feeder {
    sender: Sender<(bool, Vec<u8>)>,
    load: Arc<Load>,
}

/// The estimator's end of the stream.
pub struct Feed {
    receiver: Receiver<(bool, Vec<u8>)>,
    load: Arc<Load>,
    current: Vec<u8>,
    at: usize,
    waits: bool,
}

/// A new stream. Its reads wait for what comes next; if not `waits`, a read for which nothing has come fails with
/// [`ErrorKind::WouldBlock`] and takes nothing.
#[must_use]
pub fn stream(waits: bool) -> (Feeder, Feed) {
    let (sender, receiver) = channel();
    let load = Arc::<Load>::default();
    let feed = Feed {
        receiver,
        load: Arc::clone(&load),
        current: Vec::new(),
        at: 0,
        waits,
    };
    (Feeder { sender, load }, feed)
}

impl Feeder {
    /// Adds what the rest depends on: the declaration of a topic, or the end.
    pub fn add(&self, bytes: Vec<u8>) {
        self.load.bytes.fetch_add(bytes.len(), Ordering::Relaxed);
        // Without a reader nobody misses it.
        let _ = self.sender.send((false, bytes));
    }

    /// Adds a message unless too many scans or bytes wait; returns whether it was added.
    #[must_use]
    pub fn offer(&self, bytes: Vec<u8>, is_scan: bool) -> bool {
        let is_full = is_scan && self.load.scans.load(Ordering::Relaxed) >= MAX_SCANS;
        if is_full || self.load.bytes.load(Ordering::Relaxed) + bytes.len() > MAX_BYTES {
            return false;
        }
        let scans = usize::from(is_scan);
        self.load.scans.fetch_add(scans, Ordering::Relaxed);
        self.load.bytes.fetch_add(bytes.len(), Ordering::Relaxed);
        let _ = self.sender.send((is_scan, bytes));
        true
    }
}

impl Read for Feed {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let mut left = self.fill_buf()?;
        let count = left.read(into)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Feed {
    /// The next bytes; none follow once the connection's end is dropped.
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.at == self.current.len() {
            let next = match self.waits {
                true => self.receiver.recv().map_err(TryRecvError::from),
                false => self.receiver.try_recv(),
            };
            let (is_scan, bytes) = match next {
                Ok(next) => next,
                Err(TryRecvError::Empty) => return Err(ErrorKind::WouldBlock.into()),
                Err(TryRecvError::Disconnected) => return Ok(&[]),
            };
            let scans = usize::from(is_scan);
            self.load.scans.fetch_sub(scans, Ordering::Relaxed);
            self.load.bytes.fetch_sub(bytes.len(), Ordering::Relaxed);
            (self.current, self.at) = (bytes, 0);
        }
        Ok(&self.current[self.at..])
    }

    fn consume(&mut self, count: usize) {
        self.at += count;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_are_dropped_while_too_many_wait_and_odometry_is_not() {
        let (feeder, mut feed) = stream(true);
        assert!((0..MAX_SCANS).all(|_| feeder.offer(vec![7], true)));
        assert!(!feeder.offer(vec![7], true));
        assert!(feeder.offer(vec![8], false));
        let mut one = [0];
        feed.read_exact(&mut one).unwrap();
        assert!(feeder.offer(vec![9], true));
        drop(feeder);
        let mut rest = Vec::new();
        feed.read_to_end(&mut rest).unwrap();
        assert_eq!(rest.len(), MAX_SCANS + 1);
        assert_eq!(rest[MAX_SCANS - 1..], [8, 9]);
    }

    #[test]
    fn a_read_that_need_not_wait_says_so_until_the_end() {
        let (feeder, mut feed) = stream(false);
        let mut one = [0];
        let failed = feed.read_exact(&mut one).unwrap_err();
        assert_eq!(failed.kind(), ErrorKind::WouldBlock);
        assert!(feeder.offer(vec![7], true));
        feed.read_exact(&mut one).unwrap();
        drop(feeder);
        assert_eq!((one, feed.read(&mut one).unwrap()), ([7], 0));
    }

    #[test]
    fn bytes_that_wait_are_bounded_whatever_they_are() {
        let (feeder, _feed) = stream(true);
        let large = || vec![0; MAX_BYTES / 2];
        assert!(feeder.offer(large(), false) && feeder.offer(large(), false));
        assert!(!feeder.offer(vec![0], false));
    }
}
