//! The morning drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

#[test]
fn a_press_goes_to_the_next_moment() {
    for width in [390.0, 1100.0] {
        let mut shell = w16_9_come_back::widget();
        shell.settle();
        shell.model_mut().set("moment", 5.0).unwrap();
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
        harness.run_steps(3);
        harness.get_by_label("Next moment").click();
        harness.run_steps(2);
        assert_eq!(harness.state().model().values().get("moment"), 6.0);
        harness.get_by_role_and_label(Role::Slider, "laps since the wardrobe moved");
    }
}
