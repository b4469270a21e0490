//! The lap against `lap.json`: nine laps, tick by tick and keyframe by keyframe.

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner};
use pr_geom::{SE2, wrap_angle};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

/// Whole laps: hundreds of consecutive registrations propagate the last bits of each.
const TOLERANCE: f64 = 1e-6;

#[derive(Deserialize)]
struct Lap {
    seed: u32,
    noise: f64,
    loops: bool,
    ticks: usize,
    keyframes: usize,
    turn_node: usize,
    odometry_end_error: f64,
    odometry_rms: f64,
    keyframe_end_error: f64,
    keyframe_rms: f64,
    map_disagreement: f64,
    occupied_cells: usize,
    free_cells: usize,
    chi2: f64,
    events: Vec<Event>,
    keyframe_poses: Vec<[f64; 3]>,
    keyframe_truth: Vec<[f64; 3]>,
    keyframe_errors: Vec<f64>,
    per_tick: Vec<Tick>,
}

#[derive(Deserialize)]
struct Event {
    from: usize,
    to: usize,
    chi2: f64,
    rmse: f64,
    inliers: usize,
    accepted: bool,
    max_shift: Option<f64>,
    ate_before: Option<f64>,
    ate_after: Option<f64>,
}

#[derive(Deserialize)]
struct Tick {
    truth: [f64; 3],
    dead_reckoning: [f64; 3],
    estimate: [f64; 3],
    tau: f64,
    inliers: usize,
    rmse: f64,
    iterations: usize,
    keyframe: bool,
}

/// The lap of this workspace, beside the reference.
struct Run {
    expected: Lap,
    record: LapRecord,
}

impl Run {
    fn name(&self) -> String {
        let Lap {
            seed, noise, loops, ..
        } = self.expected;
        format!(
            "seed {seed} ×{noise}{}",
            if loops { "" } else { " without loops" }
        )
    }
}

fn runs() -> Vec<Run> {
    let mut runner = LapRunner::new();
    let run = |expected: Lap| {
        let mut config = LapConfig::with_seed_and_noise(expected.seed, expected.noise);
        if !expected.loops {
            config = config.without_loops();
        }
        let record = runner.run(&config);
        Run { expected, record }
    };
    let laps = reference::<Vec<Lap>>("lap.json");
    assert_eq!(laps.len(), 9);
    laps.into_iter().map(run).collect()
}

fn assert_pose(what: &str, actual: &SE2, expected: &[f64; 3]) {
    let [x, y, theta] = *expected;
    assert_close(&format!("x of {what}"), actual.x(), x, TOLERANCE);
    assert_close(&format!("y of {what}"), actual.y(), y, TOLERANCE);
    let turn = wrap_angle(actual.theta() - theta);
    assert_close(&format!("heading of {what}"), turn, 0.0, TOLERANCE);
}

#[test]
fn every_tick_of_every_lap_is_the_reference_tick() {
    for run in runs() {
        assert_eq!(run.record.lap.reports.len(), run.expected.ticks);
        for (report, expected) in run.record.lap.reports.iter().zip(&run.expected.per_tick) {
            let at = format!("{} tick {}", run.name(), report.tick);
            let close = |what, actual, expected| {
                assert_close(&format!("{what}, {at}"), actual, expected, TOLERANCE);
            };
            let pose = |what, actual, expected| {
                assert_pose(&format!("{what}, {at}"), actual, expected);
            };
            let registration = &report.registration;
            pose("truth", &report.truth, &expected.truth);
            pose(
                "dead reckoning",
                &report.dead_reckoning,
                &expected.dead_reckoning,
            );
            // The reference records tau after the tick's correction.
            close("tau", registration.next_tau_m, expected.tau);
            assert_eq!(registration.matched.iterations, expected.iterations, "{at}");
            assert_eq!(registration.matched.inliers, expected.inliers, "{at}");
            close("rmse", registration.matched.rmse_m, expected.rmse);
            assert_eq!(report.new_keyframe.is_some(), expected.keyframe, "{at}");
            pose("estimate", &report.estimate, &expected.estimate);
        }
    }
}

#[test]
fn every_keyframe_of_every_lap_is_the_reference_keyframe() {
    for run in runs() {
        let (expected, lap) = (&run.expected, &run.record.lap);
        let errors: Vec<f64> = lap.keyframe_errors_m(expected.ticks).collect();
        let poses = lap.poses(expected.ticks);
        assert_eq!(poses.len(), expected.keyframes, "{}", run.name());
        assert_eq!(poses.len(), expected.keyframe_poses.len());
        for (node, pose) in poses.iter().enumerate() {
            let name = format!("{} keyframe {node}", run.name());
            assert_pose(&name, pose, &expected.keyframe_poses[node]);
            assert_pose(
                &name,
                &lap.keyframes[node].truth,
                &expected.keyframe_truth[node],
            );
            assert_close(
                &name,
                errors[node],
                expected.keyframe_errors[node],
                TOLERANCE,
            );
        }
    }
}

#[test]
fn every_loop_event_is_the_reference_event() {
    for run in runs() {
        let attempts: Vec<_> = run.record.lap.loop_attempts().collect();
        assert_eq!(attempts.len(), run.expected.events.len(), "{}", run.name());
        for (attempt, expected) in attempts.into_iter().zip(&run.expected.events) {
            let name = format!("{} loop {} to {}", run.name(), expected.from, expected.to);
            let found = &attempt.verification;
            assert_eq!(found.from_node, expected.from, "{name}");
            assert_eq!(found.candidate.node, expected.to, "{name}");
            assert_eq!(found.inliers, expected.inliers, "{name}");
            assert_eq!(attempt.accepted(), expected.accepted, "{name}");
            assert_close(&name, found.gate.chi2, expected.chi2, TOLERANCE);
            assert_close(&name, found.rmse_m, expected.rmse, TOLERANCE);
            let measured = attempt.effect.map(|effect| {
                let rms = effect.keyframe_rms_m;
                [effect.max_shift_m, rms.before, rms.after]
            });
            let figures = [expected.max_shift, expected.ate_before, expected.ate_after];
            assert_eq!(measured.is_some(), expected.accepted, "{name}");
            for (k, expected) in figures.into_iter().enumerate() {
                assert_eq!(measured.is_some(), expected.is_some(), "{name}");
                if let (Some(measured), Some(expected)) = (measured, expected) {
                    assert_close(&name, measured[k], expected, TOLERANCE);
                }
            }
        }
    }
}

#[test]
fn every_lap_ends_with_the_reference_metrics() {
    for run in runs() {
        let (expected, summary) = (&run.expected, &run.record.lap.summary);
        let name = run.name();
        assert_eq!(summary.ticks, expected.ticks, "{name}");
        assert_eq!(summary.keyframes, expected.keyframes, "{name}");
        assert_eq!(run.record.lap.turn_node, Some(expected.turn_node), "{name}");
        let disagreement = summary.map_disagreement_m.unwrap();
        for (measured, expected) in [
            (summary.odometry_end_error_m, expected.odometry_end_error),
            (summary.odometry_rms_m, expected.odometry_rms),
            (summary.keyframe_end_error_m, expected.keyframe_end_error),
            (summary.keyframe_rms_m, expected.keyframe_rms),
            (disagreement, expected.map_disagreement),
            (run.record.lap.graph_summary.chi2, expected.chi2),
        ] {
            assert_close(&name, measured, expected, TOLERANCE);
        }
    }
}

#[test]
fn every_occupancy_grid_has_the_reference_counts() {
    for run in runs() {
        let grid = run.record.occupancy_grid(run.expected.ticks);
        assert_eq!(
            grid.occupied_cells(),
            run.expected.occupied_cells,
            "{}",
            run.name()
        );
        assert_eq!(grid.free_cells(), run.expected.free_cells, "{}", run.name());
    }
}

/// The chapter prints its results table with two to four digits; the tolerance is half a unit of the last.
#[test]
fn the_canonical_run_has_the_values_of_the_chapter() {
    let record = LapRunner::new().run(&LapConfig::default());
    let (lap, front_end) = (&record.lap.summary, &record.front_end.summary);
    assert_eq!((lap.ticks, lap.keyframes), (129, 41));
    let loops = [&record.lap, &record.front_end].map(|run| run.graph_summary.loops);
    assert_eq!(loops, [3, 0]);
    for (what, measured, printed, half_unit) in [
        ("odometry, end", lap.odometry_end_error_m, 2.4110, 5e-5),
        (
            "front end, end",
            front_end.keyframe_end_error_m,
            0.7334,
            5e-5,
        ),
        ("loops, end", lap.keyframe_end_error_m, 0.2389, 5e-5),
        ("odometry, rms", lap.odometry_rms_m, 1.1826, 5e-5),
        ("front end, rms", front_end.keyframe_rms_m, 0.6444, 5e-5),
        ("loops, rms", lap.keyframe_rms_m, 0.5857, 5e-5),
        (
            "front end, best of the last nine",
            front_end.last_keyframes_m.0,
            0.54,
            5e-3,
        ),
        (
            "front end, worst of the last nine",
            front_end.last_keyframes_m.1,
            0.75,
            5e-3,
        ),
        (
            "loops, best of the last nine",
            lap.last_keyframes_m.0,
            0.17,
            5e-3,
        ),
        (
            "loops, worst of the last nine",
            lap.last_keyframes_m.1,
            0.34,
            5e-3,
        ),
        ("front end, largest", front_end.keyframe_max_m, 0.85, 5e-3),
        ("loops, largest", lap.keyframe_max_m, 0.89, 5e-3),
        (
            "front end, map",
            front_end.map_disagreement_m.unwrap(),
            0.2377,
            5e-5,
        ),
        ("loops, map", lap.map_disagreement_m.unwrap(), 0.0817, 5e-5),
    ] {
        assert_close(what, measured, printed, half_unit);
    }
    let printed_loops = [
        (29, 7, 4.236, 0.239),
        (33, 6, 0.421, 0.103),
        (37, 2, 1.125, 0.177),
    ];
    for (attempt, (from, to, chi2, shift)) in record.lap.loop_attempts().zip(printed_loops) {
        let found = &attempt.verification;
        assert_eq!((found.from_node, found.candidate.node), (from, to));
        assert_close("chi2", found.gate.chi2, chi2, 5e-4);
        assert_close("shift", attempt.effect.unwrap().max_shift_m, shift, 5e-4);
    }
}

/// Not a value of the reference: the native bits of this implementation. `tests/wasm` checks that WebAssembly
/// has the same ones, also after the solver's loops. Any change of the order of operations changes this
/// number; then the values above decide whether the change was right.
#[test]
fn the_bits_of_the_front_end_are_those_that_were_recorded() {
    let record = LapRunner::new().run(&LapConfig::default());
    assert_eq!(
        format!("{:016x}", record.front_end.digest()),
        "225161fddc20f41b"
    );
}
