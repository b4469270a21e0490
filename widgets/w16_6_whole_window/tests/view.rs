//! The whole window drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut shell = w16_6_whole_window::widget();
    shell.settle();
    let mut harness = Harness::builder()
        .with_size(vec2(width, 2400.0))
        .with_max_steps(600)
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
    harness.run_steps(3);
    harness
}

#[test]
fn a_press_takes_up_one_box() {
    for width in [390.0, 1100.0] {
        let mut harness = harness(width);
        harness.get_by_label("One box").click();
        harness.run_steps(2);
        assert_eq!(harness.state().model().values().get("progress"), 1.0);
        assert!(harness.query_by_label("the search finds home").is_some());
        harness.get_by_role_and_label(Role::Slider, "heading error of the start");
    }
}
