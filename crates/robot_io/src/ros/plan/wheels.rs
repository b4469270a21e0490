//! Which odometry is taken, and how its clock and that of the scans go together.

use super::TRANSFORMS;
use crate::lines::listed;
use crate::log::LogOptions;
use crate::remark::{NO_ODOMETRY, Part, Remark};
use crate::ros::survey::{Survey, Track};
use crate::stamps::MendedStamps;
use crate::wheel_poses::{WheelPoses, jumps_remark};

/// Clocks that differ by less are one clock with a delay, s.
const SAME_CLOCK_S: f64 = 1.0;
/// A stamp that is later than its recording by more is of another clock, s.
const AHEAD_S: f64 = 0.1;
/// Odometry of fewer scans than this share does not cover them.
const COVERS: f64 = 0.8;

/// The odometry that is taken.
pub struct Wheels<'a> {
    /// Its topic.
    pub topic: String,
    /// Its poses.
    pub track: &'a Track,
    /// Their stamps.
    pub clock: MendedStamps,
    /// Whether it is a transform.
    pub is_transform: bool,
    /// What else might have been taken.
    pub others: Option<String>,
}

/// The odometry that moves, leads to the laser and covers the scans; none where there is none.
pub fn chosen<'a>(
    survey: &'a Survey,
    options: &LogOptions,
    sensor: &str,
    scans: &MendedStamps,
) -> Option<Wheels<'a>> {
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
            let is_wanted = wanted.is_none_or(|wanted| wanted == topic);
            // A transform of one message is fixed, whatever its name.
            is_wanted && (!is_transform || track.moves || track.poses.len() > 2)
        });
    let scored = candidates.map(|(topic, track, is_transform)| {
        let clock = MendedStamps::new(&track.stamps_s, &track.recorded_s);
        let leads = leads_to(survey, track, sensor);
        let score = (
            track.moves,
            leads,
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
    clock.take_steps_of(scans);
    let others = scored
        .map(|(_, topic, track, ..)| format!("{topic} from {} to {}", track.above, track.body));
    let others = listed(others.take(5));
    Some(Wheels {
        topic,
        track,
        clock,
        is_transform,
        others: (!others.is_empty()).then(|| {
            format!("there is other odometry: {others}; choose with --odom-topic or --odom-frame")
        }),
    })
}

/// Whether the body that moves carries the laser.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Leads {
    /// The transforms know the body, and no way to the laser.
    Not,
    /// No transform names the body.
    Perhaps,
    /// Transforms lead to the laser.
    Surely,
}

fn leads_to(survey: &Survey, track: &Track, sensor: &str) -> Leads {
    let transforms = &survey.transforms;
    let ground = Some(track.above.as_str());
    let mut edges = transforms.edges();
    if transforms
        .body_from_sensor(&track.body, sensor, ground)
        .is_some()
    {
        Leads::Surely
    } else if edges
        .any(|(parent, child)| parent == track.body || child == track.body && parent != track.above)
    {
        Leads::Not
    } else {
        Leads::Perhaps
    }
}

/// Whether the poses cover the time of most scans, each by the recording's own time where it is known.
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

/// How far the scans' clock is ahead of that of the odometry, if the recording's time shows it, s.
fn clock_offset_s(scans: &MendedStamps, wheels: &MendedStamps) -> Option<f64> {
    let (of_scans, of_wheels) = (scans.ahead_s?, wheels.ahead_s?);
    let offset_s = of_scans - of_wheels;
    // What is stamped after it was recorded was stamped by another clock; before it, it may have been delayed.
    let least_s = if of_scans.max(of_wheels) > AHEAD_S {
        AHEAD_S
    } else {
        SAME_CLOCK_S
    };
    (offset_s.abs() > least_s).then_some(offset_s)
}

/// Scans and odometry on one clock.
pub struct Aligned {
    /// The poses on that clock.
    pub poses: WheelPoses,
    /// What is added to the scans' stamps, s.
    pub scans_by_s: f64,
    /// What was done.
    pub said: Vec<Remark>,
}

/// Puts both on the clock of the recording, or on that of the odometry.
pub fn aligned(wheels: &Wheels<'_>, scans: &MendedStamps) -> Aligned {
    let clock = &wheels.clock;
    let (mut scans_by_s, mut wheels_by_s, mut said) = (0.0, 0.0, Vec::new());
    if let Some(offset_s) = clock_offset_s(scans, clock) {
        let is_scans_off = scans
            .ahead_s
            .is_some_and(|ahead_s| !(-SAME_CLOCK_S..=AHEAD_S).contains(&ahead_s));
        if is_scans_off {
            scans_by_s = -offset_s;
        } else {
            wheels_by_s = offset_s;
        }
        let whose = if is_scans_off { "scans" } else { "odometry" };
        said.push(Remark::mended(
            Part::Clocks,
            format!(
                "the clocks of scans and odometry differ by {:.1} s, as the recording's own time shows; that of the {whose} is moved. Set both computers' clocks by NTP",
                offset_s.abs()
            ),
        ));
    } else {
        let ((first_s, last_s), (scan_s, end_s)) =
            (ends_s(&clock.stamps_s), ends_s(&scans.stamps_s));
        if last_s < scan_s || first_s > end_s {
            let apart_s = scan_s - first_s;
            said.push(Remark::wrong(
                Part::Clocks,
                format!(
                    "the clocks of scans and odometry differ by {:.0} s, and the recording does not show which is right; set both computers' clocks by NTP and record again, or go by scans alone with {NO_ODOMETRY}",
                    apart_s.abs()
                ),
            )
            .with_option(NO_ODOMETRY));
        }
    }
    let stamped = clock.stamps_s.iter().zip(&wheels.track.poses);
    let poses = stamped
        .filter(|(stamp_s, _)| stamp_s.is_finite())
        .map(|(stamp_s, pose)| (stamp_s + wheels_by_s, *pose));
    let (poses, jumps) = WheelPoses::new(poses.collect(), clock.period_s);
    said.extend(jumps_remark(&jumps));
    Aligned {
        poses,
        scans_by_s,
        said,
    }
}
