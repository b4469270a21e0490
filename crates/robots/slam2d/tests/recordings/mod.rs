//! Recordings with one typical fault each, and the required result.

mod base;
mod connected;
mod damage;
mod field;
mod instead;
mod live;
mod robot;
mod robots;
mod shown;
mod sweeps;
mod tables;
mod variants;
mod write;

use ch16_lab::lap::{Drive, DriveConfig};
use pr_geom::{Point2, SE2};
use robot_io::log::{LogOptions, LogReader};
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::run::LogRun;

/// Messages per chunk.
const PER_CHUNK: usize = 40;
/// Largest error, m; and by scans alone.
const NEAR_M: f64 = 0.1;
const BY_SCANS_M: f64 = 0.15;

/// Result of a recording: the pose of each scan, and the messages for the user.
pub struct Mapped {
    /// Stamps (s) and poses.
    pub path: Vec<(f64, SE2)>,
    /// Sentences, or the error.
    pub notes: String,
}

/// Maps a recording as `slam2d run` does.
pub fn mapped(parts: Vec<LogBytes<'_>>, name: &str, options: &LogOptions) -> Mapped {
    let mut run = LogRun::default();
    let rejected = |notes: String| Mapped {
        path: Vec::new(),
        notes,
    };
    let reader = match LogFormat::open_parts(parts, name, options) {
        Ok(reader) => reader,
        Err(problem) => return rejected(problem.to_string()),
    };
    let mut reader = ComparedReader::new(reader, options.laser.is_some());
    loop {
        match reader.next_frame() {
            Ok(Some(frame)) => {
                run.step(frame);
            }
            Ok(None) => break,
            Err(problem) => return rejected(problem.to_string()),
        }
    }
    run.finish();
    let mut notes = reader.notes().sentences(name);
    notes.extend(run.sentences(name));
    let path = run.trajectory();
    Mapped {
        path: path
            .poses()
            .iter()
            .map(|at| (at.stamp_s, at.pose))
            .collect(),
        notes: notes.join("\n"),
    }
}

/// RMS distance between paths after the best rigid alignment of the first with the second, m.
/// Mirror images do not count as rigid.
pub fn distance_m(path: &[SE2], truth: &[SE2]) -> f64 {
    assert_eq!(path.len(), truth.len());
    let mean = |of: &[SE2]| {
        let sum = of
            .iter()
            .fold((0.0, 0.0), |sum, pose| (sum.0 + pose.x(), sum.1 + pose.y()));
        Point2::new(sum.0 / of.len() as f64, sum.1 / of.len() as f64)
    };
    let (from, to) = (mean(path), mean(truth));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (a, b) in path.iter().zip(truth) {
        let (a, b) = (a.position() - from, b.position() - to);
        dot += a.dot(&b);
        cross += a.x * b.y - a.y * b.x;
    }
    let turn = SE2::new(0.0, 0.0, cross.atan2(dot));
    let squares = path.iter().zip(truth).map(|(a, b)| {
        let moved = turn.transform(Point2::from(a.position() - from));
        (moved.coords - (b.position() - to)).norm_squared()
    });
    (squares.sum::<f64>() / path.len() as f64).sqrt()
}

/// The simulated drive that every variant is based on.
pub fn drive() -> Drive {
    Drive::simulate(&DriveConfig::default())
}

pub fn read(bytes: &[u8], options: &LogOptions) -> Mapped {
    mapped(vec![LogBytes::from(bytes)], "x.mcap", options)
}

pub fn path(outcome: &Mapped) -> Vec<SE2> {
    outcome.path.iter().map(|(_, pose)| *pose).collect()
}
