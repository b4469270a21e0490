//! The four solvers drawn and driven through the accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;
use w16_12_jacobians::model::WrongJacobians;
use w16_12_jacobians::view::JacobiansView;

#[test]
fn a_slider_takes_the_contradiction() {
    for width in [390.0, 1100.0] {
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(
                |ui, shell: &mut Shell| shell.ui(ui),
                w16_12_jacobians::widget(),
            );
        harness.run_steps(3);
        harness.get_by_label("Play");
        harness.get_by_role_and_label(Role::Slider, "each edge turns too little by");
        let verdict = "the wrong residual ends elsewhere";
        assert!(harness.query_by_label(verdict).is_some());
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = kit::audit::text_faults(&WrongJacobians::new(), &JacobiansView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
