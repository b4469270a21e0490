//! The control room driven through its accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn_whole, value};

#[test]
fn next_event_goes_to_the_next_line_of_the_log() {
    let mut harness = drawn_whole("w16.4", 390.0);
    let before = value(&harness, "t");
    harness.get_by_label("Next event").click();
    harness.run_steps(2);
    let after = value(&harness, "t");
    assert!(after > before, "{before} then {after}");
}

/// Names over the data lay on each other and on the numbers of the axis.
#[test]
fn the_lanes_have_their_names_on_the_axis() {
    let model =
        kit::model::Model::scene(&widgets::w16_4_control_room::model::ControlRoom::default());
    let lanes = model
        .panels
        .iter()
        .find(|panel| panel.id == "lanes")
        .unwrap();
    assert_eq!(lanes.y.names.len(), 8);
    assert_eq!(lanes.y.names[7], "predict");
    let is_text = |layer: &kit::scene::Layer| matches!(layer, kit::scene::Layer::Text { .. });
    assert!(!lanes.layers.iter().any(is_text));
}
