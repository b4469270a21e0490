//! A whole lap as JSON, for the pictures that the page itself draws.
//!
//! The page replays it tick by tick and interpolates only what a loop moves. Values are in metres and radians
//! in the world's frame, rounded to a tenth of a millimetre: less than a pixel of any screen.

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner, LapTrace, RecordedLoopAttempt};
use ch16_slam2d::cloud::PointCloud;
use pr_geom::SE2;
use serde_json::{Value, json};

/// The lap of a seed, with all data for a drawing of it.
///
/// `walls` are the true ones, `[x0, y0, x1, y1]`. `ticks` begin with the start; each contains the true pose,
/// the dead-reckoned one and the estimate, `[x, y, θ]`, and the points of its sweep in the body frame, `[x0,
/// y0, x1, y1, …]`. `keyframes` are ticks. `epochs` contain the poses of all nodes from their first tick on,
/// `loops` the closed ones, and `turn` is the last node of the outward path.
#[must_use]
pub fn story(seed: u32, noise_factor: f64) -> Value {
    let record = LapRunner::new().run(&LapConfig::with_seed_and_noise(seed, noise_factor));
    let lap = &record.lap;
    let world = &record.drive.config().world;
    let walls = world.walls().iter().map(|wall| {
        let ends = [wall.start.x, wall.start.y, wall.end.x, wall.end.y];
        Value::from(ends.map(short).to_vec())
    });
    let epochs = lap.epochs.iter().map(|epoch| {
        let poses: Vec<Value> = epoch.poses.iter().map(pose).collect();
        json!({ "tick": epoch.first_tick, "poses": poses })
    });
    let closed = lap.loop_attempts().filter(|attempt| attempt.accepted());
    let keyframes: Vec<usize> = lap.keyframes.iter().map(|keyframe| keyframe.tick).collect();
    json!({
        "walls": walls.collect::<Vec<_>>(),
        "ticks": (0..=record.ticks()).map(|at| tick(&record, at)).collect::<Vec<_>>(),
        "keyframes": keyframes,
        "epochs": epochs.collect::<Vec<_>>(),
        "loops": closed.map(|attempt| closure(lap, attempt)).collect::<Vec<_>>(),
        "turn": lap.turn_node,
    })
}

fn tick(record: &LapRecord, at: usize) -> Value {
    let start = record.drive.config().start;
    let report = record.lap.report(at);
    json!({
        "truth": pose(&record.drive.truth(at)),
        "wheels": pose(&report.map_or(start, |report| report.dead_reckoning)),
        "estimate": pose(&report.map_or(start, |report| report.estimate)),
        "sweep": points(&record.drive.sweep(at).cloud),
    })
}

fn closure(lap: &LapTrace, attempt: &RecordedLoopAttempt) -> Value {
    let found = &attempt.verification;
    json!({
        "tick": attempt.tick,
        "from": found.from_node,
        "to": found.candidate.node,
        "shift": attempt.effect.map(|effect| short(effect.max_shift_m)),
        "false": lap.loop_error(attempt).is_false(),
    })
}

fn points(cloud: &PointCloud) -> Vec<Value> {
    let points = (0..cloud.len()).map(|index| cloud.point(index));
    points
        .flat_map(|point| [short(point.x), short(point.y)])
        .collect()
}

/// `[x, y, θ]`, to a tenth of a millimetre.
pub fn pose(pose: &SE2) -> Value {
    Value::from(vec![short(pose.x()), short(pose.y()), short(pose.theta())])
}

/// A length to a tenth of a millimetre.
pub fn short(value: f64) -> Value {
    Value::from((value * 1e4).round() / 1e4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_lab::lap::CANONICAL_SEED;

    #[test]
    fn the_story_has_a_pose_of_each_kind_for_every_tick_and_the_loops_of_the_lap() {
        let lap = story(CANONICAL_SEED, 1.0);
        let record = LapRunner::new().run(&LapConfig::default());
        let ticks = lap["ticks"].as_array().unwrap();
        assert_eq!(ticks.len(), record.ticks() + 1);
        // 5.1e-5: half of the last digit, and the rounding of the decimal number itself.
        let is_near =
            |written: &Value, value: f64| (written.as_f64().unwrap() - value).abs() < 5.1e-5;
        for (tick, report) in ticks[1..].iter().zip(&record.lap.reports) {
            assert!(is_near(&tick["wheels"][0], report.dead_reckoning.x()));
            assert!(is_near(&tick["estimate"][1], report.estimate.y()));
        }
        let loops = lap["loops"].as_array().unwrap();
        assert_eq!(loops.len(), record.lap.graph_summary.loops);
        assert_eq!(loops.len() + 1, lap["epochs"].as_array().unwrap().len());
        assert!(is_near(&loops[0]["shift"], 0.2389));
    }

    #[test]
    fn two_numbers_of_a_sweep_are_a_point() {
        let lap = story(CANONICAL_SEED, 1.0);
        for tick in lap["ticks"].as_array().unwrap() {
            let numbers = tick["sweep"].as_array().unwrap().len();
            assert!(numbers > 60 && numbers % 2 == 0);
        }
    }
}
