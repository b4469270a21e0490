//! One idea at a time on the map.

use super::*;
use crate::w16_2_full_lap::spec::{LAP_TICKS, SHOW};

/// What the map shows: lines of truth, odometry and front end, points of the sweeps, loops, and the line of the loop.
fn shown(model: &FullLap) -> [bool; 6] {
    let layers = &model.scene().panels[0].layers;
    let line = |of: Tone| {
        let is = |layer: &Layer| matches!(layer, Layer::Line { tone, .. } if *tone == of);
        layers.iter().any(is)
    };
    let points = |of: Mark, most: bool| {
        layers.iter().any(|layer| {
            matches!(layer, Layer::Points { mark, tone, radius_px, .. }
                if *mark == of && [Tone::Outbound, Tone::Measurement].contains(tone) && (*radius_px > 4.0) == most)
        })
    };
    let is_held = model
        .grab("map", [divider_x(model), 8.0], [0.1; 2])
        .is_some();
    [
        line(Tone::Truth),
        line(Tone::Prediction),
        line(Tone::Prior),
        points(Mark::Dot, false),
        points(Mark::Dot, true),
        is_held,
    ]
}

/// Where the line between before and after stands at its default.
fn divider_x(model: &FullLap) -> f64 {
    let map = &model.scene().panels[0];
    map.x.min + model.values().number("wipe") * (map.x.max - map.x.min)
}

#[test]
fn each_idea_has_its_own_layers() {
    let mut model = FullLap::default();
    for (show, expected) in [
        ("wheels", [true, true, false, false, false, false]),
        ("map", [false, false, false, true, false, true]),
        ("loops", [false, false, false, true, true, true]),
        ("truth", [true, false, false, true, true, true]),
        ("all", [true; 6]),
    ] {
        let (id, value) = SHOW.to(show);
        set(&mut model, id, value);
        assert_eq!(shown(&model), expected, "{show}");
    }
    press(&mut model, "defaults");
    assert_eq!(shown(&model), [false, false, false, true, true, true]);
}

#[test]
fn what_is_hidden_is_neither_described_nor_pressed() {
    let mut model = at(&[TICK.to(LAP_TICKS)]);
    let node = shown_nodes(&model)[10];
    assert!(model.grab("map", node, [0.1; 2]).is_some());
    assert!(!model.summary().contains("odometry"));
    let (id, value) = SHOW.to("wheels");
    set(&mut model, id, value);
    assert!(model.grab("map", node, [0.1; 2]).is_none());
    assert!(model.summary().contains("Only the truth and the odometry"));
}

#[test]
fn a_finished_lap_says_how_far_off_it_is() {
    let off = |model: &FullLap| {
        let layers = model.scene().panels[0].layers.clone();
        layers
            .into_iter()
            .any(|layer| matches!(layer, Layer::Label { text, .. } if text == "worst: 0.89 m off"))
    };
    let mut model = at(&[TICK.to(LAP_TICKS)]);
    assert!(
        model
            .outcome()
            .sentence
            .contains("its worst keyframe 0.89 m")
    );
    assert!(off(&model));
    set(&mut model, "t", 128.0);
    assert!(!off(&model));
}
