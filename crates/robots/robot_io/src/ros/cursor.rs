//! Yields the scans of one topic in the order of their stamps, read from the file on demand.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use ch16_slam2d::scan::LaserScan;

use super::binned::binned;
use super::container::{Container, Recorded};
use super::messages::{header, laser_scan, multi_echo_scan};
use super::plan::PlannedScans;
use super::point_cloud::{cloud_points, point_cloud};
use super::survey::{SCANS, is_repeated, named, reader};
use crate::log::{FilePosition, LogNotes};

/// Most scans that wait for an earlier one which comes later in the file.
const MAX_WAITING: usize = 1024;
/// Beam spacing of a cloud that is cut to a height band, rad: half a degree.
const CLOUD_STEP_RAD: f64 = 0.0087;

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
    scans: PlannedScans,
    heights_m: Option<(f64, f64)>,
    /// Earliest stamp of all later messages, by message number, s.
    earliest_after_s: Vec<f64>,
    read: usize,
    /// Checksum of the last message.
    last_sum: Option<u32>,
    waiting: BinaryHeap<Waiting>,
    is_done: bool,
    /// Problems in the fields of the first faulty scan, one sentence each.
    remarks: Vec<String>,
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
            scans,
            heights_m,
            earliest_after_s,
            read: 0,
            last_sum: None,
            waiting: BinaryHeap::new(),
            is_done: false,
            remarks: Vec::new(),
        }
    }

    /// The topic with the stamps of its scans.
    pub fn scans(&self) -> &PlannedScans {
        &self.scans
    }

    /// Bytes read so far.
    pub fn offset(&self) -> u64 {
        self.container.offset()
    }

    /// Problems in the fields of scans so far.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
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
        if message.topic != self.scans.topic || !SCANS.contains(&message.kind.as_str()) {
            return;
        }
        if is_repeated(message, &mut self.last_sum) {
            return;
        }
        if let Some(frame) = &self.scans.only_frame {
            let header = reader(message)
                .and_then(|mut fields| header(&mut fields).map_err(|problem| problem.to_string()));
            if header.map_or(String::new(), |header| header.frame) != *frame {
                return;
            }
        }
        let number = self.read;
        self.read += 1;
        match self.scan(message) {
            Ok(scan) => {
                let stamp_s = self.scans.stamps_s.get(number).copied().unwrap_or(f64::NAN);
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

    fn scan(&mut self, message: &Recorded) -> Result<LaserScan, String> {
        let mut fields = reader(message)?;
        if message.kind == "sensor_msgs/PointCloud2" {
            if let Some((low_m, high_m)) = self.heights_m {
                let points = cloud_points(&mut fields)?;
                let body_from_sensor = self.scans.body_from_sensor;
                let on_body = points.iter().map(|point| body_from_sensor * point);
                let in_band = on_body.filter(|point| (low_m..=high_m).contains(&point.z));
                return Ok(binned(
                    in_band.map(|point| (point.x, point.y)),
                    CLOUD_STEP_RAD,
                ));
            }
            let (_, mut scan) = point_cloud(&mut fields)?;
            self.scans.mount.apply(&mut scan);
            return Ok(scan);
        }
        let read = if message.kind == SCANS[0] {
            laser_scan
        } else {
            multi_echo_scan
        };
        let (_, parsed) = read(&mut fields).map_err(|problem| problem.to_string())?;
        let (mut scan, remarks) = parsed.checked(self.scans.period_s)?;
        scan.validate().map_err(|problem| problem.to_string())?;
        if self.remarks.is_empty() {
            let topic = &self.scans.topic;
            self.remarks = remarks
                .iter()
                .map(|problem| format!("scans of {topic}: {problem}"))
                .collect();
        }
        self.scans.mount.apply(&mut scan);
        Ok(scan)
    }
}
