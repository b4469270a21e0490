//! The widget drawn and driven through its accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;
use widgets::w16_10_own_robot::view::RobotView;

use crate::support::drawn;
use crate::w16_10_own_robot::model::mapped;

#[test]
fn a_press_on_a_button_becomes_an_order() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.10", width, |_| ());
        harness.get_by_label("Open a log…").click();
        harness.run_steps(2);
        assert_eq!(harness.state_mut().take_orders(), ["open"]);
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off_with_a_map_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = kit::audit::text_faults(&mapped(), &RobotView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
