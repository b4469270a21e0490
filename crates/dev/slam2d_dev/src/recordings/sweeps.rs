//! Sweeps that take a large part of the time between two scans.

use ch16_lab::sweeping::{EARLY, LATE, SweepCase, SweepErrors};
use ch16_slam2d::pipeline::Pipeline;
use pr_geom::SE2;
use rayon::prelude::*;
use robot_io::evaluate::{Alignment, truth_errors};
use robot_io::trajectory::{StampedPose, Trajectory};

/// Sweep over period.
const SHARES: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25];

/// Scanners and motions, in words.
fn rows() -> [(&'static str, SweepCase); 10] {
    let rest = SweepCase::default();
    let drive = SweepCase {
        turn_rad_s: 0.6,
        ..rest
    };
    let weave = SweepCase {
        weave_rad: 0.5,
        ..drive
    };
    [
        ("at rest, 10 Hz, 360 beams", rest),
        ("at rest, walls seen late", SweepCase { view: LATE, ..rest }),
        (
            "driving, 2 Hz",
            SweepCase {
                rate_hz: 2.0,
                ..drive
            },
        ),
        (
            "driving, 5 Hz, 1,440 beams",
            SweepCase {
                rate_hz: 5.0,
                beams: 1440,
                ..drive
            },
        ),
        ("driving, 10 Hz", drive),
        (
            "driving, 12 Hz, 90 beams",
            SweepCase {
                rate_hz: 12.0,
                beams: 90,
                ..drive
            },
        ),
        (
            "driving, walls seen early",
            SweepCase {
                view: EARLY,
                ..drive
            },
        ),
        (
            "driving, walls seen late",
            SweepCase {
                view: LATE,
                ..drive
            },
        ),
        (
            "driving, 5 Hz, stamps off by up to 45 % of the period",
            SweepCase {
                rate_hz: 5.0,
                jitter: 0.45,
                ..drive
            },
        ),
        ("weaving at up to 2.1 rad/s, 10 Hz", weave),
    ]
}

/// Maps a recording by scans alone, or with the odometry, as `slam2d run` does.
fn mapped(case: &SweepCase, has_odometry: bool) -> SweepErrors {
    let (frames, truth) = case.recording();
    let mut pipeline = Pipeline::default();
    let estimates = frames.iter().enumerate().filter_map(|(number, frame)| {
        let mut frame = frame.clone();
        if has_odometry {
            let next = frames.get(number + 1);
            frame.scan.velocity = next.and_then(|next| frame.velocity_until(next));
        } else {
            frame.odometry = None;
        }
        let report = pipeline.step(&frame).ok()?;
        Some(truth[0] * report.estimate)
    });
    let estimates: Vec<SE2> = estimates.collect();
    let worst_m = aligned_error_m(&estimates, &truth);
    SweepErrors {
        worst_m,
        ..SweepErrors::new(&estimates, &truth)
    }
}

/// Largest position error after alignment, m: the first scan, whose motion is unknown, turns the whole map.
fn aligned_error_m(estimates: &[SE2], truth: &[SE2]) -> f64 {
    let path = |poses: &[SE2]| {
        let stamped = poses.iter().zip(0_u32..);
        let stamped = stamped.map(|(&pose, number)| StampedPose {
            stamp_s: f64::from(number),
            pose,
        });
        Trajectory::new(stamped.collect())
    };
    let errors = truth_errors(&path(estimates), &path(truth), Alignment::Se2);
    errors.map_or(f64::NAN, |errors| errors.ate.max)
}

/// Largest error and path by the sweep over the period.
fn row(name: &str, case: &SweepCase, has_odometry: bool) -> String {
    let runs = SHARES.map(|share| mapped(&SweepCase { share, ..*case }, has_odometry));
    let cells = runs.map(|run| format!("{:.3}, {:.1}", run.worst_m, run.path_m));
    format!("| {name} | {:.1} | {} |", runs[0].true_m, cells.join(" | "))
}

/// Largest error and path of each scanner by its sweep over its period, in Markdown.
pub fn table() -> String {
    let shares = SHARES.map(|share| format!("{share} | "));
    let mut lines = vec![
        format!("| scanner | true path | {}", shares.concat().trim_end()),
        format!("| --- | ---: |{}", " ---: |".repeat(SHARES.len())),
    ];
    let rows = rows();
    let alone = rows.par_iter().map(|(name, case)| row(name, case, false));
    lines.extend(alone.collect::<Vec<String>>());
    let (name, weaving) = rows[rows.len() - 1];
    lines.push(row(&format!("{name}, with odometry"), &weaving, true));
    lines.join("\n")
}
