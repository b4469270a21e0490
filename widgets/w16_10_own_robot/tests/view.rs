//! The widget drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;
use w16_10_own_robot::view::RobotView;

use crate::model::mapped;

#[test]
fn a_press_on_a_button_becomes_an_order() {
    for width in [390.0, 1100.0] {
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(
                |ui, shell: &mut Shell| shell.ui(ui),
                w16_10_own_robot::widget(),
            );
        harness.run_steps(3);
        harness.get_by_label("Open a log…").click();
        harness.run_steps(2);
        assert_eq!(harness.state_mut().take_orders(), ["open"]);
        harness.get_by_role_and_label(Role::Slider, "keyframe");
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off_with_a_map_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = kit::audit::text_faults(&mapped(), &RobotView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
