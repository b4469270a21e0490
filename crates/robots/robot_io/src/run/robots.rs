//! Where a robot starts on the map; several robots in one run, each of which is a piece.

use ch16_slam2d::localize::StartPose;
use ch16_slam2d::pipeline::{PieceFate, PieceReport};

use super::LogRun;
use crate::log::{LogError, LogFrame, LogReader};
use crate::plural::plural;

impl LogRun {
    /// The first scan does not continue the session: the robot is searched for on its map, at this pose if one is
    /// given.
    #[must_use]
    pub fn starting_at(mut self, start: StartPose) -> Self {
        self.pipeline = self.pipeline.starting_at(start);
        self
    }

    /// The next frame of a log, for [`step`](Self::step): a robot that begins with it is searched for on the map. After
    /// the first scan, an unreadable rest ends the log: see [`broken`](Self::broken).
    ///
    /// # Errors
    /// If the log cannot be read, or its next scan has to come first.
    pub fn next_frame(
        &mut self,
        reader: &mut (impl LogReader + ?Sized),
    ) -> Result<Option<LogFrame>, LogError> {
        let frame = match reader.next_frame() {
            Err(problem) if self.scans() > 0 && !matches!(problem, LogError::Waiting) => {
                self.broken = Some(problem.to_string());
                None
            }
            read => read?,
        };
        if let Some((frame, robot)) = frame.as_ref().zip(reader.next_robot()) {
            self.next_robot(&robot, frame.stamp_s);
        }
        Ok(frame)
    }

    /// Why the log could not be read to its end.
    #[must_use]
    pub fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{FilePosition, LogNotes};
    use ch16_slam2d::scan::LaserScan;

    /// Scans of a room, then a disk that fails.
    struct Failing {
        scans: usize,
        notes: LogNotes,
    }

    impl LogReader for Failing {
        fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
            self.scans = self.scans.checked_sub(1).ok_or(LogError::Io {
                name: "hall.bag".to_owned(),
                position: FilePosition::Byte(9),
                source: std::io::ErrorKind::UnexpectedEof.into(),
            })?;
            Ok(Some(LogFrame {
                stamp_s: -(self.scans as f64),
                odometry: None,
                scan: LaserScan {
                    angle_step_rad: 0.05,
                    ranges_m: vec![3.0; 120],
                    ..LaserScan::default()
                },
            }))
        }

        fn notes(&self) -> &LogNotes {
            &self.notes
        }
    }

    #[test]
    fn a_log_that_breaks_is_an_error_before_its_first_scan_and_ends_after_it() {
        for scans in [0, 2] {
            let (mut run, notes) = (LogRun::default(), LogNotes::default());
            let mut reader = Failing { scans, notes };
            for _ in 0..scans {
                let frame = run.next_frame(&mut reader).unwrap().unwrap();
                run.step(frame).expect("it is taken");
            }
            let end = run.next_frame(&mut reader);
            assert_eq!(end.is_err(), scans == 0);
            let told = run.broken().map(|why| why.contains("hall.bag: byte 9"));
            assert_eq!(told, (scans > 0).then_some(true));
        }
    }
}
