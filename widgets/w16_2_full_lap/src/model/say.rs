//! The result in words and numbers.

use ch16_slam2d::loops::{GateModel, LoopRejection, LoopVerification};
use ch16_slam2d::slam::{FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG, LoopAttempt, LoopEffect};
use kit::model::{Fact, Outcome, Standing};

use super::runs::Runs;

/// `29 to 7`: the new node and the old one.
pub fn ends(attempt: &LoopAttempt) -> String {
    let loop_ = &attempt.verification;
    format!("{} to {}", loop_.from_node, loop_.candidate.node)
}

/// `loop 29 to 7 accepted`: the name of a mark on the timeline.
pub fn mark(attempt: &LoopAttempt) -> String {
    format!("loop {} {}", ends(attempt), verdict(attempt))
}

/// `accepted` or `rejected`.
pub fn verdict(attempt: &LoopAttempt) -> &'static str {
    if attempt.accepted() {
        "accepted"
    } else {
        "rejected"
    }
}

/// `path` or `exact`.
pub fn model_name(model: GateModel) -> &'static str {
    match model {
        GateModel::PathApproximation => "path",
        GateModel::ExactMarginal => "exact",
    }
}

/// Good is an accepted loop that is right, bad an accepted one that is wrong.
pub fn standing(runs: &Runs, attempt: &LoopAttempt) -> Standing {
    let error = runs.loop_error(attempt);
    let wrong = error.position_m > FALSE_LOOP_DISTANCE_M || error.heading_deg > FALSE_LOOP_TURN_DEG;
    match (attempt.accepted(), wrong) {
        (false, _) => Standing::Neutral,
        (true, false) => Standing::Good,
        (true, true) => Standing::Bad,
    }
}

/// What happened in an attempt: candidate, χ² against the gate, and what came of it.
pub fn attempt_sentence(attempt: &LoopAttempt) -> String {
    let loop_ = &attempt.verification;
    let head = mark(attempt);
    let gate = gate_words(loop_);
    match (&attempt.effect, loop_.rejection) {
        (Some(effect), _) => {
            format!("{head}, {gate}, history moved {:.2} m", effect.max_shift_m)
        }
        (None, Some(LoopRejection::PoorFit { rmse_m, max_rmse_m })) => format!(
            "{head}: {gate}, but the sweep fits to {rmse_m:.3} m only, {max_rmse_m:.2} m is asked"
        ),
        (
            None,
            Some(LoopRejection::FewInliers {
                inliers,
                min_inliers,
            }),
        ) => format!("{head}: {gate}, but only {inliers} pairs of {min_inliers}"),
        (None, _) => format!("{head}: {gate}"),
    }
}

fn gate_words(loop_: &LoopVerification) -> String {
    let gate = &loop_.gate;
    let side = if gate.passes() { "below" } else { "above" };
    format!("chi-squared {:.2} {side} {:.3}", gate.chi2, gate.gate_chi2)
}

/// The result at a tick: of the loop where one is tried in it, of the estimates where none is.
pub fn outcome(runs: &Runs, tick: usize) -> Outcome {
    let (standing, verdict, sentence) = match runs.graph.attempt_at(tick) {
        Some(attempt) => {
            let verdict = match (attempt.accepted(), standing(runs, attempt)) {
                (true, Standing::Bad) => "wrong loop accepted",
                (true, _) => "loop accepted",
                (false, _) => "loop rejected",
            };
            (standing(runs, attempt), verdict, attempt_sentence(attempt))
        }
        None if tick == runs.ticks() => (Standing::Neutral, "lap finished", lap_sentence(runs)),
        None => (Standing::Neutral, "on the way", tick_sentence(runs, tick)),
    };
    let mut facts = moment_facts(runs, tick);
    facts.extend(loop_facts(runs, tick));
    Outcome {
        standing,
        verdict: verdict.to_owned(),
        sentence,
        facts,
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
        "lap finished with {}: end error {:.2} m, rms over the keyframes {:.2} m, largest {:.2} m, map disagreement {:.2} m",
        loops_in_words(summary.loops),
        summary.keyframe_end_error_m,
        summary.keyframe_rms_m,
        summary.keyframe_max_m,
        summary.map_disagreement_m.unwrap_or(f64::NAN),
    )
}

fn loops_in_words(count: usize) -> String {
    match count {
        0 => "no loop closed".to_owned(),
        1 => "1 loop closed".to_owned(),
        _ => format!("{count} loops closed"),
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
        Fact::new("gate_chi2", "gate χ²", runs.gate_chi2(), "", 3),
    ]
}

/// Of the newest attempt; not finite before the first one, so that the list never changes.
fn loop_facts(runs: &Runs, tick: usize) -> Vec<Fact> {
    let attempt = runs.graph.newest_attempt(tick);
    let of = |read: &dyn Fn(&LoopAttempt) -> f64| attempt.map_or(f64::NAN, read);
    let of_effect = |read: &dyn Fn(&LoopEffect) -> f64| {
        let effect = attempt.and_then(|attempt| attempt.effect.as_ref());
        effect.map_or(f64::NAN, read)
    };
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
            "last loop: off the truth",
            of(&|attempt| runs.loop_error(attempt).position_m),
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

/// A text that stands for the picture.
pub fn summary(runs: &Runs, tick: usize) -> String {
    let truth = runs.truth(tick);
    let way = if runs.is_way_back(tick) {
        "on its way back"
    } else {
        "on its way out"
    };
    let loops: Vec<_> = runs
        .graph
        .attempts()
        .iter()
        .filter(|attempt| attempt.tick <= tick)
        .map(attempt_sentence)
        .collect();
    let loops = if loops.is_empty() {
        "No loop was tried so far".to_owned()
    } else {
        format!("So far: {}", loops.join("; "))
    };
    format!(
        "Map of the Apartment, 12 m by 9 m, with a corridor along its middle. \
         The robot is at x {:.1} m, y {:.1} m, {way}; {}. \
         The pose graph has {} keyframes. {loops}.",
        truth.x(),
        truth.y(),
        tick_sentence(runs, tick),
        runs.graph.keyframes_until(tick),
    )
}
