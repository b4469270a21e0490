//! Selection of keyframes, edges and loops: by pointer, by keys, by values.

use super::*;
use crate::w16_2_full_lap::model::moment::LapState;

/// A mouse on a map of 1,000 pixels.
const REACH: [f64; 2] = [0.18, 0.18];

fn node_at(model: &FullLap, node: usize) -> [f64; 2] {
    shown_nodes(model)[node]
}

/// The labels over the data of a panel.
fn labels(model: &FullLap, panel: &str) -> Vec<String> {
    let scene = model.scene();
    let panel = scene.panels.into_iter().find(|shown| shown.id == panel);
    let layers = panel.unwrap().layers.into_iter();
    let labels = layers.filter_map(|layer| match layer {
        Layer::Label { text, .. } => Some(text),
        _ => None,
    });
    labels.collect()
}

#[test]
fn a_tap_on_a_keyframe_shows_its_number_error_and_chi_squared_and_one_beside_it_deselects() {
    let mut model = at(&[("t", 129.0)]);
    let at_it = node_at(&model, 12);
    model.tap("map", at_it, REACH);
    assert_eq!(
        (
            model.values().number("pick"),
            model.values().number("number")
        ),
        (1.0, 12.0)
    );
    let runs = &model.runs;
    let off_m = ch16_slam2d::metrics::position_error_m(
        &runs.graph.poses_at(129)[12],
        &runs.truth(runs.graph.keyframe_tick(12)),
    );
    assert_eq!(fact(&model, "looked_at_error_m"), off_m);
    let outcome = model.outcome();
    assert_eq!(outcome.verdict, "keyframe 12");
    let words = format!("{off_m:.2} m and ");
    assert!(outcome.sentence.contains(&words), "{}", outcome.sentence);
    assert!(
        text_alternative(&model, false).contains(&outcome.in_full()),
        "a reader of screens gets the same"
    );
    let label = format!("12: {off_m:.2} m off");
    assert!(
        labels(&model, "map")
            .iter()
            .any(|text| text.starts_with(&label))
    );
    model.tap("map", [6.0, 8.5], REACH);
    assert_eq!(model.values().number("pick"), 0.0);
    assert!(fact(&model, "looked_at_error_m").is_nan());
}

#[test]
fn loops_and_edges_can_be_selected_on_the_map_and_in_the_plots() {
    let mut model = at(&[("t", 129.0)]);
    for (pick, number, verdict) in [(2.0, 5.0, "edge 5 to 6"), (3.0, 29.0, "loop 29 to 7")] {
        set(&mut model, "pick", pick);
        set(&mut model, "number", number);
        assert_eq!(model.outcome().verdict, verdict);
        assert!(fact(&model, "looked_at_chi2").is_finite());
        // A tap on its mark in the plot of strains finds it again.
        let part = GraphPart::chosen(model.values());
        let moment = model.moment();
        let edge = moment
            .edges()
            .find(|edge| Some(picture::part_of(&moment, edge)) == part)
            .unwrap();
        let strain = ch16_lab::lap::edge_strain(edge, &moment.nodes);
        let mark = picture::strain_mark(&strain);
        set(&mut model, "pick", 0.0);
        model.tap("strain", mark, [0.2, 0.05]);
        assert_eq!(GraphPart::chosen(model.values()), part);
    }
    let gate = |moment: &LapState| picture::gate_mark(moment, moment.loops_tried().next().unwrap());
    let mark = gate(&model.moment());
    set(&mut model, "pick", 0.0);
    model.tap("gate", mark, [1.0, 0.2]);
    assert_eq!(model.outcome().verdict, "loop 29 to 7");
}

#[test]
fn a_hovering_pointer_labels_the_part_below_and_changes_no_value() {
    let mut model = at(&[("t", 129.0)]);
    let before = model.values().clone();
    let at_it = node_at(&model, 20);
    model.hover("map", Some(at_it));
    assert!(
        labels(&model, "map")
            .iter()
            .any(|text| text.starts_with("20: "))
    );
    assert_eq!(model.values(), &before);
    model.hover("map", None);
    assert!(
        !labels(&model, "map")
            .iter()
            .any(|text| text.starts_with("20: "))
    );
}

#[test]
fn keys_step_through_keyframes_and_loops_cyclically() {
    let mut model = at(&[("t", 129.0)]);
    press(&mut model, "one-on");
    assert_eq!(model.outcome().verdict, "keyframe 0");
    press(&mut model, "one-back");
    assert_eq!(model.outcome().verdict, "keyframe 40");
    press(&mut model, "one-on");
    assert_eq!(model.outcome().verdict, "keyframe 0");
    set(&mut model, "pick", 3.0);
    for verdict in [
        "loop 29 to 7",
        "loop 33 to 6",
        "loop 37 to 2",
        "loop 29 to 7",
    ] {
        press(&mut model, "one-on");
        assert_eq!(model.outcome().verdict, verdict);
    }
}

#[test]
fn a_part_that_does_not_exist_yet_is_reported_without_numbers() {
    let mut model = at(&[("t", 20.0), ("pick", 1.0), ("number", 40.0)]);
    assert_eq!(model.outcome().verdict, "not yet there");
    assert!(
        model
            .outcome()
            .sentence
            .starts_with("keyframe 40 does not exist yet at tick 20")
    );
    assert!(fact(&model, "looked_at_error_m").is_nan());
    set(&mut model, "pick", 3.0);
    set(&mut model, "number", 29.0);
    assert_eq!(
        model.outcome().sentence,
        "no loop has been tried at keyframe 29 by tick 20"
    );
    set(&mut model, "t", 92.0);
    assert_eq!(model.outcome().verdict, "loop 29 to 7");
}

#[test]
fn no_labels_on_the_data_overlap_in_any_preset() {
    let mut shell = crate::registry::find("w16.2").unwrap()();
    shell.model_mut().set("more", 1.0).unwrap();
    for preset in SPEC.presets {
        shell.model_mut().press(preset.id).unwrap();
        shell.model_mut().set("pick", 1.0).unwrap();
        shell.model_mut().set("number", 29.0).unwrap();
        shell.finish_work();
        for width in [390.0, 768.0, 1024.0, 1440.0] {
            let faults = shell.label_faults(width);
            assert!(faults.is_empty(), "{}: {faults:#?}", preset.id);
        }
    }
}
