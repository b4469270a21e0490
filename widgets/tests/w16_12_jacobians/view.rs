//! The four solvers driven through the accessibility tree, without a GPU.

use egui::Key;
use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn, press_key, value};

#[test]
fn a_slider_takes_the_contradiction() {
    let mut harness = drawn("w16.12", 390.0, |_| ());
    let verdict = "the wrong residual ends elsewhere";
    assert!(harness.query_by_label(verdict).is_none(), "a question");
    harness.state_mut().act();
    harness.run_steps(2);
    assert!(harness.query_by_label(verdict).is_some());
    for _ in 0..12 {
        press_key(
            &mut harness,
            "each edge turns too little by",
            Key::ArrowLeft,
        );
    }
    assert_eq!(value(&harness, "bias"), 0.0);
    assert!(harness.query_by_label("all four end alike").is_some());
}
