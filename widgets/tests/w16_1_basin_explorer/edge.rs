//! The basin's edge: marked by the reader, computed, and compared in words.

use widget_kit::model::{Activity, Assessment, Model};
use widget_kit::scene::Layer;
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};

use crate::support::{fact, panel_of};
use crate::w16_1_basin_explorer::common::with;

fn asked() -> BasinExplorer {
    let mut model = BasinExplorer::default();
    model.press("mark-edge").unwrap();
    model
}

fn swept(marks: [f64; 2]) -> BasinExplorer {
    let mut model = asked();
    model.set("edge-p2p", marks[0]).unwrap();
    model.set("edge-p2l", marks[1]).unwrap();
    model.press("sweep").unwrap();
    model.finish_work();
    model
}

/// The edges of both errors, computed.
fn edges() -> [f64; 2] {
    let model = swept([0.0, 0.0]);
    ["edge_p2p_deg", "edge_p2l_deg"].map(|id| fact(&model, id))
}

#[test]
fn the_maps_are_covered_while_the_reader_marks_and_open_afterwards() {
    let rasters = |model: &BasinExplorer| {
        let maps = [panel::POINT, panel::PLANE].map(|id| panel_of(model, id));
        let layers = maps.iter().flat_map(|map| &map.layers);
        let is_told = |layer: &&Layer| matches!(layer, Layer::Raster(_) | Layer::Text { .. });
        layers.filter(is_told).count()
    };
    let mut model = asked();
    while model.work().is_busy() {}
    assert_eq!(rasters(&model), 0);
    assert_eq!(model.outcome().verdict, "mark both edges");
    assert!(!model.disclosure().is_all() && model.disclosure().has_param("edge-p2l"));
    assert!(model.disclosure().has_button("sweep") && !model.disclosure().has_panel(panel::SWEEPS));
    model.press("sweep").unwrap();
    assert!(rasters(&model) > 2);
}

#[test]
fn a_press_on_a_covered_map_marks_its_edge_and_a_drag_moves_it() {
    let mut model = asked();
    for (panel, id) in [(panel::POINT, "edge-p2p"), (panel::PLANE, "edge-p2l")] {
        let handle = model.grab(panel, [-41.6, 0.4], [3.0, 0.1]).unwrap();
        model.drag(handle, [-41.6, 0.4]);
        assert_eq!(model.values().number(id), 42.0);
        model.drag(handle, [300.0, 0.0]);
        assert_eq!(model.values().number(id), 180.0);
        model.drag(handle, [f64::NAN, 0.0]);
        assert_eq!(model.values().number(id), 180.0);
    }
    assert_eq!(model.outcome().verdict, "both edges are marked");
    // The start did not move: the press was a mark.
    assert_eq!(model.values().number("heading"), 0.0);
    assert_eq!(model.values().number("variant"), 0.0);
}

#[test]
fn both_marks_are_compared_with_the_sweep_in_words() {
    let [point, plane] = edges();
    assert!(plane > point && point > 10.0, "{point} and {plane}");
    let right = swept([point, plane + 5.0]).outcome();
    assert_eq!(
        (right.verdict.as_str(), right.standing),
        ("both edges are right", Assessment::Good)
    );
    assert!(
        right.sentence.contains("as you marked; point-to-plane"),
        "{}",
        right.sentence
    );
    assert!(right.sentence.contains("5° too far"), "{}", right.sentence);
    let one = swept([point - 6.0, plane]).outcome();
    assert_eq!(one.verdict, "one edge is right");
    assert!(one.sentence.contains("6° short"), "{}", one.sentence);
    let none = swept([0.0, 180.0]).outcome();
    assert_eq!(
        (none.verdict.as_str(), none.standing),
        ("no edge is right", Assessment::Bad)
    );
    assert!(
        none.sentence.contains("you marked none"),
        "{}",
        none.sentence
    );
}

#[test]
fn the_sweep_runs_in_pieces_and_restarts_with_another_tau() {
    let mut model = asked();
    model.press("sweep").unwrap();
    assert_eq!(model.outcome().verdict, "the edge is swept");
    assert!(fact(&model, "edge_p2p_deg").is_nan());
    let mut pieces = 0;
    while fact(&model, "edge_p2p_deg").is_nan() || fact(&model, "edge_p2l_deg").is_nan() {
        assert_eq!(model.work(), Activity::Busy);
        pieces += 1;
    }
    let [point, plane] = edges();
    // A piece for each degree from 0 on, and one for the first failure, of both errors.
    assert_eq!(f64::from(pieces), point + plane + 4.0);
    model.set("tau", 1.4).unwrap();
    assert!(fact(&model, "edge_p2p_deg").is_nan());
    model.finish_work();
    assert!(fact(&model, "edge_p2p_deg") > point);
    assert!(!model.finish_work());
}

#[test]
fn without_the_question_there_are_no_marks_and_the_defaults_end_it() {
    let mut model = swept([30.0, 40.0]);
    model.press("defaults").unwrap();
    assert_eq!(model.values().number("edge"), 0.0);
    let before = BasinExplorer::default().outcome();
    assert_eq!(model.outcome(), before);
    assert_eq!(with(&[("edge-p2p", 30.0)]).outcome(), before);
}

/// The lines are named where they stand, so that the legend keeps its four places for the minima.
#[test]
fn the_question_about_the_edge_adds_nothing_to_the_legend() {
    for scene in [0.0, 1.0] {
        for mut model in [asked(), swept([0.0, 0.0]), swept([30.0, 40.0])] {
            model.set("scene", scene).unwrap();
            model.finish_work();
            let is_swept = model.values().number("edge") == 2.0;
            for id in [panel::POINT, panel::PLANE] {
                let map = panel_of(&model, id);
                assert!(map.legend.len() <= 4, "{id}: {:?}", map.legend);
                let is_named = |word: &str| {
                    let mut layers = map.layers.iter();
                    layers.any(|layer| matches!(layer, Layer::Label { text, .. } if text == word))
                };
                assert_eq!(is_named("swept"), is_swept);
                let is_marked = model.values().number("edge-p2p") > 0.0;
                assert_eq!(is_named("your edge"), is_marked);
            }
        }
    }
}
