//! Text logs in the order of time, with corrected stamps and odometry without jumps.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::io;

use pr_geom::SE2;

use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::log_bytes::LogBytes;
use crate::odometry_file::BesideOdometry;
use crate::odometry_poses::{jumps_remark, remove_jumps};
use crate::remark::{Part, Remark};
use crate::repeats::{Repeats, fingerprint};
use crate::stamps::{ClockStep, MendedStamps};

/// Most frames that wait for an earlier one which comes later in the file.
const MAX_WAITING: usize = 1024;

/// The time between two recordings in one file, s: a pause in which the robot may have been carried.
const APART_S: f64 = 60.0;

/// Stamp as an ordered integer, and number of the frame.
type Key = (u64, usize);

/// Frames whose stamps and odometry were corrected by a pass over the whole log.
struct Restamped<R> {
    inner: R,
    stamps_s: Vec<f64>,
    /// The odometry of each frame; empty if it is that of the log and does not jump.
    odometry: Vec<Option<SE2>>,
    remarks: Vec<Remark>,
    /// Whether each frame of the log repeats one before it and is left out.
    is_repeat: Vec<bool>,
    seen: usize,
    /// Earliest stamp of any frame after this one, s.
    earliest_after_s: Vec<f64>,
    waiting: BTreeMap<Reverse<Key>, LogFrame>,
    read: usize,
    is_done: bool,
    notes: LogNotes,
}

/// Opens a text log; corrects it if its stamps are out of order or its odometry jumps. The odometry is that of the file
/// beside it, if there is one.
///
/// # Errors
/// If the system cannot read the bytes, or no scan has odometry in the file beside it.
pub fn restamped<'a, R: LogReader + 'a>(
    bytes: &LogBytes<'a>,
    name: &str,
    beside: Option<&BesideOdometry>,
    reader: impl Fn(Box<dyn io::BufRead + 'a>) -> R,
) -> Result<Box<dyn LogReader + 'a>, LogError> {
    let stream = || {
        let stream = bytes.stream();
        stream.map_err(|source| LogError::at_start(name, source))
    };
    let mut first = reader(stream()?);
    let (mut stamps_s, mut odometry, mut seen) = (Vec::new(), Vec::new(), Vec::new());
    // Errors recur in the second pass and are reported there.
    while let Ok(Some(frame)) = first.next_frame() {
        stamps_s.push(frame.stamp_s);
        odometry.push(frame.odometry);
        seen.push(fingerprint(&frame.scan));
    }
    let inner = reader(stream()?);
    let mut remarks = Vec::new();
    if let Some(beside) = beside {
        remarks = beside.take_place(&stamps_s, &mut odometry)?;
    }
    let repeats = Repeats::of(&stamps_s, &odometry, &seen);
    repeats.leave_out(&mut stamps_s);
    repeats.leave_out(&mut odometry);
    remarks.extend(repeats.remarks());
    let mut steps = Vec::new();
    if let Some(mended) = mended_stamps(&stamps_s) {
        remarks.extend(mended.remarks("scans"));
        (stamps_s, steps) = (mended.stamps_s, mended.steps);
    }
    let mut jumps = without_jumps(&stamps_s, &mut odometry);
    remarks.extend(apart(&steps, &mut jumps, &mut stamps_s));
    if jumps.is_empty() && beside.is_none() {
        odometry.clear();
    }
    remarks.extend(jumps_remark(&jumps));
    if remarks.is_empty() && odometry.is_empty() {
        return Ok(Box::new(inner));
    }
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
        remarks,
        is_repeat: repeats.is_repeat,
        seen: 0,
        stamps_s,
        odometry,
        earliest_after_s,
        waiting: BTreeMap::new(),
        read: 0,
        is_done: false,
        notes: LogNotes::default(),
    }))
}

/// Corrected stamps; `None` if they are in order.
fn mended_stamps(stamps_s: &[f64]) -> Option<MendedStamps> {
    // A log may count its frames from 0, which would be an unset stamp.
    let least_s = stamps_s.iter().copied().fold(f64::INFINITY, f64::min);
    let moved: Vec<f64> = stamps_s
        .iter()
        .map(|stamp_s| stamp_s - least_s + 1.0)
        .collect();
    let is_late = |two: &[f64]| two[1] <= two[0];
    if !moved.windows(2).any(is_late) {
        return None;
    }
    let mut mended = MendedStamps::new(&moved, &[]);
    if mended.is_unchanged() && mended.swapped == 0 {
        return None;
    }
    for stamp_s in &mut mended.stamps_s {
        *stamp_s += least_s - 1.0;
    }
    Some(mended)
}

/// Puts a pause where stamps and odometry start anew: what follows is another recording, and the robot is searched for.
fn apart(steps: &[ClockStep], jumps: &mut Vec<f64>, stamps_s: &mut [f64]) -> Option<Remark> {
    let back = steps.iter().filter(|step| step.by_s < 0.0);
    let starts: Vec<usize> = back
        .map(|step| step.at)
        .filter(|at| jumps.contains(&stamps_s[*at]))
        .collect();
    jumps.retain(|jump_s| !starts.iter().any(|at| stamps_s[*at] == *jump_s));
    for &at in &starts {
        stamps_s[at..]
            .iter_mut()
            .for_each(|stamp_s| *stamp_s += APART_S);
    }
    let first = starts.first()?;
    let text = format!(
        "stamps and odometry start anew at scan {first}, as where recordings were joined; what follows is searched for on the map. Map them one after the other with --continue"
    );
    Some(Remark::mended(Part::Clocks, text))
}

/// Removes jumps from the odometry of frames with these stamps; returns the stamps of the jumps, s.
fn without_jumps(stamps_s: &[f64], odometry: &mut [Option<SE2>]) -> Vec<f64> {
    let known = odometry.iter().enumerate();
    let mut order: Vec<(usize, SE2)> = known.filter_map(|(k, pose)| Some((k, (*pose)?))).collect();
    order.sort_by(|a, b| stamps_s[a.0].total_cmp(&stamps_s[b.0]));
    let poses = order.iter().map(|&(k, pose)| (stamps_s[k], pose));
    let mut poses: Vec<(f64, SE2)> = poses.collect();
    let jumps = remove_jumps(&mut poses);
    for ((k, _), (_, pose)) in order.into_iter().zip(poses) {
        odometry[k] = Some(pose);
    }
    jumps
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
            let is_full = self.waiting.len() > MAX_WAITING;
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
            self.notes.warnings.extend(self.remarks.iter().cloned());
            match frame? {
                Some(mut frame) => {
                    self.seen += 1;
                    if self.is_repeat.get(self.seen - 1) == Some(&true) {
                        continue;
                    }
                    if let Some(&stamp_s) = self.stamps_s.get(self.read) {
                        frame.stamp_s = stamp_s;
                    }
                    if let Some(&odometry) = self.odometry.get(self.read) {
                        frame.odometry = odometry;
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

/// Maps a finite number to an integer in the same order.
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
        let mut reader = restamped(&bytes, "x.clf", None, |source| {
            CarmenReader::new(source, "x.clf")
        })
        .unwrap();
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
    fn restarted_odometry_continues_the_path() {
        let lines = |k: u32| {
            let (x, k) = (0.1 * f64::from(k % 30), 0.1 * f64::from(k));
            format!("FLASER 3 1 1 1 {x} 0 0 {x} 0 0 {k} h {k}\n")
        };
        let text: String = (0..60).map(lines).collect();
        let bytes = LogBytes::from(text.into_bytes());
        let mut reader = restamped(&bytes, "x.clf", None, |source| {
            CarmenReader::new(source, "x.clf")
        })
        .unwrap();
        let mut last = None;
        while let Some(frame) = reader.next_frame().unwrap() {
            last = frame.odometry;
        }
        // 29 steps before and 29 after the restart.
        assert!((last.unwrap().x() - 5.8).abs() < 1e-9, "{last:?}");
        let remarks = &reader.notes().warnings[0].text;
        assert!(
            remarks.starts_with("odometry jumps 1 time, first at 3.00 s"),
            "{remarks}"
        );
    }

    #[test]
    fn scans_that_come_twice_or_stand_still_while_odometry_moves_are_left_out() {
        let line = |k: u32, of: u32, x: f64| {
            let ranges = (0..9).map(|beam| format!("{} ", 2.0 + 0.01 * f64::from(of + 3 * beam)));
            format!(
                "FLASER 9 {}{x} 0 0 {x} 0 0 {k} h {k}\n",
                ranges.collect::<String>()
            )
        };
        let moved = |k: u32| 0.1 * f64::from(k);
        let twice: String = (5..45).map(|k| line(k, k, moved(k)).repeat(2)).collect();
        let (found, remarks) = stamps(&twice);
        assert_eq!(found, (5..45).map(f64::from).collect::<Vec<_>>());
        assert!(
            remarks[0].text.starts_with("40 of 80 scans come twice"),
            "{remarks:?}"
        );
        assert_eq!(remarks.len(), 1);
        let frozen = |k: u32| if (20..30).contains(&k) { 20 } else { k };
        let frozen: String = (0..40).map(|k| line(k, frozen(k), moved(k))).collect();
        let (found, remarks) = stamps(&frozen);
        assert_eq!(found.len(), 31);
        assert!(
            remarks[0].text.starts_with("9 scans, first number 21,"),
            "{remarks:?}"
        );
        // A robot that stands sees the same again and again.
        let standing: String = (0..40).map(|k| line(k, 0, 0.0)).collect();
        assert_eq!(stamps(&standing).0.len(), 40);
    }

    #[test]
    fn two_recordings_in_one_file_are_apart() {
        let line = |k: u32| {
            let (x, k) = (0.1 * f64::from(k % 30), 5.0 + 0.1 * f64::from(k % 30));
            format!("FLASER 3 1 1 1 {x} 0 0 {x} 0 0 {k} h {k}\n")
        };
        let (found, remarks) = stamps(&(0..60).map(line).collect::<String>());
        assert_eq!(found.len(), 60);
        // 1e-9 s: sums of tenths.
        assert!((found[30] - found[29] - 0.1 - APART_S).abs() < 1e-9);
        let said: Vec<&str> = remarks.iter().map(|remark| remark.text.as_str()).collect();
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(
            said[1].starts_with("stamps and odometry start anew at scan 30"),
            "{said:?}"
        );
    }

    #[test]
    fn frames_come_in_the_order_of_time_whatever_their_clock_did() {
        let good: Vec<f64> = (0..40).map(f64::from).collect();
        assert_eq!(stamps(&log(good.iter().copied())).0.len(), 40);
        let swapped = good.chunks(2).flat_map(|two| [two[1] + 5.0, two[0] + 5.0]);
        let (found, remarks) = stamps(&log(swapped));
        assert!(found.windows(2).all(|two| two[0] < two[1]) && found.len() == 40);
        assert!(remarks[0].text.contains("sorted by stamp"), "{remarks:?}");
        let reset = good.iter().map(|stamp_s| {
            if *stamp_s < 20.0 {
                stamp_s + 100.0
            } else {
                stamp_s - 19.0
            }
        });
        let (found, remarks) = stamps(&log(reset));
        assert!(found.windows(2).all(|two| two[0] < two[1]) && found.len() == 40);
        assert!(remarks[0].text.contains("steps back"), "{remarks:?}");
    }
}
