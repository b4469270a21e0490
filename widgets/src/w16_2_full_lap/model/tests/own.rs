//! A custom loop: set by values, by a drag, by keys; its texts, and undo.

use super::*;

const REACH: [f64; 2] = [0.18, 0.18];

const WRONG: [(&str, f64); 3] = [("own", 3.0), ("own-gate", 0.0), ("t", 129.0)];

fn ends(model: &FullLap) -> [f64; 3] {
    ["own", "own-from", "own-to"].map(|id| model.values().number(id))
}

#[test]
fn the_settings_define_the_loop_and_the_picture_shows_where_its_error_goes() {
    let mut model = at(&WRONG);
    // The whole map after the loop.
    set(&mut model, "wipe", 0.0);
    let words = model.outcome();
    assert_eq!(words.standing, Assessment::Bad);
    assert_eq!(words.verdict, "your false loop accepted");
    assert!(
        words.sentence.contains("let past the gate"),
        "{}",
        words.sentence
    );
    assert!(fact(&model, "own_shift_m") > 3.0);
    assert!(fact(&model, "own_chi2_after") < fact(&model, "own_chi2_before"));
    let scene = model.scene();
    let wide = scene.panels[0].layers.iter().any(|layer| {
        matches!(layer, Layer::Segments { tone: Tone::Strained, segments, .. } if segments.len() > 5)
    });
    assert!(wide, "edges past the gate have a colour of their own");
    assert_eq!(
        model.runs.graph.poses_at(129).len(),
        shown_nodes(&model).len()
    );
    assert!(
        scene.panels[1]
            .title
            .starts_with("Close-up of your loop 40 to 12")
    );
    set(&mut model, "own-gate", 1.0);
    assert_eq!(model.outcome().verdict, "your loop rejected");
    assert!(fact(&model, "own_shift_m").is_nan());
    assert!(fact(&model, "own_gate_chi2") > fact(&model, "gate_chi2"));
}

#[test]
fn the_presets_show_what_they_claim() {
    let help = |id: &str| SPEC.presets.iter().find(|p| p.id == id).unwrap().help;
    let mut model = FullLap::default();
    press(&mut model, "wrong-loop");
    let moved = format!("by up to {:.1} m", fact(&model, "own_shift_m"));
    assert!(help("wrong-loop").contains(&moved), "{moved}");
    assert!(fact(&model, "loop_error_m").is_finite());
    press(&mut model, "tamed-loop");
    assert!(fact(&model, "own_shift_m") < 0.001);
    press(&mut model, "true-loop");
    let [before, after] = ["own_rms_before_m", "own_rms_after_m"].map(|id| fact(&model, id));
    let falls = format!("from {before:.2} m to {after:.2} m");
    assert!(help("true-loop").contains(&falls), "{falls}");
    assert!(
        fact(&model, "own_gate_chi2") > fact(&model, "gate_chi2"),
        "no gate lets it in"
    );
    assert_eq!(model.outcome().standing, Assessment::Good);
}

#[test]
fn a_loop_is_dragged_from_a_keyframe_to_another_without_a_tap_before_and_undone() {
    let mut model = at(&[("t", 129.0)]);
    let [from, to, further] = [36, 3, 10].map(|node| shown_nodes(&model)[node]);
    model.tap("map", from, REACH);
    let node = model.values().number("number");
    model.tap("map", [1e3; 2], REACH);
    assert_eq!(model.values().number("pick"), 0.0, "nothing is selected");
    let handle = model.grab("map", from, REACH).expect("a keyframe");
    // A press with little movement creates no loop.
    model.drag(handle, from);
    assert_eq!(ends(&model)[0], 0.0);
    model.drag(handle, further);
    let first = ends(&model);
    assert_eq!(first[..2], [1.0, node]);
    model.drag(handle, to);
    let second = ends(&model);
    assert_ne!(first, second, "the loop follows the pointer");
    // The words are about the loop, also if the keyframe was selected before.
    assert!(model.outcome().verdict.starts_with("your loop"));
    // One drag is one change.
    press(&mut model, "undo");
    assert_eq!(ends(&model)[0], 0.0);
    assert!(model.own.tried().is_none());
}

#[test]
fn keys_join_two_keyframes_and_undo_reverts_each_change() {
    let mut model = at(&[("t", 129.0), ("pick", 1.0), ("number", 36.0)]);
    press(&mut model, "tie");
    assert!(
        model
            .outcome()
            .sentence
            .ends_with("select another keyframe and press Tie again")
    );
    assert_eq!(
        model.values().number("own-from"),
        36.0,
        "a change that is heard"
    );
    set(&mut model, "number", 3.0);
    let next = "press Tie for a loop from keyframe 36 to here";
    assert!(model.outcome().sentence.ends_with(next));
    press(&mut model, "tie");
    assert_eq!(ends(&model), [1.0, 36.0, 3.0]);
    assert_eq!(model.outcome().verdict, "your loop accepted");
    set(&mut model, "own", 3.0);
    set(&mut model, "own-to", 12.0);
    for expected in [[3.0, 36.0, 3.0], [1.0, 36.0, 3.0]] {
        press(&mut model, "undo");
        assert_eq!(ends(&model), expected);
    }
    press(&mut model, "undo");
    assert_eq!(ends(&model)[0], 0.0);
    press(&mut model, "undo");
    assert_eq!(ends(&model)[0], 0.0, "there is nothing left to take back");
}

#[test]
fn a_tap_on_the_second_keyframe_completes_a_loop() {
    let mut model = at(&[("t", 129.0), ("pick", 1.0), ("number", 36.0)]);
    press(&mut model, "tie");
    let place = shown_nodes(&model)[12];
    model.tap("map", place, REACH);
    assert_eq!(ends(&model), [1.0, 36.0, 12.0]);
}

#[test]
fn an_impossible_loop_is_explained_and_the_lap_stays() {
    let mut model = at(&[("t", 129.0)]);
    let before = shown_nodes(&model);
    for (from, to, words) in [
        (7.0, 7.0, "both ends of your loop are keyframe 7"),
        (999.0, 3.0, "keyframe 999 does not exist yet"),
    ] {
        set(&mut model, "own", 1.0);
        set(&mut model, "own-from", from);
        set(&mut model, "own-to", to);
        assert!(model.outcome().sentence.starts_with(words));
        assert_eq!(shown_nodes(&model), before);
    }
}

#[test]
fn an_own_loop_exists_from_the_tick_of_its_newer_keyframe_on() {
    let mut model = at(&[("own", 3.0), ("own-gate", 0.0), ("t", 60.0)]);
    assert!(model.own.tried().is_none());
    set(&mut model, "t", 129.0);
    assert!(model.own.tried().is_some());
    // The nodes move from their old positions to the solver's result.
    let rest = shown_nodes(&model);
    set(&mut model, "kernel", 1.0);
    assert_eq!(model.advance(0.1), Activity::Busy);
    while model.advance(0.25) == Activity::Busy {}
    assert_ne!(shown_nodes(&model), rest);
}
