//! Decodes the messages of one topic of scans.

use ch16_slam2d::scan::LaserScan;

use super::binned::binned;
use super::container::Recorded;
use super::messages::{header, laser_scan, multi_echo_scan};
use super::plan::PlannedScans;
use super::point_cloud::{cloud_points, point_cloud};
use super::survey::{POINT_CLOUD, SCANS, is_repeated, reader};

/// Beam spacing of a cloud that is cut to a height band, rad: half a degree.
const CLOUD_STEP_RAD: f64 = 0.0087;

/// Decodes the scans of a topic, with their mounting.
pub struct ScanDecoder {
    scans: PlannedScans,
    heights_m: Option<(f64, f64)>,
    /// Checksum of the last message.
    last_sum: Option<u32>,
    /// Problems in the fields of the first faulty scan, one sentence each.
    remarks: Vec<String>,
}

impl ScanDecoder {
    /// Creates a decoder of the scans of a topic.
    pub fn new(scans: PlannedScans, heights_m: Option<(f64, f64)>) -> Self {
        Self {
            scans,
            heights_m,
            last_sum: None,
            remarks: Vec::new(),
        }
    }

    /// The topic with the stamps of its scans.
    pub fn scans(&self) -> &PlannedScans {
        &self.scans
    }

    /// Problems in the fields of scans so far.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The scan of a message; `None` if it is of another topic or publisher, or duplicates the one before.
    pub fn read(&mut self, message: &Recorded) -> Option<Result<LaserScan, String>> {
        if message.topic != self.scans.topic || !SCANS.contains(&message.kind.as_str()) {
            return None;
        }
        if is_repeated(message, &mut self.last_sum) {
            return None;
        }
        if let Some(frame) = &self.scans.only_frame {
            let header = reader(message)
                .and_then(|mut fields| header(&mut fields).map_err(|problem| problem.to_string()));
            if header.map_or(String::new(), |header| header.frame) != *frame {
                return None;
            }
        }
        Some(self.scan(message))
    }

    fn scan(&mut self, message: &Recorded) -> Result<LaserScan, String> {
        let mut fields = reader(message)?;
        if message.kind == POINT_CLOUD {
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
