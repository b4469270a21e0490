//! Yields the scans of one topic in the order of their stamps, read from the file on demand.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use ch16_slam2d::scan::LaserScan;

use super::container::{Container, Recorded};
use super::plan::PlannedScans;
use super::scan_decoder::ScanDecoder;
use super::survey::named;
use crate::log::{FilePosition, LogNotes};

/// Most scans that wait for an earlier one which comes later in the file.
const MAX_WAITING: usize = 1024;

/// A scan with its stamp.
#[derive(Clone, Debug)]
pub struct StampedScan {
    /// Stamp, s.
    pub stamp_s: f64,
    /// The scan with its mounting.
    pub scan: LaserScan,
}

/// Orders a heap so that the earliest scan is on top.
struct Waiting(StampedScan);

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.stamp_s.total_cmp(&self.0.stamp_s)
    }
}

/// Reads the scans of a topic.
pub struct ScanCursor<'a> {
    container: Box<dyn Container + 'a>,
    decoder: ScanDecoder,
    /// Earliest stamp of all later messages, by message number, s.
    earliest_after_s: Vec<f64>,
    read: usize,
    waiting: BinaryHeap<Waiting>,
    is_done: bool,
}

impl<'a> ScanCursor<'a> {
    /// Creates a cursor at the first scan.
    pub fn new(
        container: Box<dyn Container + 'a>,
        scans: PlannedScans,
        heights_m: Option<(f64, f64)>,
    ) -> Self {
        let mut earliest_s = f64::INFINITY;
        let mut earliest_after_s: Vec<f64> = scans
            .stamps_s
            .iter()
            .rev()
            .map(|stamp_s| {
                let after_s = earliest_s;
                earliest_s = earliest_s.min(*stamp_s);
                after_s
            })
            .collect();
        earliest_after_s.reverse();
        Self {
            container,
            decoder: ScanDecoder::new(scans, heights_m),
            earliest_after_s,
            read: 0,
            waiting: BinaryHeap::new(),
            is_done: false,
        }
    }

    /// The topic with the stamps of its scans.
    pub fn scans(&self) -> &PlannedScans {
        self.decoder.scans()
    }

    /// Bytes read so far.
    pub fn offset(&self) -> u64 {
        self.container.offset()
    }

    /// Problems in the fields of scans so far.
    pub fn remarks(&self) -> &[String] {
        self.decoder.remarks()
    }

    /// Returns the next scan in the order of time; `None` at the end.
    pub fn next(&mut self, notes: &mut LogNotes) -> Option<StampedScan> {
        loop {
            let bound_s = match self.read.checked_sub(1) {
                Some(last) if !self.is_done => self.earliest_after_s.get(last).copied(),
                Some(_) => Some(f64::INFINITY),
                None => Some(f64::NEG_INFINITY),
            };
            let bound_s = bound_s.unwrap_or(f64::INFINITY);
            let is_ready = self.waiting.peek().is_some_and(|first| {
                first.0.stamp_s <= bound_s || self.is_done || self.waiting.len() > MAX_WAITING
            });
            if is_ready {
                return self.waiting.pop().map(|first| first.0);
            }
            if self.is_done {
                return None;
            }
            match self.container.next_message() {
                Ok(Some(message)) => self.add(&message, notes),
                // The survey has reported the damage already.
                Err(error) if error.is_recoverable() => {}
                Ok(None) | Err(_) => self.is_done = true,
            }
        }
    }

    fn add(&mut self, message: &Recorded, notes: &mut LogNotes) {
        let Some(scan) = self.decoder.read(message) else {
            return;
        };
        let number = self.read;
        self.read += 1;
        match scan {
            Ok(scan) => {
                let stamp_s = self
                    .scans()
                    .stamps_s
                    .get(number)
                    .copied()
                    .unwrap_or(f64::NAN);
                if stamp_s.is_finite() {
                    self.waiting.push(Waiting(StampedScan { stamp_s, scan }));
                }
            }
            Err(problem) => {
                let position = FilePosition::Byte(self.container.offset());
                notes.skip(position, named(message, problem));
            }
        }
    }
}
