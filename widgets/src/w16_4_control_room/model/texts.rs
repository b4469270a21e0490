//! The result in words and numbers.

use ch16_lab::lap::TickReport;
use ch16_slam2d::matching::MatchSummary;
use widget_kit::model::{Assessment, Fact, Outcome};

use super::ControlRoom;
use super::picture::parts;

/// The result at a tick: of its loop if one is tried, else of the estimates.
pub fn outcome(room: &ControlRoom) -> Outcome {
    let event = room.loop_event();
    let attempt = room.now().and_then(|report| report.loop_attempt.as_ref());
    let verdict = match attempt {
        Some(attempt) => room.record.lap.judge(attempt).to_string(),
        None if room.tick() == room.record.ticks() => "run finished".to_owned(),
        None => "on the way".to_owned(),
    };
    let mut sentence = event.map_or_else(|| tick_sentence(room), |event| event.text.clone());
    if let Some(data) = part_sentence(room) {
        let end = if sentence.ends_with('.') { " " } else { ". " };
        sentence = sentence + end + &data;
    }
    Outcome {
        standing: event.map_or(Assessment::Neutral, |event| event.standing),
        verdict,
        sentence,
        facts: facts(room),
    }
}

/// The picture in words.
pub fn summary(room: &ControlRoom) -> String {
    format!(
        "{} At tick {} of {} the newest sweep has {} matches in the local map.",
        room.grid.words(),
        room.tick(),
        room.record.ticks(),
        room.now().map_or(0, |r| r.registration.matched.inliers),
    )
}

/// The data of the selected part in the current tick.
fn part_sentence(room: &ControlRoom) -> Option<String> {
    let (name, data) = parts::data(room.now()?).nth(room.part())?;
    let (first, rest) = name.split_at(1);
    Some(format!("{}{rest}: {data}.", first.to_uppercase()))
}

fn tick_sentence(room: &ControlRoom) -> String {
    let Some(report) = room.now() else {
        return "The run is about to start, with one sweep taken.".to_owned();
    };
    format!(
        "Tick {} of {}: keyframe {}, the estimate is {:.2} m off, odometry {:.2} m.",
        report.tick,
        room.record.ticks(),
        room.record.lap.node_count(report.tick) - 1,
        report.metrics.estimate_error_m,
        report.metrics.odometry_error_m,
    )
}

fn facts(room: &ControlRoom) -> Vec<Fact> {
    let report = room.now();
    let of = |value: &dyn Fn(&TickReport) -> f64| report.map_or(f64::NAN, value);
    // The start is known, so its error is zero.
    let error = |value: &dyn Fn(&TickReport) -> f64| report.map_or(0.0, value);
    let matched = |value: fn(&MatchSummary) -> f64| of(&|r| value(&r.registration.matched));
    let disagreement = |r: &TickReport| r.metrics.map_disagreement_m.unwrap_or(f64::NAN);
    let mut facts = vec![
        Fact::metres("tau_m", "threshold τ", of(&|r| r.registration.tau_m)),
        Fact::count("pairs", "pairs", matched(|found| found.inliers as f64)),
        Fact::metres("rmse_m", "rmse", matched(|found| found.rmse_m)),
        Fact::count(
            "iterations",
            "iterations",
            matched(|found| found.iterations as f64),
        ),
    ];
    facts.extend(room.grid.facts());
    facts.extend([
        Fact::metres(
            "estimate_error_m",
            "estimate off by",
            error(&|r| r.metrics.estimate_error_m),
        ),
        Fact::metres(
            "odometry_error_m",
            "odometry off by",
            error(&|r| r.metrics.odometry_error_m),
        ),
        Fact::metres("map_disagreement_m", "map disagreement", of(&disagreement)),
    ]);
    facts
}
