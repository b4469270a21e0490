//! A file of odometry beside a log: a table with a time, x, y and a heading in each row, or a trajectory of TUM or EuRoC.

use pr_geom::SE2;

use crate::foreign::Foreign;
use crate::lines::{LineEnd, next_line};
use crate::log::{BrokenRecord, FilePosition, LogError, LogNotes};
use crate::log_bytes::LogBytes;
use crate::odometry_poses::{OdometryPoses, jumps_remark};
use crate::odometry_use::OdometryFile;
use crate::remark::{Part, Remark};
use crate::stamps::period_s;
use crate::table_layout::TableLayout;
use crate::table_log::TableRows;
use crate::trajectory::Trajectory;

/// The poses of a file of odometry.
pub struct BesideOdometry {
    /// Its name.
    name: String,
    poses: OdometryPoses,
    remarks: Vec<Remark>,
}

impl BesideOdometry {
    /// Whether a file with this start has odometry but no scans.
    #[must_use]
    pub fn begins(start: &[u8]) -> bool {
        let is_trajectory = || Foreign::of(start).is_some_and(Foreign::is_trajectory);
        TableLayout::of(start).is_none()
            && (TableLayout::of_poses(start).is_some() || is_trajectory())
    }

    /// Reads a file; `chosen` names it and its columns.
    ///
    /// # Errors
    /// If the system cannot read it, or it has no poses.
    pub fn read(bytes: &LogBytes<'_>, chosen: Option<&OdometryFile>) -> Result<Self, LogError> {
        let name = chosen.map_or("the file of odometry", |file| file.path.as_str());
        let io = |source| LogError::at_start(name, source);
        let wrong = |problem| LogError::Odometry {
            name: name.to_owned(),
            problem,
        };
        let mut source = bytes.stream().map_err(io)?;
        let columns = chosen.and_then(|file| file.columns.clone());
        let layout = match columns {
            Some(columns) => Some(columns),
            None => TableLayout::of_poses(source.fill_buf().map_err(io)?),
        };
        let mut notes = LogNotes::default();
        let poses: Vec<(f64, SE2)> = match layout {
            Some(layout) => {
                let mut rows = TableRows::new(layout);
                let (mut line, mut poses) = (Vec::new(), Vec::new());
                while let Some((end, _)) = next_line(&mut source, &mut line).map_err(io)? {
                    notes.lines += 1;
                    match rows.pose(&line, &mut notes) {
                        Ok(pose) => poses.extend(pose),
                        Err(problem) if end == LineEnd::CutOff => {
                            let position = FilePosition::Line(notes.lines);
                            notes.truncated = Some(BrokenRecord { position, problem });
                        }
                        Err(problem) => notes.skip(FilePosition::Line(notes.lines), problem),
                    }
                }
                poses
            }
            None => {
                let read = Trajectory::read_tum(source, name).map_err(|problem| {
                    wrong(format!(
                        "it is read as odometry, which is a table with a header such as time,x,y,heading, or lines of TUM: {problem}"
                    ))
                })?;
                let poses = read.poses().iter();
                poses.map(|at| (at.stamp_s, at.pose)).collect()
            }
        };
        if poses.is_empty() {
            return Err(wrong(match notes.first_broken {
                Some(first) => format!(
                    "it has no poses; {} is the first that is none: {}",
                    first.position, first.problem
                ),
                None => "it has no poses".to_owned(),
            }));
        }
        let stamps_s: Vec<f64> = poses.iter().map(|pose| pose.0).collect();
        let (poses, jumps) = OdometryPoses::new(poses, period_s(&stamps_s));
        let skipped = notes.sentences(name).into_iter();
        let mut remarks: Vec<Remark> = skipped
            .map(|text| Remark::mended(Part::Odometry, text))
            .collect();
        remarks.extend(jumps_remark(&jumps));
        Ok(Self {
            name: name.to_owned(),
            poses,
            remarks,
        })
    }

    /// Puts the pose at each of these stamps (s) in the place of the log's own odometry; returns the remarks on it.
    ///
    /// # Errors
    /// If no scan has a pose.
    pub fn take_place(
        &self,
        stamps_s: &[f64],
        odometry: &mut [Option<SE2>],
    ) -> Result<Vec<Remark>, LogError> {
        let mut remarks = self.remarks.clone();
        if odometry.iter().any(Option::is_some) {
            remarks.push(Remark::mended(
                Part::Odometry,
                format!(
                    "the log has its own odometry, too; that of {} is used, and the log's is not",
                    self.name
                ),
            ));
        }
        for (stamp_s, pose) in stamps_s.iter().zip(odometry.iter_mut()) {
            *pose = self.poses.at(*stamp_s);
        }
        if stamps_s.is_empty() || odometry.iter().any(Option::is_some) {
            return Ok(remarks);
        }
        let stamps_s = stamps_s.iter().copied();
        let first = stamps_s.clone().fold(f64::INFINITY, f64::min);
        let last = stamps_s.fold(f64::NEG_INFINITY, f64::max);
        let (from, to) = self.poses.ends_s().unwrap_or_default();
        Err(LogError::Odometry {
            name: self.name.clone(),
            problem: format!(
                "no scan has odometry, because the scans are from {first:.2} to {last:.2} s and the odometry from {from:.2} to {to:.2} s; write both with the same clock, or state the unit, such as time_us or time_ns"
            ),
        })
    }
}
