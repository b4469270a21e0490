//! Worlds other than the Apartment, and the failures in those that break a map.

use ch16_lab::lap::{BuiltInWorld, LapConfig, LapMatcher, LapRunner, LoopJudgement, NamedChoice};
use ch16_slam2d::chapter::InformationFrame;

use super::*;
use crate::w16_2_full_lap::spec::{LAP_TICKS, MAX_TICKS};

#[test]
fn every_world_has_the_lap_of_the_command_line_and_its_name_in_the_texts() {
    for (index, world) in BuiltInWorld::all().enumerate() {
        let model = at(&[
            ("world", index as f64),
            ("information", 1.0),
            ("seed", 5.0),
            ("t", MAX_TICKS),
        ]);
        let config = LapConfig::in_world(world, 5, 1.0).with_information(InformationFrame::Exact);
        let record = LapRunner::new().run(&config);
        assert_eq!(results(&model).graph, record.lap.summary, "{world:?}");
        assert_eq!(model.tick(), record.ticks());
        assert_eq!(model.runs.place(), Some(world));
        assert!(
            model
                .summary()
                .starts_with(&format!("Map of {}", world.label()))
        );
        let names = model.scene().panels[0]
            .layers
            .iter()
            .any(|layer| matches!(layer, Layer::Label { text, .. } if text == "A"));
        assert_eq!(
            names,
            world == BuiltInWorld::Apartment,
            "rooms are the Apartment's"
        );
    }
}

#[test]
fn presets_of_other_worlds_show_the_end_of_their_lap() {
    for preset in ["ring", "twins", "corridor", "hall"] {
        let mut model = FullLap::default();
        press(&mut model, preset);
        assert_eq!(model.values().number("t"), model.last(), "{preset}");
    }
}

#[test]
fn a_tick_requested_before_its_lap_is_finished_is_kept() {
    let mut model = FullLap::default();
    model.set("world", 1.0).unwrap();
    model.set("t", 200.0).unwrap();
    assert_eq!(model.values().number("t"), 200.0);
    assert!(model.tick() <= 129, "the old lap is shown until then");
    model.finish_work();
    assert_eq!(model.tick(), 200);
    // A lap that ends before the current tick is shown at its end.
    set(&mut model, "world", 0.0);
    assert_eq!(model.values().number("t"), 129.0);
}

#[test]
fn in_the_twin_rooms_a_wrong_loop_passes_every_test_by_each_matcher() {
    for matcher in [LapMatcher::PointToPoint, LapMatcher::PointToPlane] {
        let mut model = FullLap::default();
        press(&mut model, "twins");
        let index = LapMatcher::all().position(|it| it == matcher);
        set(&mut model, "matcher", index.unwrap() as f64);
        let lap = model.runs.graph.lap();
        let wrong = lap
            .false_acceptances()
            .filter(|attempt| lap.judge(attempt) == LoopJudgement::FalseAcceptance);
        let wrong: Vec<_> = wrong.collect();
        assert!(!wrong.is_empty(), "{matcher:?}");
        // "The two rooms become one": off by the width of a room, 1.3 m.
        let off = lap.loop_error(wrong[0]).position_m;
        assert!((off - 1.3).abs() < 0.2, "{off}");
    }
}

#[test]
fn the_bare_corridor_is_mapped_too_short_and_its_map_is_consistent() {
    let mut model = FullLap::default();
    press(&mut model, "corridor");
    let runs = &model.runs;
    let farthest = runs
        .graph
        .poses_at(runs.ticks())
        .iter()
        .map(|pose| pose.x());
    let driven = (1..=runs.ticks()).map(|tick| runs.truth(tick).x());
    let (seen, true_m) = (farthest.fold(0.0, f64::max), driven.fold(0.0, f64::max));
    assert!(seen < 0.5 * true_m, "{seen} of {true_m}");
    assert!(fact(&model, "map_disagreement_m") < 0.15);
    assert!(fact(&model, "keyframe_rms_m") > 5.0);
}

#[test]
fn of_the_loops_between_two_rooms_alike_some_are_counted_as_wrong() {
    let mut model = FullLap::default();
    press(&mut model, "twins");
    let wrong = fact(&model, "false_loops");
    assert!(wrong >= 1.0 && wrong < fact(&model, "loops_closed"));
    model.set("t", 0.0).unwrap();
    assert_eq!(fact(&model, "false_loops"), 0.0);
}

#[test]
fn in_the_round_hall_the_robot_ends_on_the_far_side_and_the_map_is_consistent() {
    let mut model = FullLap::default();
    press(&mut model, "hall");
    // The way around has a radius of 2.2 m, "three centimetres".
    assert!(fact(&model, "graph_error_m") > 3.0);
    assert!(fact(&model, "map_disagreement_m") < 0.035);
}

#[test]
fn around_the_ring_loops_close_from_the_other_side() {
    let mut model = FullLap::default();
    press(&mut model, "ring");
    assert!(fact(&model, "loops_closed") >= 1.0);
    assert!(fact(&model, "keyframe_rms_m") < 0.5);
}

/// The ring and the red verdict of a finished lap that is wrong.
#[test]
fn a_finished_lap_shows_its_wrong_place_in_a_ring() {
    let ring = |model: &FullLap| {
        let layers = model.scene().panels[0].layers.clone();
        layers.into_iter().find_map(|layer| match layer {
            Layer::Points {
                points,
                mark: Mark::Circle,
                tone: Tone::Strained,
                ..
            } => Some(points),
            _ => None,
        })
    };
    for (preset, words) in [
        ("twins", "false loop "),
        ("corridor", " m off"),
        ("hall", " m off"),
    ] {
        let mut model = FullLap::default();
        press(&mut model, preset);
        let outcome = model.outcome();
        assert_eq!(outcome.standing, Assessment::Bad, "{preset}");
        assert!(outcome.verdict.contains(words), "{}", outcome.verdict);
        let at = ring(&model).expect(preset);
        let is_keyframe = shown_nodes(&model).contains(&at[0]);
        assert_eq!(is_keyframe, words == " m off", "{preset}");
        // On the way nothing is judged yet.
        set(&mut model, "t", 60.0);
        assert_eq!(ring(&model), None, "{preset}");
    }
    // The chapter's lap is nowhere a metre off.
    let model = at(&[TICK.to(LAP_TICKS)]);
    assert_eq!(ring(&model), None);
    assert_eq!(model.outcome().verdict, "lap finished");
}
