//! Selects scans and odometry of a recording, and determines mounting and stamps.

mod mounts;
mod odometry;
mod offers;
mod robots;

pub use odometry::OdometrySource;

use nalgebra::Isometry3;

use super::survey::{POINT_CLOUD, SCANS, ScanStream, Survey};
use super::transforms::is_ground;
use crate::laser_mount::LaserMount;
use crate::lines::listed;
use crate::log::{LogNotes, LogOffer, LogOption, LogOptions};
use crate::odometry_poses::OdometryPoses;
use crate::plural::plural;
use crate::remark::{Part, Remark};
use crate::stamps::MendedStamps;

/// A topic with fewer scans than this share of the largest one is not the robot's laser.
const MIN_SHARE: f64 = 0.1;
/// Two lasers whose numbers of scans differ by more than this factor are not merged.
const SAME_RATE: f64 = 1.5;
/// Most topics listed in a sentence.
const MAX_NAMED: usize = 10;

/// The topic of transforms.
pub const TRANSFORMS: &str = "/tf";

/// A topic whose scans are read.
#[derive(Clone, Debug)]
pub struct PlannedScans {
    /// Topic.
    pub topic: String,
    /// The frame of the messages that are read, if others use the topic.
    pub only_frame: Option<String>,
    /// Stamp of each message, s; NaN if it is unreadable.
    pub stamps_s: Vec<f64>,
    /// Time between scans, s.
    pub period_s: f64,
    /// Mounting of the laser in the plane.
    pub mount: LaserMount,
    /// The mounting in 3-D.
    pub body_from_sensor: Isometry3<f64>,
}

/// Selection from a recording.
#[derive(Debug, Default)]
pub struct Plan {
    /// The scans; those of further lasers are merged into those of the first.
    pub scans: Vec<PlannedScans>,
    /// The body's poses by odometry.
    pub odometry: Option<OdometryPoses>,
    /// Their source.
    pub source: Option<OdometrySource>,
    /// Offset that was added to the stamps of scans, s.
    pub scans_by_s: f64,
    /// Whether the mounting of the first laser is known.
    pub is_mounted: bool,
    /// Choices for options.
    pub offers: Vec<LogOffer>,
    /// An option that requests a name which does not exist.
    pub missing: Option<(LogOption, String)>,
    /// Topics of the scans of each further robot, separated by commas.
    pub robots: Vec<String>,
    /// Choices made and what was found.
    pub about: Vec<String>,
    /// What was missing or corrected.
    pub warnings: Vec<Remark>,
    /// Why there is no readable scan.
    without_scans: String,
}

impl Plan {
    /// Selects from a recording with the content that `survey` found.
    #[must_use]
    pub fn new(survey: &Survey, options: &LogOptions) -> Self {
        let mut plan = Self {
            without_scans: without_scans(survey, options),
            ..Self::default()
        };
        let chosen = chosen_scans(survey, options);
        let Some((topic, stream)) = chosen.first().copied() else {
            plan.offers = offers::list(survey, None, None, None);
            return plan;
        };
        let mut clocks = vec![MendedStamps::new(&stream.stamps_s, &stream.recorded_s)];
        let odometry = odometry::chosen(survey, options, &stream.frame, &clocks[0]);
        let ground = odometry
            .as_ref()
            .map(|odometry| odometry.track.above.as_str());
        let told_body = options
            .body_frame
            .as_deref()
            .map(|body| body.trim_start_matches('/'));
        let body = told_body
            .or(odometry
                .as_ref()
                .map(|odometry| odometry.track.body.as_str()))
            .unwrap_or("base_link");
        let found = mounts::find(survey, body, &stream.frame, ground, options);
        let frame = if stream.frame.is_empty() {
            "without a frame".to_owned()
        } else {
            format!("in frame {}", stream.frame)
        };
        plan.about.push(format!("scans come from {topic}, {frame}"));
        if let Some(odometry) = &odometry {
            plan.about.push(format!(
                "odometry comes from {}, {} to {}",
                odometry.topic, odometry.track.above, odometry.track.body
            ));
        }
        plan.about.push(mounts::sentence(&found));
        plan.is_mounted = found.is_known;
        plan.scans.push(planned(topic, stream, &clocks[0], &found));
        plan.name_other_publishers(topic, stream);
        let of_mount = |text| Remark::mended(Part::Mounting, text);
        let is_in_ground = !found.is_known && is_fixed(&stream.frame, ground);
        plan.warnings.extend(if is_in_ground {
            Some(in_fixed_frame(topic, &stream.frame))
        } else {
            found.warning.clone().map(of_mount)
        });
        for (other, stream) in &chosen[1..] {
            let other_mount = mounts::find(survey, &found.body, &stream.frame, ground, options);
            let is_asked_for = options.scan_topic.is_some();
            // A laser that no transform connects to the body is on another robot.
            let is_on_body = other_mount.is_known && other_mount.body == found.body;
            if is_on_body && found.is_known && stream.frame != chosen[0].1.frame || is_asked_for {
                let clock = MendedStamps::new(&stream.stamps_s, &stream.recorded_s);
                plan.about.push(format!(
                    "scans of {other}, in frame {}, are merged with them: {}",
                    stream.frame,
                    mounts::sentence(&other_mount)
                ));
                plan.scans
                    .push(planned(other, stream, &clock, &other_mount));
                clocks.push(clock);
            }
        }
        if stream.repeated > 0 {
            let text = format!(
                "{} of {topic} {} a duplicate of the one before and skipped",
                plural(stream.repeated, "scan"),
                if stream.repeated == 1 { "is" } else { "are" }
            );
            plan.warnings.push(Remark::mended(Part::File, text));
        }
        plan.robots = robots::others(survey, options, &plan.scans);
        plan.name_other_scans(survey, options);
        for (scans, clock) in plan.scans.iter().zip(&clocks) {
            let remarks = clock.remarks(&format!("scans of {}", scans.topic));
            plan.warnings.extend(remarks);
        }
        plan.warnings.extend(odometry::without_headings(survey));
        if let Some(odometry) = &odometry {
            plan.warnings.extend(
                odometry
                    .clock
                    .remarks(&format!("poses of {}", odometry.topic)),
            );
            plan.align_clocks(odometry, &clocks[0]);
            plan.about.extend(odometry.others.clone());
        } else if options.odometry_topic.is_none() {
            plan.warnings
                .extend(odometry::instead_of_odometry(survey, &clocks[0]));
        }
        for (parent, child) in survey.transforms.edges().take(100) {
            plan.about
                .push(format!("frame {child} is a child of {parent}"));
        }
        plan.offers = offers::list(survey, Some(topic), odometry.as_ref(), Some(&found.body));
        plan.missing = offers::missing(survey, options, &plan.offers, odometry.as_ref());
        plan
    }

    /// Aligns the clocks of odometry and scans.
    fn align_clocks(&mut self, odometry: &odometry::SelectedOdometry<'_>, clock: &MendedStamps) {
        let aligned = odometry::aligned(odometry, clock);
        let by_s = aligned.scans_by_s;
        self.scans_by_s = by_s;
        self.source = Some(odometry.source(aligned.odometry_by_s));
        for scans in &mut self.scans {
            scans
                .stamps_s
                .iter_mut()
                .for_each(|stamp_s| *stamp_s += by_s);
        }
        self.warnings.extend(aligned.remarks);
        let poses = aligned.poses;
        let anchor = &self.scans[0].stamps_s;
        let known = anchor.iter().filter(|stamp_s| stamp_s.is_finite()).count();
        let bare = anchor
            .iter()
            .filter(|stamp_s| stamp_s.is_finite() && poses.at(**stamp_s).is_none())
            .count();
        if bare > 0
            && let Some((first_s, last_s)) = poses.ends_s()
        {
            let early = anchor
                .iter()
                .filter(|&&stamp_s| stamp_s < first_s && poses.at(stamp_s).is_none());
            let late = anchor
                .iter()
                .filter(|&&stamp_s| stamp_s > last_s && poses.at(stamp_s).is_none());
            let (early, late) = (early.count(), late.count());
            self.warnings.push(Remark::mended(Part::Odometry, format!(
                "{bare} of {known} scans have no odometry at their stamp ({early} before its first pose, {late} after its last, {} in gaps); they are matched without odometry. Record odometry from start to end",
                bare - early - late
            )));
        }
        self.odometry = Some(poses);
    }

    /// Names publishers on the topic whose scans are not read.
    fn name_other_publishers(&mut self, topic: &str, stream: &ScanStream) {
        if stream.others.is_empty() {
            return;
        }
        let others = stream.others.iter().map(|(frame, count)| {
            let frame = if frame.is_empty() { "no frame" } else { frame };
            format!("{frame} ({})", plural(*count, "scan"))
        });
        let text = format!(
            "{topic} has scans of several publishers: those in frame {} are read, and those in {} are not{}; let each publish on its own topic",
            stream.frame,
            listed(others),
            stream
                .problem
                .as_ref()
                .map_or(String::new(), |problem| format!(" ({problem})"))
        );
        self.warnings.push(Remark::mended(Part::Sensor, text));
    }

    /// Lists topics with scans that are not read.
    fn name_other_scans(&mut self, survey: &Survey, options: &LogOptions) {
        if options.scan_topic.is_some() {
            return;
        }
        let is_read = |topic: &String| self.scans.iter().any(|scans| scans.topic == *topic);
        let of_robots = || self.robots.iter().flat_map(|topics| topics.split(','));
        let is_of_robot = |topic: &String| of_robots().any(|other| other == topic);
        let usable = survey.scans.iter().filter(|(_, stream)| stream.is_usable);
        let others: Vec<String> = usable
            .filter(|(topic, _)| !(is_read(topic) || options.all_robots && is_of_robot(topic)))
            .map(|(topic, _)| topic.clone())
            .take(MAX_NAMED)
            .collect();
        if !others.is_empty() {
            let options = others.iter().map(|topic| format!("--scan-topic {topic}"));
            let mut options: Vec<String> = options.collect();
            let all = if self.robots.is_empty() {
                ""
            } else {
                "; if they belong to another robot, slam2d run --all-robots maps all robots into one map"
            };
            let text = format!(
                "there are also scans on {}, which are not read; choose with {}{all}",
                listed(others.into_iter()),
                options[0]
            );
            let remark = Remark::mended(Part::Sensor, text);
            if !self.robots.is_empty() {
                options.push(format!("--{}", LogOption::AllRobots.name()));
            }
            self.warnings
                .push(options.iter().fold(remark, Remark::with_option));
        }
    }

    /// Writes counts and choices to the notes.
    pub fn write_notes(&self, survey: &Survey, notes: &mut LogNotes) {
        let counts = survey.counts.iter();
        notes.records = counts
            .map(|((topic, kind), &count)| (format!("{topic} {kind}"), count))
            .collect();
        notes.about.clone_from(&self.about);
        notes.warnings.clone_from(&self.warnings);
        notes.offers.clone_from(&self.offers);
        notes.robots.clone_from(&self.robots);
        // Merged scans have no single laser.
        notes.laser = match &self.scans[..] {
            [only] => Some(only.mount),
            _ => None,
        };
    }

    /// What the recording contains instead of scans.
    pub fn without_scans(&self) -> &str {
        &self.without_scans
    }

    /// The names that exist for an option.
    pub fn instead_of(&self, option: LogOption) -> String {
        let offer = self.offers.iter().find(|offer| offer.option == option);
        let names = offer.map_or(&[][..], |offer| &offer.names);
        if names.is_empty() {
            "it has none, so leave the option out".to_owned()
        } else {
            format!("it has {}", listed(names.iter().take(20).cloned()))
        }
    }
}

/// What to do about a topic of clouds in another type than `sensor_msgs/PointCloud2`.
pub fn unread_cloud(topic: &str, kind: &str) -> Option<String> {
    let (of, remedy) = match kind {
        "sensor_msgs/PointCloud" => (
            "the old type of clouds",
            "convert each message with convertPointCloudToPointCloud2 of sensor_msgs",
        ),
        kind if kind.starts_with("livox_ros_driver") && kind.ends_with("/CustomMsg") => (
            "Livox's own type of clouds",
            "set xfer_format to 0 in the launch file of its driver",
        ),
        _ => return None,
    };
    Some(format!(
        "{topic} is {kind}, {of}, which is not read; {remedy}, record sensor_msgs/PointCloud2, and pass --heights LOW,HIGH"
    ))
}

/// Whether a frame does not move with the robot.
fn is_fixed(frame: &str, ground: Option<&str>) -> bool {
    !frame.is_empty() && (ground == Some(frame) || is_ground(frame))
}

/// Scans that were already moved by a pose of the robot.
fn in_fixed_frame(topic: &str, frame: &str) -> Remark {
    Remark::wrong(
        Part::Mounting,
        format!(
            "{topic} is in {frame}, which does not move with the robot: its points were already moved by a pose of the robot, so they do not show where the sensor was. Record the topic that the sensor's driver publishes, in the sensor's frame"
        ),
    )
}

fn planned(
    topic: &str,
    stream: &ScanStream,
    clock: &MendedStamps,
    found: &mounts::FoundMount,
) -> PlannedScans {
    PlannedScans {
        topic: topic.to_owned(),
        only_frame: stream.is_shared.then(|| stream.frame.clone()),
        stamps_s: clock.stamps_s.clone(),
        period_s: clock.period_s,
        mount: found.mount,
        body_from_sensor: found.body_from_sensor,
    }
}

/// The topics whose scans are read, the primary one first.
fn chosen_scans<'a>(survey: &'a Survey, options: &LogOptions) -> Vec<(&'a str, &'a ScanStream)> {
    let usable = survey.scans.iter().filter(|(_, stream)| stream.is_usable);
    let mut usable: Vec<(&str, &ScanStream)> = usable
        .map(|(topic, stream)| (topic.as_str(), stream))
        .collect();
    if let Some(wanted) = &options.scan_topic {
        let find = |topic: &str| usable.iter().copied().find(|(known, _)| *known == topic);
        let all = wanted.split(',').map(str::trim);
        let found: Option<Vec<_>> = all.map(find).collect();
        return found.unwrap_or_default();
    }
    // Lasers before clouds, which may come from a camera.
    let is_cloud = |stream: &ScanStream| SCANS[stream.kind] == POINT_CLOUD;
    usable.sort_by_key(|(_, stream)| (is_cloud(stream), stream.order));
    let most = usable
        .iter()
        .map(|(_, stream)| stream.stamps_s.len())
        .max()
        .unwrap_or(0);
    let is_rich = |count: usize| count as f64 >= MIN_SHARE * most as f64;
    usable.retain(|(_, stream)| is_rich(stream.stamps_s.len()));
    let Some((_, first)) = usable.first().copied() else {
        return usable;
    };
    let of_first = first.stamps_s.len() as f64;
    let mut frames = vec![first.frame.as_str()];
    let mut at = 0;
    usable.retain(|(_, stream)| {
        at += 1;
        let ratio = stream.stamps_s.len() as f64 / of_first;
        let is_new = !frames.contains(&stream.frame.as_str());
        let is_kept = at == 1
            || is_new
                && !is_cloud(stream)
                && !is_cloud(first)
                && (1.0 / SAME_RATE..=SAME_RATE).contains(&ratio);
        if is_kept {
            frames.push(stream.frame.as_str());
        }
        is_kept
    });
    usable
}

fn without_scans(survey: &Survey, options: &LogOptions) -> String {
    if options.scan_topic.is_none()
        && let Some(problem) = survey
            .scans
            .values()
            .find_map(|stream| stream.problem.clone())
    {
        return problem;
    }
    if let Some(topic) = &options.scan_topic
        && let Some(problem) = survey
            .scans
            .get(topic)
            .and_then(|stream| stream.problem.clone())
    {
        return problem;
    }
    let topics = survey.counts.keys();
    if let Some(advice) = topics
        .clone()
        .find_map(|(topic, kind)| unread_cloud(topic, kind))
    {
        return advice;
    }
    let topics = listed(
        topics
            .take(20)
            .map(|(topic, kind)| format!("{topic} ({kind})")),
    );
    if let Some(topic) = &options.scan_topic {
        return format!("{topic} is not one of {topics}");
    }
    if topics.is_empty() {
        return "it has no message".to_owned();
    }
    format!("it has {topics}; record a topic of type sensor_msgs/LaserScan as well")
}
