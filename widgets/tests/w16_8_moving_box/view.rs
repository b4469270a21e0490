//! The moving box driven through its accessibility tree, without a GPU.

use egui::Key;
use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn_whole, fact, press_key, value};

#[test]
fn a_slider_takes_the_share_of_the_box() {
    let mut harness = drawn_whole("w16.8", 390.0);
    let off_m = |harness: &egui_kittest::Harness<'_, _>| {
        let shell: &widget_kit::shell::Shell = harness.state();
        fact(shell.model(), "plain_error_m")
    };
    let before = off_m(&harness);
    press_key(&mut harness, "points on the box", Key::ArrowRight);
    assert_eq!(value(&harness, "share"), 21.0);
    assert!(off_m(&harness) != before, "{before}");
    // Without a box; the verdict on screen follows.
    for _ in 0..21 {
        press_key(&mut harness, "points on the box", Key::ArrowLeft);
    }
    assert_eq!(value(&harness, "share"), 0.0);
    assert!(harness.query_by_label("all three are home").is_some());
}
