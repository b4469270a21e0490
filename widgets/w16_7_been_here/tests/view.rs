//! The places drawn and driven through their accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

#[test]
fn a_press_drives_to_the_next_keyframe() {
    for width in [390.0, 1100.0] {
        let mut shell = w16_7_been_here::widget();
        shell.settle();
        shell.model_mut().set("new", 30.0).unwrap();
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
        harness.run_steps(3);
        harness.get_by_label("Next keyframe").click();
        harness.run_steps(2);
        assert_eq!(harness.state().model().values().get("new"), 31.0);
        harness.get_by_role_and_label(Role::Slider, "pairs called the same place");
    }
}
