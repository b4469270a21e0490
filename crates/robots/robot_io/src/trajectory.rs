//! Stamped poses, and the TUM format: `stamp x y z qx qy qz qw` on each line, separated by blanks or commas.
//!
//! A first line of names is skipped, as is a line that repeats the one before. Some programs write `qw` first: a line of
//! names says so, or else that robots stand upright.
//!
//! Also reads EuRoC's ground truth: `stamp,x,y,z,qw,qx,qy,qz` with integer nanoseconds, followed by more columns.
//! Source: Burri et al., "The EuRoC micro aerial vehicle datasets", 2016.

use std::io::{BufRead, Write};

use pr_geom::{SE2, math};
use serde::Serialize;
use thiserror::Error;

use crate::lines::{LineEnd, finite, next_line};
use crate::plausible::{plausible_pose, plausible_stamp_s};

/// Poses in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    poses: Vec<StampedPose>,
}

/// A pose with its stamp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StampedPose {
    /// Stamp, s.
    pub stamp_s: f64,
    /// `world_from_body`.
    pub pose: SE2,
}

/// Why a file of poses or relations cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TextError {
    /// The bytes could not be read.
    #[error("{name}: line {line}: {source}")]
    Io {
        /// The file's name.
        name: String,
        /// Line number.
        line: usize,
        /// The system's error.
        source: std::io::Error,
    },
    /// A line is malformed.
    #[error("{name}: line {line}: {problem}; a line is ‘{expected}’")]
    Line {
        /// The file's name.
        name: String,
        /// Line number, counted from 1.
        line: usize,
        /// What is wrong.
        problem: String,
        /// The fields of a line.
        expected: &'static str,
    },
    /// The file has no data lines.
    #[error("{name} has no data; expected lines of ‘{expected}’")]
    Empty {
        /// The file's name.
        name: String,
        /// The fields of a line.
        expected: &'static str,
    },
}

/// Stamps of at least this are nanoseconds: eleven days after 1970.
const MIN_STAMP_NS: f64 = 1e15;
/// A nanosecond stamp that overflowed a 32-bit integer.
const OVERFLOWN: f64 = 2_147_483_647.0;

const TUM_LINE: &str = "stamp x y z qx qy qz qw";

impl Trajectory {
    /// Creates a trajectory from poses in the order of time.
    #[must_use]
    pub fn new(poses: Vec<StampedPose>) -> Self {
        Self { poses }
    }

    /// The poses in order.
    #[must_use]
    pub fn poses(&self) -> &[StampedPose] {
        &self.poses
    }

    /// Reads lines of TUM or EuRoC; `#` starts a comment. Height, roll and pitch are ignored.
    ///
    /// # Errors
    /// If a line is malformed or not later than the one before, or there is no line.
    pub fn read_tum(source: impl BufRead, name: &str) -> Result<Self, TextError> {
        let mut poses: Vec<StampedPose> = Vec::new();
        let mut rotations: Vec<[f64; 4]> = Vec::new();
        let mut numbers = NumberLines::new(source, name, TUM_LINE);
        let mut is_euroc = false;
        let mut last_numbers = None;
        while let Some([stamp, x, y, z, a, b, c, d]) = numbers.next_line()? {
            let line = [stamp, x, y, z, a, b, c, d];
            let is_repeated = last_numbers.replace(line) == Some(line);
            if is_repeated && stamp != OVERFLOWN {
                continue;
            }
            is_euroc |= numbers.has_commas && stamp >= MIN_STAMP_NS;
            let stamp_s = if is_euroc { stamp * 1e-9 } else { stamp };
            if stamp == OVERFLOWN && poses.last().is_some_and(|last| last.stamp_s == OVERFLOWN) {
                let problem = "the stamps are all 2147483647: they overflowed 32 bits; write them with 64 bits";
                return Err(numbers.reject(problem.to_owned()));
            }
            if poses.last().is_some_and(|last| stamp_s <= last.stamp_s) {
                return Err(
                    numbers.reject("the stamp is not later than the one before it".to_owned())
                );
            }
            if a * a + b * b + c * c + d * d < 1e-12 {
                return Err(numbers.reject("the quaternion is zero".to_owned()));
            }
            rotations.push([a, b, c, d]);
            let pose = SE2::from_xy(x, y);
            let stamped = plausible_stamp_s(stamp_s).and_then(|stamp_s| {
                let pose = plausible_pose(pose)?;
                Ok(StampedPose { stamp_s, pose })
            });
            poses.push(stamped.map_err(|problem| numbers.reject(problem))?);
        }
        numbers.at_least_one(poses.len())?;
        let is_w_first = numbers
            .names_w_first()
            .unwrap_or_else(|| is_euroc || 10.0 * tilt(&rotations, true) < tilt(&rotations, false));
        for (at, rotation) in poses.iter_mut().zip(&rotations) {
            at.pose = SE2::new(at.pose.x(), at.pose.y(), yaw(rotation, is_w_first));
        }
        Ok(Self { poses })
    }

    /// Writes TUM lines, with the shortest numbers that read back to the same bits.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write_tum(&self, mut target: impl Write) -> std::io::Result<()> {
        for StampedPose { stamp_s, pose } in &self.poses {
            let (sin, cos) = math::sin_cos(pose.theta() / 2.0);
            writeln!(
                target,
                "{stamp_s} {} {} 0 0 0 {sin} {cos}",
                pose.x(),
                pose.y()
            )?;
        }
        Ok(())
    }

    /// The pose at a time, interpolated on the twist between its neighbours; `None` beyond `slack_s` (s) of either end.
    #[must_use]
    pub fn at(&self, stamp_s: f64, slack_s: f64) -> Option<SE2> {
        let after = self.poses.partition_point(|pose| pose.stamp_s < stamp_s);
        match (
            after.checked_sub(1).map(|k| self.poses[k]),
            self.poses.get(after),
        ) {
            (None, Some(next)) => (next.stamp_s - stamp_s <= slack_s).then_some(next.pose),
            (Some(last), None) => (stamp_s - last.stamp_s <= slack_s).then_some(last.pose),
            (Some(last), Some(next)) => {
                let share = (stamp_s - last.stamp_s) / (next.stamp_s - last.stamp_s);
                let motion = last.pose.between(&next.pose);
                Some(last.pose * SE2::exp(&(motion.log() * share)))
            }
            (None, None) => None,
        }
    }

    /// The pose at each stamp of `odometry`: the nearest pose of this trajectory in time, propagated by `odometry`.
    #[must_use]
    pub fn carried_by(&self, odometry: &Self) -> Self {
        if self.poses.is_empty() {
            return self.clone();
        }
        let poses = odometry.poses.iter().filter_map(|now| {
            let nearest = self.nearest(now.stamp_s)?;
            let anchor = odometry.at(nearest.stamp_s, f64::INFINITY)?;
            Some(StampedPose {
                stamp_s: now.stamp_s,
                pose: nearest.pose * anchor.between(&now.pose),
            })
        });
        Self {
            poses: poses.collect(),
        }
    }

    fn nearest(&self, stamp_s: f64) -> Option<StampedPose> {
        let after = self.poses.partition_point(|pose| pose.stamp_s < stamp_s);
        let around = [after.checked_sub(1), Some(after)];
        let near = around
            .into_iter()
            .flatten()
            .filter_map(|k| self.poses.get(k));
        near.min_by(|a, b| {
            let [a, b] = [a, b].map(|pose| (pose.stamp_s - stamp_s).abs());
            a.total_cmp(&b)
        })
        .copied()
    }
}

/// The parts x, y, z and w of four numbers.
fn quaternion(numbers: &[f64; 4], is_w_first: bool) -> [f64; 4] {
    let [a, b, c, d] = *numbers;
    if is_w_first {
        [b, c, d, a]
    } else {
        [a, b, c, d]
    }
}

/// Yaw of a quaternion of any length, rad.
pub(crate) fn yaw(numbers: &[f64; 4], is_w_first: bool) -> f64 {
    let [qx, qy, qz, qw] = quaternion(numbers, is_w_first);
    let sin = 2.0 * (qw * qz + qx * qy);
    let cos = qw * qw + qx * qx - qy * qy - qz * qz;
    math::atan2(sin, cos)
}

/// Mean tilt of rotations: squared sine of half the angle between the body's and the world's upward axis.
fn tilt(rotations: &[[f64; 4]], is_w_first: bool) -> f64 {
    let tilts = rotations.iter().map(|numbers| {
        let [qx, qy, qz, qw] = quaternion(numbers, is_w_first);
        let level = qz * qz + qw * qw;
        let tilted = qx * qx + qy * qy;
        tilted / (tilted + level)
    });
    tilts.sum::<f64>() / rotations.len().max(1) as f64
}

/// Numbers in a line of KITTI's poses.
const KITTI: usize = 12;

/// Reads lines with a fixed count of finite numbers.
pub(crate) struct NumberLines<'a, R> {
    source: R,
    name: &'a str,
    expected: &'static str,
    line: Vec<u8>,
    number: usize,
    /// Whether the last line has commas.
    has_commas: bool,
    /// The line of names, if there is one.
    names: Option<String>,
}

impl<'a, R: BufRead> NumberLines<'a, R> {
    pub(crate) fn new(source: R, name: &'a str, expected: &'static str) -> Self {
        Self {
            source,
            name,
            expected,
            line: Vec::new(),
            number: 0,
            has_commas: false,
            names: None,
        }
    }

    /// Whether the line of names has `qw` before `qx`; `None` if it does not say.
    fn names_w_first(&self) -> Option<bool> {
        let names = self.names.as_ref()?.to_ascii_lowercase();
        Some(names.find("qw")? < names.find("qx")?)
    }

    pub(crate) fn reject(&self, problem: String) -> TextError {
        TextError::Line {
            name: self.name.to_owned(),
            line: self.number,
            problem,
            expected: self.expected,
        }
    }

    pub(crate) fn at_least_one(&self, count: usize) -> Result<(), TextError> {
        if count > 0 {
            return Ok(());
        }
        Err(TextError::Empty {
            name: self.name.to_owned(),
            expected: self.expected,
        })
    }

    /// Returns the numbers of the next line that is neither empty nor a comment.
    pub(crate) fn next_line<const N: usize>(&mut self) -> Result<Option<[f64; N]>, TextError> {
        loop {
            let read =
                next_line(&mut self.source, &mut self.line).map_err(|source| TextError::Io {
                    name: self.name.to_owned(),
                    line: self.number + 1,
                    source,
                })?;
            let Some((end, _)) = read else {
                return Ok(None);
            };
            self.number += 1;
            if end == LineEnd::TooLong {
                return Err(self.reject("the line is longer than 4 MB".to_owned()));
            }
            let text = std::str::from_utf8(&self.line)
                .map_err(|_| self.reject("the line is not UTF-8 text".to_owned()))?;
            let text = text.trim_start_matches('\u{feff}').trim();
            let separates = |c: char| c.is_ascii_whitespace() || c == ',';
            let words = || text.split(separates).filter(|word| !word.is_empty());
            let is_names = self.expected == TUM_LINE
                && self.names.is_none()
                && words().count() >= N
                && words().all(|word| word.parse::<f64>().is_err());
            if is_names {
                self.names = Some(text.to_owned());
                continue;
            }
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            if self.expected == TUM_LINE && words().count() == KITTI {
                let problem = "it has the twelve numbers of KITTI's poses, which have no stamps; write the stamps with them, as evo's kitti_poses_and_timestamps_to_trajectory.py does";
                return Err(self.reject(problem.to_owned()));
            }
            let names = self.expected.split(' ');
            self.has_commas = text.contains(',');
            let mut words = words();
            let mut numbers = [0.0; N];
            for (slot, name) in numbers.iter_mut().zip(names) {
                *slot = finite(words.next(), name).map_err(|problem| self.reject(problem))?;
            }
            return Ok(Some(numbers));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Trajectory, TextError> {
        Trajectory::read_tum(text.as_bytes(), "t.tum")
    }

    fn line(poses: &[(f64, [f64; 3])]) -> Trajectory {
        let stamped = poses.iter().map(|&(stamp_s, [x, y, theta])| StampedPose {
            stamp_s,
            pose: SE2::new(x, y, theta),
        });
        Trajectory::new(stamped.collect())
    }

    #[test]
    fn names_repeated_lines_and_quaternions_with_w_first_are_read() {
        let tum = "1 0.5 0 0 0 0 0.6 0.8\n2 1 0 0 0 0 0 1\n";
        let plain = read(tum).unwrap();
        for text in [
            "timestamp,x,y,z,qx,qy,qz,qw\n1,0.5,0,0,0,0,0.6,0.8\n2,1,0,0,0,0,0,1\n",
            "timestamp,x,y,z,qw,qx,qy,qz\n1,0.5,0,0,0.8,0,0,0.6\n2,1,0,0,1,0,0,0\n",
            "1 0.5 0 0 0.8 0 0 0.6\n2 1 0 0 1 0 0 0\n",
            "1 0.5 0 0 0 0 0.6 0.8\n1 0.5 0 0 0 0 0.6 0.8\n2 1 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n",
        ] {
            assert_eq!(read(text).unwrap(), plain, "{text}");
        }
        let other = read("1 0.5 0 0 0 0 0.6 0.8\n1 0.6 0 0 0 0 0.6 0.8\n").unwrap_err();
        assert!(other.to_string().contains("not later"), "{other}");
        let kitti = read("1 0 0 1.5 0 1 0 1.5 0 0 1 0\n")
            .unwrap_err()
            .to_string();
        assert!(kitti.contains("KITTI"), "{kitti}");
    }

    #[test]
    fn what_is_written_reads_back() {
        let written = line(&[
            (976_052_857.337_284, [0.1, -2.5, 3.1]),
            (976_052_857.347_284, [1e-9, 7.0, -3.1]),
        ]);
        let mut bytes = Vec::new();
        written.write_tum(&mut bytes).unwrap();
        let back = Trajectory::read_tum(&bytes[..], "t").unwrap();
        for (a, b) in written.poses().iter().zip(back.poses()) {
            assert_eq!(a.stamp_s, b.stamp_s);
            assert_eq!((a.pose.x(), a.pose.y()), (b.pose.x(), b.pose.y()));
            // 1e-15: a heading through half an angle, sine and cosine.
            assert!((a.pose.theta() - b.pose.theta()).abs() < 1e-15);
        }
    }

    #[test]
    fn commas_and_the_order_of_euroc_are_read() {
        let tum =
            read("1700000000.5,1,2,0,0,0,0.6,0.8\n1700000001, 1, 2, 0, 0, 0, 0, 1\n").unwrap();
        let euroc = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n\
                     1700000000500000000,1,2,0,0.8,0,0,0.6,9,9\n1700000001000000000,1,2,0,1,0,0,0,9,9\n";
        let euroc = read(euroc).unwrap();
        for (a, b) in tum.poses().iter().zip(euroc.poses()) {
            // 1e-6 s: nanoseconds since 1970 in f64.
            assert!((a.stamp_s - b.stamp_s).abs() < 1e-6);
            assert_eq!(a.pose, b.pose);
        }
        let overflown = "2147483647,1,2,0,1,0,0,0\n2147483647,1,2,0,1,0,0,0\n";
        let message = read(overflown).unwrap_err().to_string();
        assert!(message.contains("overflowed 32 bits"), "{message}");
    }

    #[test]
    fn wrong_lines_are_named() {
        for (text, expected) in [
            ("", "t.tum has no data"),
            ("# only words\n", "t.tum has no data"),
            (
                "1 0 0 0 0 0 0 1\n2 0 0 x 0 0 0 1\n",
                "t.tum: line 2: z must be a finite number",
            ),
            ("1 0 0 0 0 0 0\n", "t.tum: line 1: qw is missing"),
            ("1 0 0 0 0 0 0 0\n", "line 1: the quaternion is zero"),
            ("1 1e9 0 0 0 0 0 1\n", "line 1: a pose must be within"),
            (
                "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n",
                "line 2: the stamp is not later than",
            ),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
    }

    #[test]
    fn between_two_poses_the_body_is_on_an_arc() {
        let quarter = core::f64::consts::FRAC_PI_2;
        // A quarter of the circle about (0, 1).
        let bend = line(&[(0.0, [0.0, 0.0, 0.0]), (2.0, [1.0, 1.0, quarter])]);
        let middle = bend.at(1.0, 0.0).unwrap();
        let half = core::f64::consts::FRAC_1_SQRT_2;
        // 1e-12: a dozen roundings of numbers about 1.
        assert!((middle.x() - half).abs() < 1e-12 && (middle.y() - 1.0 + half).abs() < 1e-12);
        assert_eq!(bend.at(2.5, 0.4), None);
        assert_eq!(bend.at(2.5, 0.5), Some(bend.poses()[1].pose));
    }

    #[test]
    fn keyframes_are_carried_on_by_odometry() {
        let keyframes = line(&[(1.0, [5.0, 5.0, core::f64::consts::FRAC_PI_2])]);
        let odometry = line(&[(1.0, [0.0, 0.0, 0.0]), (2.0, [1.0, 0.0, 0.0])]);
        let carried = keyframes.carried_by(&odometry);
        assert_eq!(carried.poses().len(), 2);
        assert!((carried.poses()[1].pose.x() - 5.0).abs() < 1e-12);
        assert!((carried.poses()[1].pose.y() - 6.0).abs() < 1e-12);
    }
}
