//! Content of a recording, collected in one pass.
//!
//! Keeps the stamps and frames of scans, and all poses of odometry and of transforms that may be odometry, up to a
//! bound. Memory is therefore small however long the recording is.

use std::collections::BTreeMap;

use pr_geom::SE2;

use super::container::Recorded;
use super::messages::{
    Header, header, laser_scan, multi_echo_scan, odometry, stamped_pose, transforms,
};
use super::point_cloud::point_cloud;
use super::transforms::{Transforms, is_ground, planar};
use super::wire::WireReader;
use crate::log::LogOptions;
use crate::plausible::plausible_pose;

/// Garbage has an unbounded number of topics.
const MAX_TOPICS: usize = 1000;
/// Most poses kept of one source; beyond it, every second one is dropped.
const MAX_POSES: usize = 1 << 18;
/// Most transforms that are recorded as possible odometry.
const MAX_TRACKS: usize = 32;
/// Number of messages of a topic that are fully decoded to check whether they are usable.
const TRIED: usize = 3;
/// The same while none of them is.
const MOST_TRIED: usize = 100;
/// Most frames of a topic that are told apart.
const MAX_FRAMES: usize = 16;
/// Mean square of the smaller one of x and w beyond which a body is rolled far: by 37°.
const FAR_ROLLED: f64 = 0.1;
/// Odometry within this has not moved, m and rad.
const STILL: f64 = 1e-3;

/// Message types of scans.
pub const SCANS: [&str; 3] = [
    "sensor_msgs/LaserScan",
    "sensor_msgs/MultiEchoLaserScan",
    POINT_CLOUD,
];
/// Message type of clouds.
pub const POINT_CLOUD: &str = "sensor_msgs/PointCloud2";
/// Message type of odometry.
pub const ODOMETRY: &str = "nav_msgs/Odometry";

/// Message types of poses that are odometry if the user says so: also goals and the results of programs have these types.
pub const POSES: [&str; 3] = [
    "geometry_msgs/PoseStamped",
    "geometry_msgs/PoseWithCovarianceStamped",
    TRANSFORM,
];
const TRANSFORM: &str = "geometry_msgs/TransformStamped";

/// Whether a message type is that of transforms.
pub fn is_transforms(kind: &str) -> bool {
    matches!(kind, "tf2_msgs/TFMessage" | "tf/tfMessage")
}

/// The scans of a topic.
#[derive(Clone, Debug, Default)]
pub struct ScanStream {
    /// Index into [`SCANS`].
    pub kind: usize,
    /// Rank among the topics in the order of the file.
    pub order: usize,
    /// Stamp of each message, s; NaN if it is unreadable.
    pub stamps_s: Vec<f64>,
    /// Time of recording of each message, s.
    pub recorded_s: Vec<f64>,
    /// Number of messages that duplicate the one before and are skipped.
    pub repeated: usize,
    /// Checksum of the last message.
    last_sum: Option<u32>,
    /// The sensor's frame in the first message.
    pub frame: String,
    /// Whether any decoded message is usable.
    pub is_usable: bool,
    /// Why the first message is unusable.
    pub problem: Option<String>,
    /// The frames of all messages, and for each message the index of its frame.
    frames: Vec<PublisherFrame>,
    frame_of: Vec<usize>,
    /// Whether only messages in [`frame`](Self::frame) are read, because another publisher uses the topic.
    pub is_shared: bool,
    /// Frames of the other publishers, with their numbers of messages.
    pub others: Vec<(String, usize)>,
}

/// A frame in which scans are published on a topic.
#[derive(Clone, Debug, Default)]
struct PublisherFrame {
    name: String,
    /// Number of messages that were fully decoded, and whether any of them is usable.
    tried: usize,
    is_usable: bool,
}

impl ScanStream {
    /// Keeps the scans of one publisher, the one with the most usable ones, if several publish on the topic at the same time.
    ///
    /// Frames that follow one another are those of a driver that was renamed.
    fn separate_publishers(&mut self) {
        let span = |frame: usize| {
            let of_frame = |index: &usize| self.frame_of[*index] == frame;
            let mut own = (0..self.frame_of.len()).filter(of_frame);
            let first = own.next().unwrap_or_default();
            (first, own.next_back().unwrap_or(first))
        };
        let spans: Vec<(usize, usize)> = (0..self.frames.len()).map(span).collect();
        let overlap = |a: usize, b: usize| spans[a].0 < spans[b].1 && spans[b].0 < spans[a].1;
        let count = |frame: usize| self.frame_of.iter().filter(|of| **of == frame).count();
        let Some(most) = (0..self.frames.len())
            .rev()
            .max_by_key(|frame| (self.frames[*frame].is_usable, count(*frame)))
        else {
            return;
        };
        let others: Vec<usize> = (0..self.frames.len())
            .filter(|other| *other != most && overlap(most, *other))
            .collect();
        if others.is_empty() {
            return;
        }
        self.others = others
            .iter()
            .map(|other| (self.frames[*other].name.clone(), count(*other)))
            .collect();
        self.frame.clone_from(&self.frames[most].name);
        self.is_shared = true;
        let own = |values: &[f64]| {
            let numbered = values.iter().zip(&self.frame_of);
            let own = numbered.filter(|(_, frame)| **frame == most);
            own.map(|(value, _)| *value).collect()
        };
        (self.stamps_s, self.recorded_s) = (own(&self.stamps_s), own(&self.recorded_s));
    }
}

/// Poses of a body from one source.
#[derive(Clone, Debug, Default)]
pub struct BodyPoses {
    /// Parent frame.
    pub above: String,
    /// Moving frame.
    pub body: String,
    /// Rank among the tracks in the order of the file.
    pub order: usize,
    /// Stamp of each pose, s.
    pub stamps_s: Vec<f64>,
    /// Time of recording of each pose, s.
    pub recorded_s: Vec<f64>,
    /// The poses.
    pub poses: Vec<SE2>,
    /// Whether the poses differ.
    pub moves: bool,
    /// Whether the messages are poses, which are used only if the user chooses their topic.
    pub is_pose: bool,
    /// Number of messages without an orientation; their poses are left out.
    pub without_heading: usize,
    /// Sums of the squares of the orientations' x, y, z and w.
    squares: [f64; 4],
    /// Keeps every n-th message.
    every: usize,
    seen: usize,
}

impl BodyPoses {
    /// Whether the orientations turn about the forward axis only, and far: what turns about the vertical seems to do so
    /// if w is listed first.
    pub fn rolls_only(&self) -> bool {
        let [x, y, z, w] = self.squares;
        let rolled = x.min(w);
        rolled > FAR_ROLLED * (x + y + z + w) && rolled > 10.0 * (y + z)
    }

    fn add(&mut self, stamp_s: f64, recorded_s: f64, pose: SE2) {
        self.every = self.every.max(1);
        self.seen += 1;
        if !(self.seen - 1).is_multiple_of(self.every) {
            return;
        }
        if let Some(first) = self.poses.first() {
            let moved = first.between(&pose).to_array();
            self.moves |= moved.iter().any(|part| part.abs() > STILL);
        }
        self.stamps_s.push(stamp_s);
        self.recorded_s.push(recorded_s);
        self.poses.push(pose);
        if self.poses.len() >= MAX_POSES {
            self.every *= 2;
            thin(&mut self.stamps_s);
            thin(&mut self.recorded_s);
            thin(&mut self.poses);
        }
    }
}

fn thin<T>(all: &mut Vec<T>) {
    let mut at = 0;
    all.retain(|_| {
        at += 1;
        at % 2 == 1
    });
}

/// Content of a recording.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// Number of messages by topic and type.
    pub counts: BTreeMap<(String, String), usize>,
    /// Scans by topic.
    pub scans: BTreeMap<String, ScanStream>,
    /// Odometry by topic.
    pub odometry: BTreeMap<String, BodyPoses>,
    /// Transforms that may be odometry, by parent frame and body.
    pub tracks: BTreeMap<(String, String), BodyPoses>,
    /// The latest transforms.
    pub transforms: Transforms,
}

impl Survey {
    /// Adds a message.
    ///
    /// # Errors
    /// If the message is malformed; it is skipped. Scans are checked when they are read.
    pub fn add(&mut self, message: &Recorded, options: &LogOptions) -> Result<(), String> {
        let key = (message.topic.clone(), message.kind.clone());
        if self.counts.len() < MAX_TOPICS || self.counts.contains_key(&key) {
            *self.counts.entry(key).or_default() += 1;
        }
        let named = |problem: String| named(message, problem);
        if let Some(kind) = SCANS.iter().position(|kind| *kind == message.kind) {
            self.add_scan(message, kind, options);
            return Ok(());
        }
        match message.kind.as_str() {
            kind if kind == ODOMETRY || POSES.contains(&kind) => {
                self.add_odometry(message).map_err(named)
            }
            kind if is_transforms(kind) => {
                let all = reader(message)
                    .and_then(|mut fields| transforms(&mut fields).map_err(|e| e.to_string()))
                    .map_err(named)?;
                for transform in &all {
                    let Ok(pose) = plausible_pose(planar(&transform.transform)) else {
                        continue;
                    };
                    self.transforms.add(transform);
                    let parent = &transform.header.frame;
                    let may_be_odometry = match &options.odometry_frame {
                        Some(frame) => frame.trim_start_matches('/') == parent,
                        None => is_ground(parent) && parent.contains("odom"),
                    };
                    let key = (parent.clone(), transform.child.clone());
                    let has_room = self.tracks.len() < MAX_TRACKS;
                    if may_be_odometry && (has_room || self.tracks.contains_key(&key)) {
                        let order = self.tracks.len();
                        let track = self.tracks.entry(key).or_insert_with(|| BodyPoses {
                            above: parent.clone(),
                            body: transform.child.clone(),
                            order,
                            ..BodyPoses::default()
                        });
                        if transform.is_oriented {
                            track.add(transform.header.stamp_s, message.recorded_s, pose);
                        } else {
                            track.without_heading += 1;
                        }
                    }
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn add_scan(&mut self, message: &Recorded, kind: usize, options: &LogOptions) {
        let order = self.scans.len();
        if order >= MAX_TOPICS && !self.scans.contains_key(&message.topic) {
            return;
        }
        let stream = self.scans.entry(message.topic.clone()).or_default();
        if is_repeated(message, &mut stream.last_sum) {
            stream.repeated += 1;
            return;
        }
        if stream.stamps_s.is_empty() {
            (stream.kind, stream.order) = (kind, order);
        }
        let head =
            reader(message).and_then(|mut fields| header(&mut fields).map_err(|e| e.to_string()));
        let stamp_s = match &head {
            Ok(header) => header.stamp_s,
            Err(_) => f64::NAN,
        };
        stream.stamps_s.push(stamp_s);
        stream.recorded_s.push(message.recorded_s);
        let frame = head.map_or(String::new(), |header| header.frame);
        let known = stream.frames.iter().position(|known| known.name == frame);
        let known = known.unwrap_or_else(|| {
            if stream.frames.len() < MAX_FRAMES {
                stream.frames.push(PublisherFrame {
                    name: frame,
                    ..PublisherFrame::default()
                });
            }
            stream.frames.len() - 1
        });
        stream.frame_of.push(known);
        let of_frame = &mut stream.frames[known];
        if of_frame.tried < TRIED || !of_frame.is_usable && of_frame.tried < MOST_TRIED {
            of_frame.tried += 1;
            match scan_header(message, options) {
                Ok(header) => {
                    if !stream.is_usable {
                        stream.frame = header.frame;
                    }
                    stream.is_usable = true;
                    of_frame.is_usable = true;
                }
                Err(problem) => {
                    stream
                        .problem
                        .get_or_insert_with(|| named(message, problem));
                }
            }
        }
    }

    /// Ends the survey: separates publishers that use one topic, and leaves out odometry whose headings are wrong.
    pub fn end(&mut self) {
        let tracks = self.odometry.values_mut();
        tracks
            .filter(|track| track.rolls_only())
            .for_each(|track| track.poses.clear());
        self.scans
            .values_mut()
            .for_each(ScanStream::separate_publishers);
    }

    fn add_odometry(&mut self, message: &Recorded) -> Result<(), String> {
        let mut fields = reader(message)?;
        let read = match message.kind.as_str() {
            ODOMETRY | TRANSFORM => odometry,
            _ => stamped_pose,
        };
        let parsed = read(&mut fields).map_err(|problem| problem.to_string())?;
        let pose = plausible_pose(planar(&parsed.pose))?;
        let order = self.odometry.len();
        if order >= MAX_TOPICS && !self.odometry.contains_key(&message.topic) {
            return Ok(());
        }
        let track = self
            .odometry
            .entry(message.topic.clone())
            .or_insert_with(|| BodyPoses {
                above: parsed.header.frame.clone(),
                body: if parsed.child.is_empty() {
                    "base_link".to_owned()
                } else {
                    parsed.child.clone()
                },
                order,
                is_pose: message.kind != ODOMETRY,
                ..BodyPoses::default()
            });
        if parsed.is_oriented {
            let parts = parsed.pose.rotation.coords.iter();
            for (sum, part) in track.squares.iter_mut().zip(parts) {
                *sum += part * part;
            }
            track.add(parsed.header.stamp_s, message.recorded_s, pose);
        } else {
            track.without_heading += 1;
        }
        Ok(())
    }
}

/// Decodes a scan as far as needed to check whether it is usable.
fn scan_header(message: &Recorded, options: &LogOptions) -> Result<Header, String> {
    let mut fields = reader(message)?;
    let in_words = |problem: super::wire::WireError| problem.to_string();
    match message.kind.as_str() {
        POINT_CLOUD if options.heights_m.is_some() => header(&mut fields).map_err(in_words),
        POINT_CLOUD => point_cloud(&mut fields).map(|(header, _)| header),
        kind => {
            let read = if kind == SCANS[0] {
                laser_scan
            } else {
                multi_echo_scan
            };
            let (header, scan) = read(&mut fields).map_err(in_words)?;
            let (scan, _) = scan.checked(0.0)?;
            scan.validate().map_err(|problem| problem.to_string())?;
            Ok(header)
        }
    }
}

/// Whether a message duplicates the last one of its topic, as in bags that were merged with themselves.
pub fn is_repeated(message: &Recorded, last_sum: &mut Option<u32>) -> bool {
    let sum = crc32fast::hash(&message.bytes);
    last_sum.replace(sum) == Some(sum)
}

/// The fields of a message.
pub fn reader(message: &Recorded) -> Result<WireReader<'_>, String> {
    WireReader::new(message.wire, &message.bytes).map_err(|problem| problem.to_string())
}

/// Adds type and topic of the message to a problem.
pub fn named(message: &Recorded, problem: String) -> String {
    format!("{} on {}: {problem}", message.kind, message.topic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_orientations_with_w_first_roll_and_do_nothing_else() {
        let is_w_first = |quaternion: fn(f64, f64) -> [f64; 4], most_rad: f64| {
            let mut track = BodyPoses::default();
            for step in 0..=20 {
                let half_rad = most_rad * f64::from(step) / 40.0;
                let parts = quaternion(half_rad.sin(), half_rad.cos());
                for (sum, part) in track.squares.iter_mut().zip(parts) {
                    *sum += part * part;
                }
            }
            track.rolls_only()
        };
        assert!(is_w_first(|sin, cos| [cos, 0.0, 0.0, sin], 2.0));
        // Level, upside down, leaning sideways, and an optical frame; turning far, and hardly.
        for most_rad in [0.01, 2.0] {
            assert!(!is_w_first(|sin, cos| [0.0, 0.0, sin, cos], most_rad));
            assert!(!is_w_first(|sin, cos| [cos, sin, 0.0, 0.0], most_rad));
            assert!(!is_w_first(
                |sin, cos| [0.3 * cos, 0.3 * sin, 0.95 * sin, 0.95 * cos],
                most_rad
            ));
            assert!(!is_w_first(
                |sin, cos| [-cos, cos, -sin - cos, sin + cos].map(|part| 0.5 * part),
                most_rad
            ));
        }
    }
}
