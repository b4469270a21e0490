//! The control room drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut shell = w16_4_control_room::widget();
    shell.model_mut().set("more", 1.0).unwrap();
    let mut harness = Harness::builder()
        .with_size(vec2(width, 2400.0))
        .with_max_steps(600)
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
    harness.run_steps(3);
    harness
}

#[test]
fn every_parameter_has_a_control_that_is_named_after_it() {
    let harness = harness(1100.0);
    for label in ["odometry noise ×", "tick"] {
        harness.get_by_role_and_label(Role::Slider, label);
    }
    harness.get_by_role_and_label(Role::CheckBox, "loop closure");
}

#[test]
fn next_event_goes_to_the_next_line_of_the_log() {
    let mut harness = harness(390.0);
    let before = harness.state().model().values().get("t");
    harness.get_by_label("Next event").click();
    harness.run_steps(2);
    let after = harness.state().model().values().get("t");
    assert!(after > before, "{before} then {after}");
}
