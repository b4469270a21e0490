//! The result in words and numbers.

use ch16_lab::lap::{
    BuiltInWorld, LoopJudgement, OwnLoopError, RecordedLoopAttempt, RecordedLoopEffect,
};
use ch16_slam2d::loops::GateModel;
use widget_kit::model::{Assessment, Fact, Outcome};
use widget_kit::plural::plural;

use super::moment::{LapState, WrongPlace};
use super::runs::Runs;
use crate::w16_2_full_lap::spec::Layers;

pub mod floor_plan;
pub mod parts;

pub use parts::part_label;

/// The main statement: an assessment, a verdict in a word or two, and a sentence.
pub struct Statement {
    /// Good or bad.
    pub standing: Assessment,
    /// One or two words.
    pub verdict: String,
    /// One sentence.
    pub sentence: String,
}

/// `29 to 7`: the new node and the old one.
pub fn ends(attempt: &RecordedLoopAttempt) -> String {
    let loop_ = &attempt.verification;
    format!("{} to {}", loop_.from_node, loop_.candidate.node)
}

/// `path` or `exact`.
pub fn model_name(model: GateModel) -> &'static str {
    match model {
        GateModel::PathApproximation => "path",
        GateModel::ExactMarginal => "exact",
    }
}

/// Good is an accepted loop that is right, bad an accepted one that is wrong.
pub fn standing(judgement: LoopJudgement) -> Assessment {
    match judgement {
        LoopJudgement::Right => Assessment::Good,
        LoopJudgement::FalseAcceptance => Assessment::Bad,
        LoopJudgement::Rejected => Assessment::Neutral,
    }
}

/// The result at a tick: of the selected part, else of the custom loop, else of the loop tried in the tick,
/// else of the estimates. `rejected` is the reason why the custom loop is impossible.
pub fn outcome(moment: &LapState, rejected: Option<&OwnLoopError>) -> Outcome {
    let Statement {
        standing,
        verdict,
        sentence,
    } = match &moment.drawn {
        Some(drawn) => floor_plan::statement(drawn, statement(moment, rejected)),
        None => statement(moment, rejected),
    };
    let (runs, tick) = (moment.runs, moment.tick);
    let sentence = match runs.driver {
        Some(yours) => format!("with your {yours}, {sentence}"),
        None => sentence,
    };
    let mut facts = moment_facts(runs, tick);
    facts.extend(loop_facts(runs, tick));
    facts.extend(parts::facts(moment));
    Outcome {
        standing,
        verdict,
        sentence,
        facts,
    }
}

fn statement(moment: &LapState, rejected: Option<&OwnLoopError>) -> Statement {
    let (runs, tick) = (moment.runs, moment.tick);
    let neutral = |verdict: &str, sentence| Statement {
        standing: Assessment::Neutral,
        verdict: verdict.to_owned(),
        sentence,
    };
    if let Some(part) = moment.picked {
        return parts::part_statement(moment, part);
    }
    if let Some(own) = moment.own {
        return parts::own_statement(moment, own);
    }
    if let Some(rejected) = rejected {
        return neutral("no loop of your own", rejected.to_string());
    }
    if let Some(wrong) = moment.wrong_place() {
        return Statement {
            standing: Assessment::Bad,
            verdict: wrong_words(&wrong),
            sentence: lap_sentence(runs),
        };
    }
    let lap = runs.graph.lap();
    match moment.attempt {
        Some(attempt) => {
            let judgement = lap.judge(attempt);
            Statement {
                standing: standing(judgement),
                verdict: judgement.to_string(),
                sentence: lap.loop_sentence(attempt),
            }
        }
        None if tick == runs.ticks() => neutral("lap finished", lap_sentence(runs)),
        None => neutral("on the way", tick_sentence(runs, tick)),
    }
}

/// `9.3 m off` or `false loop 80 to 12`.
pub fn wrong_words(wrong: &WrongPlace) -> String {
    match wrong {
        WrongPlace::Keyframe(off_m) => format!("{off_m:.1} m off"),
        WrongPlace::Loop(attempt) => format!("false loop {}", ends(attempt)),
    }
}

fn tick_sentence(runs: &Runs, tick: usize) -> String {
    format!(
        "tick {tick} of {}: odometry is {:.2} m off, the front end alone {:.2} m, the pose graph {:.2} m",
        runs.ticks(),
        runs.odometry_errors_m[tick],
        runs.front_end.errors_m[tick],
        runs.graph.errors_m[tick],
    )
}

fn lap_sentence(runs: &Runs) -> String {
    let summary = runs.graph.summary();
    format!(
        "{}; its end is {:.2} m off, its worst keyframe {:.2} m. Rms over the keyframes {:.2} m, map disagreement {:.2} m",
        loops_in_words(runs.graph.lap().graph_summary.loops),
        summary.keyframe_end_error_m,
        summary.keyframe_max_m,
        summary.keyframe_rms_m,
        summary.map_disagreement_m.unwrap_or(f64::NAN),
    )
}

fn loops_in_words(count: usize) -> String {
    match count {
        0 => "no loop closed".to_owned(),
        _ => format!("{} closed", plural(count, "loop")),
    }
}

fn moment_facts(runs: &Runs, tick: usize) -> Vec<Fact> {
    vec![
        Fact::metres(
            "odometry_error_m",
            "odometry error now",
            runs.odometry_errors_m[tick],
        ),
        Fact::metres(
            "front_end_error_m",
            "front end error now",
            runs.front_end.errors_m[tick],
        ),
        Fact::metres(
            "graph_error_m",
            "pose graph error now",
            runs.graph.errors_m[tick],
        ),
        Fact::metres(
            "keyframe_rms_m",
            "rms over keyframes",
            runs.graph.keyframe_rms_m[tick],
        ),
        Fact::metres(
            "map_disagreement_m",
            "map disagreement",
            runs.graph.disagreement_m[tick],
        ),
        Fact::count(
            "keyframes",
            "keyframes",
            runs.graph.keyframes_until(tick) as f64,
        ),
        Fact::count(
            "loops_closed",
            "loops closed",
            runs.graph.accepted_until(tick) as f64,
        ),
        Fact::count(
            "false_loops",
            "of these, false",
            runs.false_loops_until(tick) as f64,
        ),
        Fact::new("gate_chi2", "gate χ²", runs.gate_chi2(), "", 3),
        Fact::count(
            "line",
            "last algorithm line that ran",
            last_line(runs, tick),
        ),
    ]
}

/// The last line of the algorithm on the page that ran in a tick, from 1: predict and register, the test for a keyframe,
/// a node and its edge, a candidate verified, its edge and the optimum, the push. 0 at the start.
fn last_line(runs: &Runs, tick: usize) -> f64 {
    let report = runs.graph.lap().report(tick);
    report.map_or(0.0, |report| {
        match (report.new_keyframe, &report.loop_attempt) {
            (None, _) => 2.0,
            (Some(_), None) => 3.0,
            (Some(_), Some(attempt)) if attempt.accepted() => 6.0,
            (Some(_), Some(_)) => 4.0,
        }
    })
}

/// Facts of the newest attempt; not finite before the first one, because the list of facts is fixed.
fn loop_facts(runs: &Runs, tick: usize) -> Vec<Fact> {
    let attempt = runs.graph.newest_attempt(tick);
    let of = |read: &dyn Fn(&RecordedLoopAttempt) -> f64| attempt.map_or(f64::NAN, read);
    let of_effect = |read: &dyn Fn(&RecordedLoopEffect) -> f64| {
        let effect = attempt.and_then(|attempt| attempt.effect.as_ref());
        effect.map_or(f64::NAN, read)
    };
    let error = |attempt: &RecordedLoopAttempt| runs.graph.lap().loop_error(attempt);
    let chi2 = of(&|attempt| attempt.verification.gate.chi2);
    let path = of(&|attempt| runs.gates(attempt).path.test.chi2);
    let exact = of(&|attempt| runs.gates(attempt).exact.test.chi2);
    let pairs = of(&|attempt| attempt.verification.inliers as f64);
    vec![
        Fact::new("chi2", "last loop: χ²", chi2, "", 3),
        Fact::new("chi2_path", "last loop: χ², path gate", path, "", 3),
        Fact::new("chi2_exact", "last loop: χ², exact gate", exact, "", 3),
        Fact::metres(
            "loop_rmse_m",
            "last loop: rmse",
            of(&|attempt| attempt.verification.rmse_m),
        ),
        Fact::count("loop_pairs", "last loop: pairs", pairs),
        Fact::metres(
            "loop_error_m",
            "last loop: position error",
            of(&|attempt| error(attempt).position_m),
        ),
        Fact::new(
            "loop_turn_deg",
            "last loop: heading error",
            of(&|attempt| error(attempt).heading_deg),
            "°",
            1,
        ),
        Fact::metres(
            "shift_m",
            "last loop: history moved",
            of_effect(&|effect| effect.max_shift_m),
        ),
        Fact::metres(
            "rms_before_m",
            "last loop: keyframe rms before",
            of_effect(&|effect| effect.keyframe_rms_m.before),
        ),
        Fact::metres(
            "rms_after_m",
            "last loop: keyframe rms after",
            of_effect(&|effect| effect.keyframe_rms_m.after),
        ),
    ]
}

/// The picture in words.
pub fn summary(moment: &LapState) -> String {
    let (runs, tick) = (moment.runs, moment.tick);
    let truth = runs.truth(tick);
    let way = if runs.is_way_back(tick) {
        "on its return leg"
    } else {
        "on its outbound leg"
    };
    let mut rest = String::new();
    if moment.has_moved() && moment.layers != Layers::Wheels {
        rest += &format!(
            " A line at {:.0}% of the map's width separates the map before the loop, on the left, from the map after it.",
            100.0 * moment.wipe
        );
    }
    rest += match moment.layers {
        Layers::Wheels => " Only the truth and the odometry are shown.",
        Layers::Map => " Only the map and the path are shown.",
        Layers::Loops => "",
        Layers::Truth => " The truth is shown as well.",
        Layers::All => " The truth, the odometry and the front end alone are shown as well.",
    };
    if let Some(drawn) = &moment.drawn {
        rest += &floor_plan::summary(drawn);
    }
    format!(
        "{}. At tick {tick} of {} the robot is at x {:.1} m, y {:.1} m, {way}. \
         The pose graph has {}, and {} tried.{rest}",
        place_words(runs),
        runs.ticks(),
        truth.x(),
        truth.y(),
        plural(runs.graph.keyframes_until(tick), "keyframe"),
        match moment.loops_tried().count() {
            0 => "no loop was".to_owned(),
            1 => "one loop was".to_owned(),
            more => format!("{more} loops were"),
        },
    )
}

/// `Map of the Apartment, 12 m by 9 m, with a corridor along its middle`.
fn place_words(runs: &Runs) -> String {
    let bounds = runs.world().bounds();
    let [width, height] = [bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y];
    let looks = match runs.place() {
        Some(BuiltInWorld::Apartment) => ", with a corridor along its middle",
        Some(BuiltInWorld::Ring) => " around a block of rooms",
        Some(BuiltInWorld::TwinRooms) => " on a corridor, side by side",
        Some(BuiltInWorld::Corridor) => " without a door or a pillar",
        Some(BuiltInWorld::Hall) => " without a corner",
        None => "",
    };
    let label = runs.place_label();
    format!("Map of {label}, {width:.1} m by {height:.1} m{looks}")
}
