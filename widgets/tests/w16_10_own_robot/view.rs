//! The widget's requests to its host, and its picture without a GPU.

use widgets::registry::find;
use widgets::w16_10_own_robot::view::RobotView;

use crate::w16_10_own_robot::model::{deliver, mapped};

#[test]
fn a_press_on_a_button_becomes_a_request() {
    let mut shell = find("w16.10").unwrap()();
    shell.press("open").unwrap();
    assert_eq!(shell.take_requests(), ["open"]);
}

#[test]
fn stop_is_enabled_while_a_log_is_read() {
    let mut shell = find("w16.10").unwrap()();
    assert!(shell.disabled().contains(&"cancel"));
    shell.press("cancel").unwrap();
    assert!(shell.take_requests().is_empty());
    deliver(shell.model_mut(), "stage", "", &[1.0, 0.5, 20.0, 0.0, 0.0]);
    assert!(!shell.disabled().contains(&"cancel"));
    shell.press("cancel").unwrap();
    assert_eq!(shell.take_requests(), ["cancel"]);
    deliver(shell.model_mut(), "stage", "", &[5.0, 1.0, 40.0, 0.0, 0.0]);
    assert!(shell.disabled().contains(&"cancel"));
}

#[test]
fn no_text_overlaps_or_is_cut_off_with_a_map_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = widget_kit::audit::text_faults(&mapped(), &RobotView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
