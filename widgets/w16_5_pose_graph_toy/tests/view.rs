//! The toy drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;
use w16_5_pose_graph_toy::model::PoseGraphToy;
use w16_5_pose_graph_toy::view::ToyView;

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut harness = Harness::builder()
        .with_size(vec2(width, 2400.0))
        .with_max_steps(600)
        .build_ui_state(
            |ui, shell: &mut Shell| shell.ui(ui),
            w16_5_pose_graph_toy::widget(),
        );
    harness.run_steps(3);
    harness
}

#[test]
fn a_press_makes_one_step() {
    for width in [390.0, 1100.0] {
        let mut harness = harness(width);
        harness.get_by_label("One step").click();
        harness.run_steps(2);
        assert_eq!(harness.state().model().values().get("steps"), 1.0);
        assert!(harness.query_by_label("at rest").is_some());
        harness.get_by_role_and_label(Role::Slider, "stiffness of the loop");
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = kit::audit::text_faults(&PoseGraphToy::new(), &ToyView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
