//! The widget drawn and driven through its accessibility tree, without a GPU.

use egui_kittest::kittest::{NodeT as _, Queryable as _};
use widgets::w16_10_own_robot::view::RobotView;

use crate::support::drawn;
use crate::w16_10_own_robot::model::{deliver, mapped};

#[test]
fn a_press_on_a_button_becomes_an_order() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.10", width, |_| ());
        harness.get_by_label("Open a log…").click();
        harness.run_steps(2);
        assert_eq!(harness.state_mut().take_requests(), ["open"]);
    }
}

#[test]
fn stop_is_enabled_while_a_log_is_read() {
    let mut harness = drawn("w16.10", 390.0, |_| ());
    let is_disabled = |harness: &egui_kittest::Harness<'_, widget_kit::shell::Shell>| {
        harness.get_by_label("Stop").accesskit_node().is_disabled()
    };
    assert!(is_disabled(&harness));
    harness.get_by_label("Stop").click();
    harness.run_steps(2);
    assert!(harness.state_mut().take_requests().is_empty());
    let reading = [1.0, 0.5, 20.0, 0.0, 0.0];
    let model = harness.state_mut().model_mut();
    deliver(model, "stage", "", &reading);
    harness.run_steps(2);
    assert!(!is_disabled(&harness));
    harness.get_by_label("Stop").click();
    harness.run_steps(2);
    assert_eq!(harness.state_mut().take_requests(), ["cancel"]);
    let done = [5.0, 1.0, 40.0, 0.0, 0.0];
    deliver(harness.state_mut().model_mut(), "stage", "", &done);
    harness.run_steps(2);
    assert!(is_disabled(&harness));
}

#[test]
fn no_text_overlaps_or_is_cut_off_with_a_map_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = widget_kit::audit::text_faults(&mapped(), &RobotView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
