//! The moving box drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

#[test]
fn a_slider_takes_the_share_of_the_box() {
    for width in [390.0, 1100.0] {
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(
                |ui, shell: &mut Shell| shell.ui(ui),
                w16_8_moving_box::widget(),
            );
        harness.run_steps(3);
        harness.get_by_label("Play");
        harness.get_by_role_and_label(Role::Slider, "points on the box");
        let verdict = harness.state().model().outcome().verdict;
        assert!(harness.query_by_label(&verdict).is_some());
    }
}
