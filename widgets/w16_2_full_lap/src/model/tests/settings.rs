//! What settings and presets do to the lap.

use ch16_lab::lap::{Choice, LapConfig, LapMatcher, LapRunner};
use ch16_slam2d::loops::LoopRejection;
use ch16_slam2d::matching::InformationFrame;
use kit::model::Standing;
use kit::param::ParamKind;

use super::*;

/// The help of a preset says so.
fn assert_promised(preset: &str, words: &str) {
    let help = SPEC.presets.iter().find(|p| p.id == preset).unwrap().help;
    assert!(help.contains(words), "`{help}` does not say `{words}`");
}

#[test]
fn the_start_is_the_first_loop_of_the_canonical_run() {
    let model = FullLap::new();
    assert_eq!(model.runs.graph.attempts()[0].tick, model.tick());
    assert_eq!(
        model.outcome().sentence,
        "loop 29 to 7 accepted, chi-squared 4.24 below 7.815, history moved 0.24 m"
    );
}

#[test]
fn every_setting_recomputes_the_lap_at_once_and_keeps_the_time() {
    for (id, value) in [
        ("noise", 2.0),
        ("seed", 3.0),
        ("loops", 0.0),
        ("gate", 0.9),
        ("gate-model", 1.0),
        ("matcher", 1.0),
        ("matcher", 2.0),
        ("information", 1.0),
    ] {
        // Noisy enough for the two models of the gate to disagree.
        let mut model = at(&[("seed", 2.0), ("noise", 3.0), ("t", 110.0)]);
        let before = (
            table(&model, "run"),
            table(&model, "loops"),
            fact(&model, "gate_chi2"),
        );
        model.set(id, value).unwrap();
        let after = (
            table(&model, "run"),
            table(&model, "loops"),
            fact(&model, "gate_chi2"),
        );
        assert_ne!(before, after, "{id} changed nothing");
        assert_eq!(model.tick(), 110, "{id} moved the time");
        assert_eq!(model.advance(0.1), Activity::Idle, "{id} left work behind");
    }
}

#[test]
fn a_lap_depends_on_its_settings_alone_and_not_on_the_way_to_them() {
    let mut wandering = at(&[
        ("noise", 3.0),
        ("seed", 7.0),
        ("loops", 0.0),
        ("gate", 0.99),
    ]);
    for (id, value) in [
        ("loops", 1.0),
        ("gate", 0.95),
        ("noise", 1.5),
        ("seed", 2.0),
    ] {
        wandering.set(id, value).unwrap();
    }
    let straight = at(&[("seed", 2.0), ("noise", 1.5)]);
    assert!(picture(&wandering) == picture(&straight));
    assert!(wandering.tables() == straight.tables());
}

#[test]
fn without_loops_the_graph_is_the_front_end() {
    let model = at(&[("loops", 0.0), ("noise", 2.5)]);
    let results = model.runs.results();
    assert_eq!(results.graph, results.front_end);
    assert!(model.timeline().unwrap().marks.is_empty());
    assert!(model.runs.graph.attempt_near(50).is_none());
}

#[test]
fn without_loops_the_two_passes_end_as_far_apart_as_the_preset_says() {
    let mut model = at(&[("t", 129.0)]);
    let together = fact(&model, "map_disagreement_m");
    model.press("no-loops").unwrap();
    let apart = fact(&model, "map_disagreement_m");
    assert_promised(
        "no-loops",
        &format!("{apart:.2} m apart instead of {together:.2} m"),
    );
}

#[test]
fn every_matcher_ends_the_lap_as_far_off_as_its_preset_says() {
    let end_error = |model: &FullLap| model.runs.results().graph.keyframe_end_error_m;
    let chapter = end_error(&FullLap::new());
    for preset in ["bells", "sliding"] {
        let mut model = FullLap::new();
        model.press(preset).unwrap();
        let off = end_error(&model);
        assert_promised(
            preset,
            &format!("ends {off:.2} m off instead of {chapter:.2} m"),
        );
    }
}

/// The names and the labels of a choice of the widget.
fn options(id: &str) -> Vec<(&'static str, &'static str)> {
    let spec = SPEC.params.iter().find(|param| param.id == id).unwrap();
    let ParamKind::Choice { options } = spec.kind else {
        panic!("{id} is no choice");
    };
    options.iter().map(|it| (it.id, it.label)).collect()
}

fn named<T: Choice>() -> Vec<(&'static str, &'static str)> {
    T::ALL.iter().map(|it| (it.name(), it.label())).collect()
}

#[test]
fn matchers_and_frames_are_called_as_on_the_command_line_and_drive_the_same_lap() {
    assert_eq!(options("matcher"), named::<LapMatcher>());
    assert_eq!(options("information"), named::<InformationFrame>());
    let mut model = at(&[("seed", 7.0), ("noise", 2.0)]);
    for (matcher, kind) in LapMatcher::ALL.iter().enumerate() {
        for (information, frame) in InformationFrame::ALL.iter().enumerate() {
            model.set("matcher", matcher as f64).unwrap();
            model.set("information", information as f64).unwrap();
            let config = LapConfig::with_seed_and_noise(7, 2.0)
                .with_matcher(*kind)
                .with_information(*frame);
            let record = LapRunner::new().run(&config);
            assert_eq!(model.runs.results().graph, record.lap.summary);
        }
    }
}

#[test]
fn the_first_loop_helps_the_robot_and_not_its_history() {
    let mut model = FullLap::new();
    model.press("first-loop").unwrap();
    assert!(fact(&model, "graph_error_m") < fact(&model, "front_end_error_m"));
    assert!(fact(&model, "rms_after_m") > fact(&model, "rms_before_m"));
}

#[test]
fn a_wrong_loop_is_called_wrong_wherever_it_is_named() {
    // In the reference laps, too: within every gate, and more than 0.3 m off the truth.
    let model = at(&[("seed", 6.0), ("noise", 2.0), ("t", 92.0)]);
    let outcome = model.outcome();
    assert_eq!(outcome.standing, Standing::Bad);
    assert_eq!(outcome.verdict, "wrong loop accepted");
    assert_eq!(
        outcome.sentence,
        "wrong loop 29 to 7 accepted, chi-squared 4.93 below 7.815, history moved 0.32 m: \
         its measurement is 0.36 m and 1.7° off the truth"
    );
    assert!(fact(&model, "loop_error_m") > 0.3);
    let mark = &model.timeline().unwrap().marks[0];
    assert_eq!(mark.standing, Standing::Bad);
    assert_eq!(mark.label, "wrong loop 29 to 7 accepted");
    let Scene { panels } = model.scene();
    let named = panels[0]
        .layers
        .iter()
        .any(|layer| matches!(layer, Layer::Text { text, .. } if *text == mark.label));
    assert!(named, "the map names it alike");
}

#[test]
fn seed_6_has_a_loop_that_passes_the_gate_and_is_turned_away_all_the_same() {
    let mut model = FullLap::new();
    model.press("rejected").unwrap();
    let attempt = model.runs.graph.attempt_at(model.tick()).unwrap();
    assert!(attempt.verification.gate.passes() && !attempt.accepted());
    assert_eq!(
        model.outcome().sentence,
        "loop 29 to 7 rejected: chi-squared 4.30 below 7.815, \
         but the sweep fits to 0.186 m only, 0.16 m is asked"
    );
    // "Four keyframes later a better match passes."
    let next = &model.runs.graph.attempts()[1];
    assert_eq!(next.verification.from_node, 33);
    assert!(next.accepted());
}

#[test]
fn the_noisy_preset_shows_what_it_says() {
    let mut model = FullLap::new();
    model.press("noisy").unwrap();
    let results = model.runs.results();
    assert!((4.7..5.0).contains(&results.graph.odometry_end_error_m));
    assert!(results.front_end.keyframe_end_error_m < 1.0);
    let last = model.runs.graph.attempts().last().unwrap();
    assert!(last.accepted());
    assert_eq!(last.tick, model.runs.ticks());
}

#[test]
fn the_tight_gate_turns_away_a_loop_that_the_chapters_gate_accepts() {
    let mut model = FullLap::new();
    model.press("tight-gate").unwrap();
    // NIST/SEMATECH e-Handbook: χ² of 0.90 with 3 degrees of freedom.
    assert_eq!(fact(&model, "gate_chi2"), 6.251);
    let verdict = |model: &FullLap| {
        let attempt = model.runs.graph.attempt_at(model.tick()).unwrap();
        (attempt.verification.from_node, attempt.accepted())
    };
    assert_eq!(verdict(&model), (37, false));
    assert!(model.outcome().sentence.contains("above 6.251"));
    model.set("gate", 0.95).unwrap();
    assert_eq!(fact(&model, "gate_chi2"), 7.815);
    assert_eq!(verdict(&model), (37, true));
}

#[test]
fn the_locked_out_preset_turns_away_three_right_loops_by_the_gate_alone() {
    let mut model = FullLap::new();
    model.press("locked-out").unwrap();
    let attempts = model.runs.graph.attempts();
    assert_eq!(attempts.len(), 3);
    for attempt in attempts {
        let error = model.runs.graph.lap().loop_error(attempt);
        assert!(!error.is_false(), "{error:?}");
        let rejection = attempt.verification.rejection;
        assert!(matches!(rejection, Some(LoopRejection::OutsideGate(_))));
    }
}

#[test]
fn wrong_values_and_buttons_change_nothing() {
    let mut model = FullLap::new();
    let before = picture(&model);
    for (id, value) in [
        ("noise", 4.1),
        ("noise", f64::NAN),
        ("gate", 1.0),
        ("t", 130.0),
        ("t", -1.0),
        ("seed", 5e9),
        ("nois", 1.0),
    ] {
        assert!(model.set(id, value).is_err(), "{id} took {value}");
    }
    let error = model.press("att").unwrap_err().to_string();
    assert!(error.contains("no button `att`"), "{error}");
    assert!(picture(&model) == before);
}

#[test]
fn every_preset_can_be_pressed_and_pressed_again() {
    for preset in SPEC.presets {
        let mut model = at(&[("noise", 3.3), ("gate", 0.99)]);
        model.press(preset.id).unwrap();
        let once = (model.values().clone(), picture(&model));
        model.press(preset.id).unwrap();
        assert!(
            (model.values().clone(), picture(&model)) == once,
            "{}",
            preset.id
        );
    }
}

#[test]
fn the_corners_of_the_settings_have_a_picture_at_every_tick() {
    for seed in [0.0, 1.0, 4_294_967_295.0] {
        for noise in [0.25, 4.0] {
            for gate in [0.9, 0.999] {
                let mut model = at(&[("seed", seed), ("noise", noise), ("gate", gate)]);
                assert_eq!(model.last(), crate::spec::LAP_TICKS);
                for tick in 0..=model.runs.ticks() {
                    model.set("t", tick as f64).unwrap();
                    let shown = shown_nodes(&model);
                    assert!(shown.iter().flatten().all(|value| value.is_finite()));
                    assert_eq!(shown.len() as f64, fact(&model, "keyframes"));
                    assert!(!model.summary().contains("NaN"));
                    assert!(!model.outcome().sentence.contains("NaN"));
                }
            }
        }
    }
}
