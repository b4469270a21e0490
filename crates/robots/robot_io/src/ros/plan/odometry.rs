//! Selects the odometry, and aligns its clock with that of the scans.

use super::TRANSFORMS;
use crate::lines::listed;
use crate::log::LogOptions;
use crate::odometry_poses::{OdometryPoses, jumps_remark};
use crate::plural::plural;
use crate::remark::{NO_ODOMETRY, Part, Remark};
use crate::ros::survey::{BodyPoses, Survey};
use crate::stamps::MendedStamps;

/// Clocks that differ by less are one clock with a delay, s.
const SAME_CLOCK_S: f64 = 1.0;
/// A stamp that is later than its recording by more is from another clock, s.
const AHEAD_S: f64 = 0.1;
/// Odometry at fewer scans than this share does not cover them.
const COVERS: f64 = 0.8;

/// Message type of inertial measurements.
const IMU: &str = "sensor_msgs/Imu";

/// The selected odometry.
pub struct SelectedOdometry<'a> {
    /// Topic.
    pub topic: String,
    /// Poses.
    pub track: &'a BodyPoses,
    /// Stamps of the poses.
    pub clock: MendedStamps,
    /// Whether it is a transform.
    pub is_transform: bool,
    /// A remark on other candidates.
    pub others: Option<String>,
}

/// Selects odometry that moves, is connected to the laser and covers the scans; `None` if there is none.
pub fn chosen<'a>(
    survey: &'a Survey,
    options: &LogOptions,
    sensor: &str,
    scans: &MendedStamps,
) -> Option<SelectedOdometry<'a>> {
    let wanted = options.odometry_topic.as_deref();
    let topics = survey
        .odometry
        .iter()
        .map(|(topic, track)| (topic.clone(), track, false));
    let transforms = survey
        .tracks
        .values()
        .map(|track| (TRANSFORMS.to_owned(), track, true));
    let candidates = topics
        .chain(transforms)
        .filter(|(topic, track, is_transform)| {
            let is_wanted = wanted.map_or(!track.is_pose, |wanted| wanted == topic);
            // A transform with one message is static, whatever its name.
            let is_static = *is_transform && !track.moves && track.poses.len() <= 2;
            is_wanted && !is_static && !track.poses.is_empty()
        });
    let scored = candidates.map(|(topic, track, is_transform)| {
        let clock = MendedStamps::new(&track.stamps_s, &track.recorded_s);
        let link = laser_link(survey, track, sensor);
        let score = (
            track.moves,
            link,
            covers(&clock, scans),
            !is_transform,
            std::cmp::Reverse(track.order),
        );
        (score, topic, track, clock, is_transform)
    });
    let mut scored: Vec<_> = scored.collect();
    scored.sort_by_key(|candidate| std::cmp::Reverse(candidate.0));
    let mut scored = scored.into_iter();
    let (_, topic, track, mut clock, is_transform) = scored.next()?;
    clock.apply_steps_of(scans);
    let others = scored
        .map(|(_, topic, track, ..)| format!("{topic} from {} to {}", track.above, track.body));
    let others = listed(others.take(5));
    Some(SelectedOdometry {
        topic,
        track,
        clock,
        is_transform,
        others: (!others.is_empty()).then(|| {
            format!("there are other odometry sources: {others}; choose with --odom-topic or --odom-frame")
        }),
    })
}

/// A source of odometry by its names, and its clock.
#[derive(Clone, Debug, PartialEq)]
pub struct OdometrySource {
    /// Topic, or [`TRANSFORMS`] if the poses are transforms.
    pub topic: String,
    /// Whether the poses are transforms.
    pub is_transform: bool,
    /// Parent frame.
    pub above: String,
    /// Moving frame.
    pub body: String,
    /// Whether the poses differ.
    pub moves: bool,
    /// Usual time between two poses, s.
    pub period_s: f64,
    /// Offset added to the stamps, s.
    pub by_s: f64,
}

impl SelectedOdometry<'_> {
    /// The source, whose stamps are shifted by this, s.
    pub fn source(&self, by_s: f64) -> OdometrySource {
        OdometrySource {
            topic: self.topic.clone(),
            is_transform: self.is_transform,
            above: self.track.above.clone(),
            body: self.track.body.clone(),
            moves: self.track.moves,
            period_s: self.clock.period_s,
            by_s,
        }
    }
}

/// What is said of a recording without odometry that has other measurements of the robot's motion.
pub fn instead_of_odometry(survey: &Survey, scans: &MendedStamps) -> Option<Remark> {
    let poses = survey.odometry.iter().filter(|(_, track)| {
        let clock = MendedStamps::new(&track.stamps_s, &track.recorded_s);
        track.is_pose && track.moves && covers(&clock, scans)
    });
    let options: Vec<String> = poses
        .map(|(topic, _)| format!("--odom-topic {topic}"))
        .take(5)
        .collect();
    if !options.is_empty() {
        let text = format!(
            "the recording has no odometry, and poses that may be the robot's are not read; choose them with {}",
            listed(options.iter().cloned())
        );
        let remark = Remark::mended(Part::Odometry, text);
        return Some(options.iter().fold(remark, Remark::with_option));
    }
    let topics = survey.counts.keys();
    let (topic, kind) = topics.into_iter().find(|(_, kind)| kind == IMU)?;
    Some(Remark::mended(
        Part::Odometry,
        format!(
            "the recording has no odometry, and {topic} ({kind}) is not read; scans are matched alone. Record nav_msgs/Odometry as well, for example from robot_localization"
        ),
    ))
}

/// Remarks on sources of odometry whose poses have no orientation, or a wrong one.
pub fn without_headings(survey: &Survey) -> Vec<Remark> {
    let topics = survey.odometry.iter().filter(|(_, track)| !track.is_pose);
    let topics = topics.map(|(topic, track)| (topic.as_str(), track));
    let transforms = survey.tracks.values().map(|track| (TRANSFORMS, track));
    let unset = topics
        .chain(transforms)
        .filter(|(_, track)| track.without_heading > 0 || track.rolls_only());
    let remarks = unset.map(|(topic, track)| {
        let poses = plural(track.without_heading, "pose");
        let source = format!("{topic} from {} to {}", track.above, track.body);
        if track.rolls_only() {
            Remark::wrong(
                Part::Odometry,
                format!(
                    "the orientations of {source} roll the robot over, as if w was listed first, so its heading is unknown; this odometry is not used. Publish x, y, z and w in this order"
                ),
            )
        } else if track.poses.is_empty() {
            Remark::wrong(
                Part::Odometry,
                format!(
                    "the orientation of every pose of {source} is 0,0,0,0, so the robot's heading is unknown; this odometry is not used. Publish the orientation as a unit quaternion"
                ),
            )
        } else {
            Remark::mended(
                Part::Odometry,
                format!("{poses} of {source} have the orientation 0,0,0,0 and were skipped"),
            )
        }
    });
    remarks.take(5).collect()
}

/// Whether the moving body carries the laser.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LaserLink {
    /// The transforms contain the body, but do not connect it to the laser.
    None,
    /// No transform contains the body.
    Unknown,
    /// Transforms connect the body to the laser.
    Connected,
}

fn laser_link(survey: &Survey, track: &BodyPoses, sensor: &str) -> LaserLink {
    let transforms = &survey.transforms;
    let ground = Some(track.above.as_str());
    let mut edges = transforms.edges();
    if transforms
        .body_from_sensor(&track.body, sensor, ground)
        .is_some()
    {
        LaserLink::Connected
    } else if edges
        .any(|(parent, child)| parent == track.body || child == track.body && parent != track.above)
    {
        LaserLink::None
    } else {
        LaserLink::Unknown
    }
}

/// Whether the poses cover the time of most scans, by the recording's time if it is known.
fn covers(clock: &MendedStamps, scans: &MendedStamps) -> bool {
    let offset_s = clock_offset_s(scans, clock).unwrap_or(0.0);
    let (first_s, last_s) = ends_s(&clock.stamps_s);
    let covered = scans.stamps_s.iter().filter(|&&stamp_s| {
        let stamp_s = stamp_s - offset_s;
        (first_s - SAME_CLOCK_S..=last_s + SAME_CLOCK_S).contains(&stamp_s)
    });
    covered.count() as f64 >= COVERS * scans.stamps_s.len() as f64
}

fn ends_s(stamps_s: &[f64]) -> (f64, f64) {
    let known = stamps_s
        .iter()
        .copied()
        .filter(|stamp_s| stamp_s.is_finite());
    known.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(first, last), stamp_s| (first.min(stamp_s), last.max(stamp_s)),
    )
}

/// Offset of the scans' clock from the odometry's clock, if the recording's time shows it, s.
fn clock_offset_s(scans: &MendedStamps, odometry: &MendedStamps) -> Option<f64> {
    let (of_scans, of_odometry) = (scans.ahead_s?, odometry.ahead_s?);
    let offset_s = of_scans - of_odometry;
    // A stamp after its recording is from another clock; one before it may be delayed.
    let least_s = if of_scans.max(of_odometry) > AHEAD_S {
        AHEAD_S
    } else {
        SAME_CLOCK_S
    };
    (offset_s.abs() > least_s).then_some(offset_s)
}

/// Scans and odometry on one clock.
pub struct Aligned {
    /// Odometry poses on that clock.
    pub poses: OdometryPoses,
    /// Offset added to the scans' stamps, s.
    pub scans_by_s: f64,
    /// Offset added to the odometry's stamps, s.
    pub odometry_by_s: f64,
    /// Remarks on the correction.
    pub remarks: Vec<Remark>,
}

/// Aligns both to the clock of the recording, or to that of the odometry.
pub fn aligned(odometry: &SelectedOdometry<'_>, scans: &MendedStamps) -> Aligned {
    let clock = &odometry.clock;
    let (mut scans_by_s, mut odometry_by_s, mut remarks) = (0.0, 0.0, Vec::new());
    if let Some(offset_s) = clock_offset_s(scans, clock) {
        let is_scans_off = scans
            .ahead_s
            .is_some_and(|ahead_s| !(-SAME_CLOCK_S..=AHEAD_S).contains(&ahead_s));
        if is_scans_off {
            scans_by_s = -offset_s;
        } else {
            odometry_by_s = offset_s;
        }
        let whose = if is_scans_off { "scan" } else { "odometry" };
        remarks.push(Remark::mended(
            Part::Clocks,
            format!(
                "the clocks of scans and odometry differ by {:.1} s, judging by the time of recording; the {whose} clock was shifted. Synchronize both computers' clocks with NTP",
                offset_s.abs()
            ),
        ));
    } else {
        let ((first_s, last_s), (scan_s, end_s)) =
            (ends_s(&clock.stamps_s), ends_s(&scans.stamps_s));
        if last_s < scan_s || first_s > end_s {
            let apart_s = scan_s - first_s;
            remarks.push(Remark::wrong(
                Part::Clocks,
                format!(
                    "the clocks of scans and odometry differ by {:.0} s, and the recording does not show which is right; synchronize both computers' clocks with NTP and record again, or use scans alone with {NO_ODOMETRY}",
                    apart_s.abs()
                ),
            )
            .with_option(NO_ODOMETRY));
        }
    }
    let stamped = clock.stamps_s.iter().zip(&odometry.track.poses);
    let poses = stamped
        .filter(|(stamp_s, _)| stamp_s.is_finite())
        .map(|(stamp_s, pose)| (stamp_s + odometry_by_s, *pose));
    let (poses, jumps) = OdometryPoses::new(poses.collect(), clock.period_s);
    remarks.extend(jumps_remark(&jumps));
    Aligned {
        poses,
        scans_by_s,
        odometry_by_s,
        remarks,
    }
}
