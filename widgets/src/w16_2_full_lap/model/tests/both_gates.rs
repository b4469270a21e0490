//! Both gates of every loop: their verdicts, their regions, and what each accepts.

use ch16_lab::lap::{AcceptedShares, FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG, LoopJudgement};
use ch16_slam2d::loops::{GateModel, LoopVerification};
use widget_kit::scene::Stroke;

use super::*;
use crate::w16_2_full_lap::model::gates::{Gate, Gates, Region};

fn gate_of<'a>(model: &'a FullLap, attempt: &RecordedLoopAttempt, chosen: GateModel) -> &'a Gate {
    let gates = model.runs.gates(attempt);
    match chosen {
        GateModel::PathApproximation => &gates.path,
        GateModel::ExactMarginal => &gates.exact,
    }
}

#[test]
fn the_chosen_gate_is_that_of_the_lap() {
    for (value, chosen) in [
        (0.0, GateModel::PathApproximation),
        (1.0, GateModel::ExactMarginal),
    ] {
        let model = at(&[("noise", 4.0), ("gate-model", value)]);
        assert_eq!(model.runs.loop_config().gate_model, chosen);
        for attempt in model.runs.graph.attempts() {
            let gate = gate_of(&model, attempt, chosen);
            let loop_ = &attempt.verification;
            assert_eq!((gate.model, gate.test), (chosen, loop_.gate));
            assert_eq!(gate.information, loop_.gate_information);
        }
    }
}

#[test]
fn the_facts_give_the_chi_squared_of_both_gates() {
    let mut model = FullLap::default();
    let path = fact(&model, "chi2_path");
    let exact = fact(&model, "chi2_exact");
    assert_eq!(fact(&model, "chi2"), path);
    assert_ne!(path, exact);
    set(&mut model, "gate-model", 1.0);
    assert_eq!(fact(&model, "chi2"), exact);
}

/// Whether the registered position is in the region: |A⁻¹ (p − center)| ≤ 1.
fn holds(region: &Region, loop_: &LoopVerification) -> bool {
    let [a, b] = region.half_axes;
    let [x, y] = [
        loop_.registered.x() - region.center[0],
        loop_.registered.y() - region.center[1],
    ];
    let determinant = a[0] * b[1] - a[1] * b[0];
    let u = (x * b[1] - y * b[0]) / determinant;
    let v = (a[0] * y - a[1] * x) / determinant;
    u * u + v * v <= 1.0
}

#[test]
fn the_measured_position_is_in_a_gates_region_exactly_if_that_gate_accepts() {
    let mut seen = [[0, 0], [0, 0]];
    let mut model = at(&[("noise", 4.0), ("gate", 0.9)]);
    for seed in 1..=12 {
        set(&mut model, "seed", f64::from(seed));
        for attempt in model.runs.graph.attempts() {
            let loop_ = &attempt.verification;
            let gates = model.runs.gates(attempt);
            for (which, gate) in [gates.path, gates.exact].iter().enumerate() {
                let region = gate.region(loop_);
                let inside = region.is_some_and(|region| holds(&region, loop_));
                assert_eq!(inside, gate.test.passes(), "{}", texts::ends(attempt));
                seen[which][usize::from(inside)] += 1;
            }
        }
    }
    for [outside, inside] in seen {
        assert!(outside > 0 && inside > 0, "both cases: {seen:?}");
    }
}

#[test]
fn the_gate_that_decides_is_solid_and_the_other_one_dotted() {
    for (value, path, exact) in [
        (0.0, Stroke::Solid, Stroke::Dotted),
        (1.0, Stroke::Dotted, Stroke::Solid),
    ] {
        let model = at(&[("gate-model", value)]);
        let scene = model.scene();
        let mut panels = scene.panels.iter();
        let panel = panels.find(|panel| panel.id == "loop").unwrap();
        let drawn = panel.layers.iter().filter_map(|layer| match layer {
            Layer::Ellipse { stroke, .. } => Some(*stroke),
            _ => None,
        });
        assert_eq!(drawn.collect::<Vec<_>>(), [path, exact]);
        for (name, stroke) in [("path gate", path), ("exact gate", exact)] {
            let entry = panel.legend.iter().find(|e| e.label.starts_with(name));
            assert_eq!(entry.unwrap().stroke, Some(stroke));
        }
    }
}

#[test]
fn the_exact_gate_accepts_the_locked_out_loops() {
    let mut model = FullLap::default();
    press(&mut model, "locked-out");
    let locked_out = results(&model).graph;
    press(&mut model, "let-in");
    let attempts = model.runs.graph.attempts();
    assert_eq!(attempts.len(), 3);
    let lap = model.runs.graph.lap();
    let right = |attempt| lap.judge(attempt) == LoopJudgement::Right;
    assert!(attempts.iter().all(right));
    let first = &attempts[0];
    assert_eq!(first.tick, model.tick());
    // "By its heading alone": no position passes. "Less sure of the heading": a wider σ_θ.
    let Gates { path, exact } = model.runs.gates(first);
    assert!(path.region(&first.verification).is_none());
    let heading_variance = |gate: &Gate| gate.information.try_inverse().unwrap()[(2, 2)];
    assert!(heading_variance(exact) > 2.0 * heading_variance(path));
    // "More than a metre": the end of the lap, against the truth.
    let let_in = results(&model).graph;
    assert!(locked_out.keyframe_end_error_m - let_in.keyframe_end_error_m > 1.0);
}

#[test]
fn the_exact_gate_accepts_more_true_and_more_false_loops() {
    // The numbers of the note: laps of seeds 1 to 50 at four times the noise.
    let mut model = at(&[("noise", 4.0)]);
    let mut attempts = [AcceptedShares::default(); 2];
    for seed in 1..=50 {
        set(&mut model, "seed", f64::from(seed));
        for (gate_model, attempts) in (0_u8..).zip(&mut attempts) {
            set(&mut model, "gate-model", f64::from(gate_model));
            *attempts = attempts.plus(&model.runs.graph.lap().accepted_shares());
        }
    }
    let [path, exact] = attempts;
    let note = format!(
        "accepts {} of {} true loops and {} of {} false ones, the exact gate {} of {} and {} of {}. False means more than {FALSE_LOOP_DISTANCE_M} m or {FALSE_LOOP_TURN_DEG}° from the truth.",
        path.of_true[0],
        path.of_true[1],
        path.of_false[0],
        path.of_false[1],
        exact.of_true[0],
        exact.of_true[1],
        exact.of_false[0],
        exact.of_false[1],
    );
    assert!(
        SPEC.notice.iter().any(|words| words.contains(&note)),
        "{note}"
    );
}
