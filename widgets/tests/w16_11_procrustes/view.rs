//! The trace driven through its accessibility tree, without a GPU.

use egui::Key;
use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn_whole, press_key, value};

#[test]
fn a_slider_moves_a_point_and_a_button_the_shape() {
    let mut harness = drawn_whole("w16.11", 1100.0);
    assert!(harness.query_by_label("a mirror image fits best").is_some());
    press_key(&mut harness, "target 1: moved in x", Key::ArrowRight);
    assert!(value(&harness, "x1") > 0.0);
    let param = harness.state().model().spec().params.iter();
    let shape = param.clone().find(|param| param.id == "shape").unwrap();
    let widget_kit::param::ParamKind::Choice { options } = shape.kind else {
        panic!("the shape is a choice");
    };
    let two = format!("{}: {}", shape.label, options[1].label);
    harness.get_by_label(&two).click();
    harness.run_steps(3);
    let verdict = harness.state().model().outcome().verdict;
    assert!(harness.query_by_label(&verdict).is_some());
    assert_ne!(verdict, "a mirror image fits best");
}
