//! Logs of lines in the order of time, with stamps that were mended.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::io;

use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::log_bytes::LogBytes;
use crate::remark::Remark;
use crate::stamps::MendedStamps;

/// A frame waits for so many others at most that stand after it and were taken before it.
const MOST_WAITING: usize = 1024;

/// A frame under its time, in an order that whole numbers have.
type Key = (u64, usize);

/// Frames whose stamps were mended by a pass over all of the log.
struct Restamped<R> {
    inner: R,
    stamps_s: Vec<f64>,
    said: Vec<Remark>,
    /// Earliest stamp of any frame after this one, s.
    earliest_after_s: Vec<f64>,
    waiting: BTreeMap<Reverse<Key>, LogFrame>,
    read: usize,
    is_done: bool,
    notes: LogNotes,
}

/// A reader of a log of lines: as it is where its stamps are in order, else with stamps that are.
///
/// # Errors
/// What the system says.
pub fn restamped<'a, R: LogReader + 'a>(
    bytes: &LogBytes<'a>,
    reader: impl Fn(Box<dyn io::BufRead + 'a>) -> R,
) -> io::Result<Box<dyn LogReader + 'a>> {
    let mut first = reader(bytes.stream()?);
    let mut stamps_s = Vec::new();
    // What goes wrong here goes wrong again, and is told then.
    while let Ok(Some(frame)) = first.next_frame() {
        stamps_s.push(frame.stamp_s);
    }
    let inner = reader(bytes.stream()?);
    // A log may count its frames from 0, which is a stamp here.
    let least_s = stamps_s.iter().copied().fold(f64::INFINITY, f64::min);
    let moved: Vec<f64> = stamps_s
        .iter()
        .map(|stamp_s| stamp_s - least_s + 1.0)
        .collect();
    let is_late = |two: &[f64]| two[1] <= two[0];
    if !moved.windows(2).any(is_late) {
        return Ok(Box::new(inner));
    }
    let mended = MendedStamps::of(&moved, &[]);
    if mended.is_unchanged() && mended.swapped == 0 {
        return Ok(Box::new(inner));
    }
    let stamps_s: Vec<f64> = mended
        .stamps_s
        .iter()
        .map(|stamp_s| stamp_s + least_s - 1.0)
        .collect();
    let mut earliest_s = f64::INFINITY;
    let mut earliest_after_s: Vec<f64> = stamps_s
        .iter()
        .rev()
        .map(|&stamp_s| {
            let after_s = earliest_s;
            earliest_s = earliest_s.min(stamp_s);
            after_s
        })
        .collect();
    earliest_after_s.reverse();
    Ok(Box::new(Restamped {
        inner,
        said: mended.remarks("scans"),
        stamps_s,
        earliest_after_s,
        waiting: BTreeMap::new(),
        read: 0,
        is_done: false,
        notes: LogNotes::default(),
    }))
}

impl<R: LogReader> LogReader for Restamped<R> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            let bound_s = match self.read {
                _ if self.is_done => f64::INFINITY,
                0 => f64::NEG_INFINITY,
                read => self
                    .earliest_after_s
                    .get(read - 1)
                    .copied()
                    .unwrap_or(f64::INFINITY),
            };
            let is_full = self.waiting.len() > MOST_WAITING;
            if let Some(first) = self.waiting.last_entry()
                && (is_full || self.is_done || first.get().stamp_s <= bound_s)
            {
                return Ok(Some(first.remove()));
            }
            if self.is_done {
                return Ok(None);
            }
            let frame = self.inner.next_frame();
            self.notes.clone_from(self.inner.notes());
            self.notes.warnings.extend(self.said.iter().cloned());
            match frame? {
                Some(mut frame) => {
                    if let Some(&stamp_s) = self.stamps_s.get(self.read) {
                        frame.stamp_s = stamp_s;
                    }
                    self.waiting
                        .insert(Reverse((ordered(frame.stamp_s), self.read)), frame);
                    self.read += 1;
                }
                None => self.is_done = true,
            }
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

/// The bits of a finite number as a whole number in the same order.
fn ordered(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 0 {
        bits | 1 << 63
    } else {
        !bits
    }
}

#[cfg(test)]
mod tests {
    use crate::carmen::CarmenReader;

    use super::*;

    fn stamps(text: &str) -> (Vec<f64>, Vec<Remark>) {
        let bytes = LogBytes::from(text.as_bytes().to_vec());
        let mut reader = restamped(&bytes, |source| CarmenReader::new(source, "x.clf")).unwrap();
        let mut stamps = Vec::new();
        while let Some(frame) = reader.next_frame().unwrap() {
            stamps.push(frame.stamp_s);
        }
        (stamps, reader.notes().warnings.clone())
    }

    fn log(stamps: impl Iterator<Item = f64>) -> String {
        stamps
            .enumerate()
            .map(|(k, stamp_s)| {
                let x = 0.1 * k as f64;
                format!("FLASER 3 1 1 1 {x} 0 0 {x} 0 0 {stamp_s} h {stamp_s}\n")
            })
            .collect()
    }

    #[test]
    fn frames_come_in_the_order_of_time_whatever_their_clock_did() {
        let good: Vec<f64> = (0..40).map(f64::from).collect();
        assert_eq!(stamps(&log(good.iter().copied())).0.len(), 40);
        let swapped = good.chunks(2).flat_map(|two| [two[1] + 5.0, two[0] + 5.0]);
        let (found, said) = stamps(&log(swapped));
        assert!(found.windows(2).all(|two| two[0] < two[1]) && found.len() == 40);
        assert!(said[0].text.contains("sorted by stamp"), "{said:?}");
        let reset = good.iter().map(|stamp_s| {
            if *stamp_s < 20.0 {
                stamp_s + 100.0
            } else {
                stamp_s - 19.0
            }
        });
        let (found, said) = stamps(&log(reset));
        assert!(found.windows(2).all(|two| two[0] < two[1]) && found.len() == 40);
        assert!(said[0].text.contains("steps back"), "{said:?}");
    }
}
