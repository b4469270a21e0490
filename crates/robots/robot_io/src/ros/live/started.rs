//! The second part of a live reading: scans and odometry by the plan.

use std::collections::VecDeque;
use std::ops::Range;

use super::clock::{LiveClock, StreamStamps};
use crate::lines::listed;
use crate::log::{LogFrame, LogOptions};
use crate::odometry_poses::LivePoses;
use crate::remark::{Part, Remark};
use crate::ros::container::Recorded;
use crate::ros::cursor::StampedScan;
use crate::ros::messages::header;
use crate::ros::plan::{OdometrySource, Plan};
use crate::ros::scan_decoder::ScanDecoder;
use crate::ros::survey::{BodyPoses, named, reader};

/// A scan waits for its odometry until a stamp is this much later, s, and in periods of the odometry.
const PATIENCE_S: f64 = 1.0;
const PATIENCE_PERIODS: f64 = 2.0;
/// Most scans that wait for their odometry.
const MAX_WAITING: usize = 200;

/// Scans and odometry by the plan.
pub struct Started {
    pub plan: Plan,
    pub decoder: ScanDecoder,
    odometry: LivePoses,
    clock: LiveClock,
    stamps: StreamStamps,
    pose_stamps: StreamStamps,
    /// Scans in the order of their stamps.
    waiting: VecDeque<StampedScan>,
    /// Latest stamp so far, s.
    newest_s: f64,
    /// Number of frames so far.
    pub frames: usize,
}

impl Started {
    /// Starts by a plan; `None` if it has no scans.
    pub fn new(plan: Plan, options: &LogOptions) -> Option<Self> {
        let scans = plan.scans.first()?.clone();
        let source = plan.source.as_ref();
        let period_s = source.map_or(0.0, |source| source.period_s);
        Some(Self {
            decoder: ScanDecoder::new(scans, options.heights_m),
            odometry: LivePoses::new(if period_s.is_finite() { period_s } else { 0.0 }),
            clock: LiveClock::default(),
            stamps: StreamStamps::default(),
            pose_stamps: StreamStamps::default(),
            waiting: VecDeque::new(),
            newest_s: f64::NEG_INFINITY,
            frames: 0,
            plan,
        })
    }

    /// Adds these poses of the source.
    pub fn add_poses(&mut self, track: &BodyPoses, range: Range<usize>) {
        let by_s = self.plan.source.as_ref().map_or(0.0, |source| source.by_s);
        for at in range {
            let (stated_s, recorded_s) = (track.stamps_s[at], track.recorded_s[at]);
            let stamp_s = self
                .clock
                .stamp_s(&mut self.pose_stamps, stated_s, recorded_s);
            self.odometry.push(stamp_s + by_s, track.poses[at]);
            self.newest_s = self.newest_s.max(stamp_s + by_s);
        }
    }

    /// Adds a message if it is a scan; returns why it is unusable.
    pub fn add_scan(&mut self, message: &Recorded) -> Option<String> {
        let scan = match self.decoder.read(message)? {
            Ok(scan) => scan,
            Err(problem) => return Some(named(message, problem)),
        };
        let mut fields = reader(message).ok()?;
        let stated_s = header(&mut fields).map_or(f64::NAN, |header| header.stamp_s);
        let stamp_s = self
            .clock
            .stamp_s(&mut self.stamps, stated_s, message.recorded_s)
            + self.plan.scans_by_s;
        if stamp_s.is_finite() {
            let at = self
                .waiting
                .partition_point(|other| other.stamp_s <= stamp_s);
            self.waiting.insert(at, StampedScan { stamp_s, scan });
            self.newest_s = self.newest_s.max(stamp_s);
        }
        None
    }

    /// The next frame, once the odometry of its time has come or is not waited for any longer.
    pub fn next(&mut self, is_over: bool) -> Option<LogFrame> {
        let stamp_s = self.waiting.front()?.stamp_s;
        let poses = self.odometry.poses();
        let is_ready = is_over
            || self.waiting.len() > MAX_WAITING
            || self.plan.source.as_ref().is_none_or(|source| {
                let patience_s = PATIENCE_S.max(PATIENCE_PERIODS * source.period_s);
                poses.reaches(stamp_s) || self.newest_s - stamp_s > patience_s
            });
        let scan = self.waiting.pop_front_if(|_| is_ready)?;
        let odometry = poses.at(stamp_s);
        self.frames += 1;
        Some(LogFrame {
            stamp_s,
            odometry,
            scan: scan.scan,
        })
    }

    /// What the whole recording shows that was unknown at the start.
    pub fn remarks(&self, whole: &Plan) -> Vec<Remark> {
        let mut remarks: Vec<Remark> = self
            .decoder
            .remarks()
            .iter()
            .map(|text| Remark::mended(Part::Sensor, text.clone()))
            .collect();
        let again = "map the recording again with slam2d run";
        let merged = self.plan.scans.iter().skip(1);
        let merged = listed(merged.map(|scans| scans.topic.clone()));
        let topic = &self.decoder.scans().topic;
        if !merged.is_empty() {
            let text = format!(
                "scans of {merged} are not merged with those of {topic} while the robot drives; choose with --scan-topic, or {again}"
            );
            remarks.push(Remark::mended(Part::Sensor, text));
        }
        if !self.plan.is_mounted && whole.is_mounted {
            let text = format!(
                "the transform to the laser came after mapping had begun, and the laser was taken at the body's origin, facing forward; {again}"
            );
            remarks.push(Remark::wrong(Part::Mounting, text));
        }
        let name = |source: &OdometrySource| {
            format!("{} from {} to {}", source.topic, source.above, source.body)
        };
        let (used, better) = (
            self.plan.source.as_ref().map(name),
            whole.source.as_ref().map(name),
        );
        if used != better {
            let used = used.unwrap_or_else(|| "no odometry".to_owned());
            let better = better.unwrap_or_else(|| "none".to_owned());
            let text = format!(
                "{used} was used, but the odometry of the whole recording is {better}; {again}"
            );
            remarks.push(Remark::wrong(Part::Odometry, text));
        }
        let is_new = |remark: &&Remark| !self.plan.warnings.contains(remark);
        let new = whole.warnings.iter().filter(is_new);
        if new.filter(|remark| remark.part == Part::Clocks).count() > 0 {
            let text = format!(
                "stamps are corrected only with the whole recording; while the robot drove, they were used as they came. To correct them, {again}"
            );
            remarks.push(Remark::mended(Part::Clocks, text));
        }
        remarks
    }
}
