//! What a run tells the user about its scans and pieces.

use ch16_slam2d::pipeline::{PieceFate, PieceReport};

use super::LogRun;
use super::robots::robot_sentence;
use crate::plural::plural;
use crate::remark::{Part, Remark};

/// Reason why a log without any return has no map.
const NOTHING_SEEN: &str = "no beam of any keyframe has a range between the sensor's shortest and longest range; check range_min and range_max in the driver, and whether something covers the laser";

/// Odometry without motion in this many scans is reported: it may not have been recorded.
const STILL_SCANS: usize = 20;

/// Message on scans whose stamp is not later than the one before; `None` if there are none.
#[must_use]
pub fn late_scans(name: &str, late: usize) -> Option<String> {
    match late {
        0 => None,
        1 => Some(format!(
            "{name}: one scan is not later than the one before it and was skipped"
        )),
        _ => Some(format!(
            "{name}: {late} scans are not later than the one before them and were skipped"
        )),
    }
}

impl LogRun {
    /// Messages for the user on the scans that were taken and those that were skipped.
    #[must_use]
    pub fn sentences(&self, name: &str) -> Vec<String> {
        let other = self.sensor.as_ref().zip(self.other_sensor.as_ref());
        let other = other.map(|(known, other)| {
            let [known, other] = [known, other].map(|sensor| {
                let degrees = |angle_rad: f64| angle_rad.to_degrees();
                format!(
                    "start at {:.1}° with a step of {:.2}°",
                    degrees(sensor.first_angle_rad),
                    degrees(sensor.angle_step_rad)
                )
            });
            format!(
                "{name}: its beams {other}, and the session's {known}; the session's parameters are kept"
            )
        });
        let rejected = self
            .rejected
            .map(|problem| format!("{name}: scans were skipped; the first because {problem}"));
        let late = late_scans(name, self.late);
        let still = self.still_odometry(name);
        let blind = (self.blind > 0).then(|| {
            format!(
                "{name}: {} without a return before the first one that sees something {} skipped, because without odometry nothing shows how the robot moved",
                plural(self.blind, "scan"),
                if self.blind == 1 { "was" } else { "were" }
            )
        });
        let lengths = self.path_remark();
        let lengths = lengths.map(|remark| format!("{name}: {}", remark.text));
        let pieces = self.pieces().iter();
        let pieces = pieces.filter_map(|piece| match self.robot_of(piece) {
            Some(robot) => robot_sentence(name, robot, piece),
            None => piece_sentence(name, piece, self.session_scans),
        });
        let bridged = self.bridged_sentence();
        let bridged = bridged.map(|text| format!("{name}: {text}"));
        [other, late, blind, still, lengths, rejected, bridged]
            .into_iter()
            .flatten()
            .chain(pieces)
            .collect()
    }

    /// Remarks on what only mapping shows: the lengths of the paths, and scans that motion cannot explain.
    #[must_use]
    pub fn remarks(&self) -> Vec<Remark> {
        let pieces = self
            .pieces()
            .iter()
            .filter(|piece| self.robot_of(piece).is_none());
        let pieces = pieces.filter_map(|piece| {
            let text = piece_sentence("", piece, self.session_scans)?;
            let text = text.trim_start_matches(": ").to_owned();
            Some(match piece.fate {
                PieceFate::Joined(_) => Remark::mended(Part::Clocks, text),
                _ => Remark::wrong(Part::Clocks, text),
            })
        });
        self.path_remark().into_iter().chain(pieces).collect()
    }

    /// Sentence on gaps in which nothing measured the motion.
    fn bridged_sentence(&self) -> Option<String> {
        let bridged = self.bridged();
        let first = bridged.first()?;
        let longest_s = bridged
            .iter()
            .fold(0.0, |longest: f64, gap| longest.max(gap.gap_s));
        Some(format!(
            "scans are missing {} for up to {longest_s:.1} s, first before {:.2} s, and odometry is missing or stands still meanwhile; the robot was searched for around its last pose, and found. Record odometry, or keep the connection that loses the messages",
            plural(bridged.len(), "time"),
            first.stamp_s
        ))
    }

    /// Why there is no map; `None` if there is one, or if no scan was given.
    #[must_use]
    pub fn no_map(&self) -> Option<String> {
        if self.scans() > 0 {
            return (!self.has_seen()).then(|| NOTHING_SEEN.to_owned());
        }
        let is_blind = self.blind > 0;
        let rejected = self.rejected.map(|problem| problem.to_string());
        rejected.or_else(|| is_blind.then(|| NOTHING_SEEN.to_owned()))
    }

    /// A remark if odometry stands still while the robot drives, or if the path on the map and that of the odometry have
    /// different lengths.
    #[must_use]
    pub fn path_remark(&self) -> Option<Remark> {
        let lengths = || self.slam().and_then(|slam| self.lengths.remark(slam));
        self.stuck.remark().or_else(lengths)
    }

    /// Message on odometry that never moved; `None` if it did.
    fn still_odometry(&self, name: &str) -> Option<String> {
        let scans = self.still.filter(|&scans| scans >= STILL_SCANS)?;
        Some(format!(
            "{name}: its odometry stands still for all {scans} scans; if the robot moved, ignore it with \
             slam2d run LOG --no-odometry"
        ))
    }
}

/// Sentence on a piece; `session_scans` is the number of scans of the session that the log continues. `None` while it
/// is mapped on its own.
fn piece_sentence(name: &str, piece: &PieceReport, session_scans: usize) -> Option<String> {
    let is_other_day = session_scans > 0 && piece.scans_before == session_scans;
    let after = if is_other_day {
        format!("{name}: it does not continue where the session ended")
    } else {
        format!(
            "{name}: motion cannot explain the scans after a gap of {:.0} s at {:.2} s, as if the robot was carried",
            piece.gap_s, piece.first_s
        )
    };
    let map = if is_other_day {
        "the session's map"
    } else {
        "the map"
    };
    match (piece.fate, is_other_day) {
        (PieceFate::Alone, _) => None,
        (PieceFate::Joined(scans), _) => Some(format!(
            "{after}; the robot was found on {map} after {}, and all its scans are on it",
            plural(scans, "scan")
        )),
        (PieceFate::Kept, true) => Some(format!(
            "{after}, and the robot was not found on {map}: the results cover this log alone. Give its first pose on that map with --init x,y,deg, or record a drive through a part of it"
        )),
        (fate, _) => {
            let (left_out, which) = match fate {
                PieceFate::Kept => (piece.scans_before, "before"),
                _ => (piece.scans, "after"),
            };
            Some(format!(
                "{after}, and the robot was not found on {map}: the {} {which} the gap were left out. Map both parts as two logs, or record a drive through an area of both",
                plural(left_out, "scan")
            ))
        }
    }
}
