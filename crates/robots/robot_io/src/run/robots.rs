//! Where a robot starts on the map; several robots in one run, each of which is a piece.

use ch16_slam2d::localize::StartPose;
use ch16_slam2d::pipeline::{PieceFate, PieceReport};

use super::LogRun;
use crate::plural::plural;

impl LogRun {
    /// The first scan does not continue the session: the robot is searched for on its map, at this pose if one is
    /// given.
    #[must_use]
    pub fn starting_at(mut self, start: StartPose) -> Self {
        self.pipeline = self.pipeline.starting_at(start);
        self
    }

    /// The scans from this stamp (s) on are those of another robot, which is searched for on the map.
    pub fn next_robot(&mut self, name: &str, first_s: f64) {
        if self.pipeline.scans().is_empty() {
            return;
        }
        self.robots.push((name.to_owned(), first_s));
        self.pipeline = std::mem::take(&mut self.pipeline).starting_at(StartPose::Anywhere);
    }

    /// The robot that starts with this piece; `None` if the piece continues one.
    pub(super) fn robot_of(&self, piece: &PieceReport) -> Option<&str> {
        let begins = |first_s: f64| {
            let mut pieces = self.pieces().iter();
            pieces.find(|other| other.first_s >= first_s) == Some(piece)
        };
        let mut robots = self.robots.iter().rev();
        let (name, _) = robots.find(|(_, first_s)| begins(*first_s))?;
        Some(name)
    }
}

/// Sentence on the piece of another robot; `None` while it is mapped on its own.
pub(super) fn robot_sentence(name: &str, robot: &str, piece: &PieceReport) -> Option<String> {
    match piece.fate {
        PieceFate::Alone => None,
        PieceFate::Joined(scans) => Some(format!(
            "{name}: the robot of {robot} was found on the map after {}, and all its scans are on it",
            plural(scans, "scan")
        )),
        PieceFate::LeftOut | PieceFate::Kept => {
            let (count, which) = match piece.fate {
                PieceFate::Kept => (piece.scans_before, "of the robots before it"),
                _ => (piece.scans, "of it"),
            };
            Some(format!(
                "{name}: the robot of {robot} was not found on the map: the {} {which} were left out. Map it alone with --scan-topic {robot}, or record a drive through an area of both",
                plural(count, "scan")
            ))
        }
    }
}
