//! A thousand laps by point-to-plane: recorded attempts to close a loop, and rms errors of the front end.
//!
//! `L seed rms_m` begins a lap, and `chi2 position_m heading_deg fits accepted` is an attempt of it.

use std::fs;
use std::sync::OnceLock;

use ch16_lab::lap::{LapConfig, LapMatcher, LapRunner, LoopError, TestedLoop};

use super::recorded::Driven;
use super::sweep::{LapSweep, of_attempts, p99};
use crate::page::document::{path_of, source};

/// A recorded lap.
pub struct Recorded {
    seed: u32,
    rms_m: f64,
    tested: Vec<TestedLoop>,
}

/// The laps of the file.
pub fn recorded() -> &'static [Recorded] {
    static RECORDED: OnceLock<Vec<Recorded>> = OnceLock::new();
    RECORDED.get_or_init(|| {
        let mut laps: Vec<Recorded> = Vec::new();
        for line in source("tests/pinned/sweeps/attempts-p2l.txt").lines() {
            let words: Vec<&str> = line.split(' ').collect();
            let number = |k: usize| words[k].parse::<f64>().expect("a number");
            if words[0] == "L" {
                laps.push(Recorded {
                    seed: number(1) as u32,
                    rms_m: number(2),
                    tested: Vec::new(),
                });
                continue;
            }
            laps.last_mut()
                .expect("a lap begins")
                .tested
                .push(TestedLoop {
                    chi2: number(0),
                    error: LoopError {
                        position_m: number(1),
                        heading_deg: number(2),
                    },
                    fits: number(3) > 0.0,
                    accepted: number(4) > 0.0,
                });
        }
        laps
    })
}

/// `p2l.true_accepted_percent`, `p2l.rms.p99`, `p2l.worse_percent`.
pub fn value(path: &[&str]) -> Option<f64> {
    let ["p2l", what @ ..] = path else {
        return None;
    };
    let laps = recorded();
    match *what {
        ["rms", "p99"] => Some(p99(laps.iter().map(|lap| lap.rms_m).collect())),
        ["worse_percent"] => super::recorded::value("attempts.p2l.worse_percent"),
        _ => {
            let tested: Vec<TestedLoop> = laps.iter().flat_map(|lap| lap.tested.clone()).collect();
            of_attempts(&tested, what)
        }
    }
}

/// Adds the share of the laps whose front end is worse by point-to-plane.
pub fn add_to(driven: &mut Driven, sweep: &LapSweep) {
    let worse: Vec<bool> = sweep
        .front_end_rms_m()
        .map(|(seed, point_m)| {
            let lap = recorded().iter().find(|lap| lap.seed == seed);
            lap.expect("it is recorded").rms_m > point_m
        })
        .collect();
    let count = worse.iter().filter(|&&worse| worse).count();
    let percent = 100.0 * count as f64 / worse.len() as f64;
    driven.add(
        "attempts.p2l",
        [("worse_percent".to_owned(), Some(percent))],
    );
}

/// A number as it is recorded.
fn as_recorded(tested: &TestedLoop) -> [String; 3] {
    let TestedLoop { chi2, error, .. } = tested;
    [
        format!("{chi2:.2}"),
        format!("{:.3}", error.position_m),
        format!("{:.2}", error.heading_deg),
    ]
}

#[test]
fn recorded_laps_by_point_to_plane_are_those_of_the_core() {
    let laps = recorded();
    assert_eq!(laps.len(), 1000);
    let mut runner = LapRunner::new();
    // Every fortieth: all of them take a minute.
    for lap in laps.iter().step_by(40) {
        let config = LapConfig::with_seed_and_noise(lap.seed, 1.0);
        let record = runner.run(&config.with_matcher(LapMatcher::PointToPlane));
        let rms_m = record.front_end.summary.keyframe_rms_m;
        // 1e-4: the last recorded digit.
        assert!((lap.rms_m - rms_m).abs() < 1e-4, "seed {}", lap.seed);
        let tested: Vec<_> = record.lap.tested_loops().collect();
        assert_eq!(tested.len(), lap.tested.len(), "seed {}", lap.seed);
        for (found, recorded) in tested.iter().zip(&lap.tested) {
            assert_eq!(
                as_recorded(found),
                as_recorded(recorded),
                "seed {}",
                lap.seed
            );
            assert_eq!(
                (found.fits, found.accepted),
                (recorded.fits, recorded.accepted)
            );
        }
    }
}

/// The points of the page's figure.
const POINTS: &str = "widgets/sketches/src/attempts.txt";

/// `chi2 error_cm flags` in the order of χ², where 1 is added for a fit, 2 for a false loop.
fn points(sweep: &LapSweep) -> Vec<String> {
    let rows = sweep.attempts().map(|tested| {
        let flags = u8::from(tested.fits) + 2 * u8::from(tested.error.is_false());
        let error_cm = (100.0 * tested.error.position_m).round() as u32;
        ((100.0 * tested.chi2).round() / 100.0, error_cm, flags)
    });
    let mut rows: Vec<(f64, u32, u8)> = rows.collect();
    rows.sort_by(|a, b| a.partial_cmp(b).expect("χ² is a number"));
    let line = |(chi2, error_cm, flags)| format!("{chi2:.2} {error_cm} {flags}");
    rows.into_iter().map(line).collect()
}

/// Writes the points of the page's figure.
pub fn write(sweep: &LapSweep) {
    fs::write(path_of(POINTS), points(sweep).join("\n") + "\n").expect("the points");
}

/// Fails if the page's figure lacks points of these laps, or has more points than all laps.
pub fn check(sample: &LapSweep) {
    let drawn = source(POINTS);
    let mut drawn_lines = drawn.lines();
    for point in points(sample) {
        assert!(
            drawn_lines.any(|line| line == point),
            "{POINTS} lacks {point}"
        );
    }
    let all = super::recorded::value("sweep.once.attempts");
    assert_eq!(Some(drawn.lines().count() as f64), all, "{POINTS}");
}
