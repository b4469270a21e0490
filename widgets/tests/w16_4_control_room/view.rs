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
