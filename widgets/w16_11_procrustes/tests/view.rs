//! The trace drawn and driven through its accessibility tree, without a GPU.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::model::Model as _;
use kit::shell::Shell;
use w16_11_procrustes::model::ProcrustesTrace;
use w16_11_procrustes::view::TraceView;

#[test]
fn the_points_can_be_moved_by_sliders_and_the_verdict_follows() {
    for width in [390.0, 1100.0] {
        let mut harness = Harness::builder()
            .with_size(vec2(width, 2400.0))
            .with_max_steps(600)
            .build_ui_state(
                |ui, shell: &mut Shell| shell.ui(ui),
                w16_11_procrustes::widget(),
            );
        harness.run_steps(3);
        harness.get_by_label("Play");
        assert!(harness.query_by_label("a turn fits best").is_some());
        harness.state_mut().model_mut().set("more", 1.0).unwrap();
        harness.run_steps(3);
        harness.get_by_role_and_label(Role::Slider, "target 1: moved in x");
        harness.state_mut().model_mut().set("shape", 1.0).unwrap();
        harness.run_steps(3);
        assert!(
            harness
                .query_by_label("turn and mirror image tie")
                .is_some()
        );
    }
}

#[test]
fn no_text_overlaps_or_is_cut_off_at_any_width() {
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        for shape in [0.0, 3.0] {
            let mut trace = ProcrustesTrace::new();
            trace.set("shape", shape).unwrap();
            let faults = kit::audit::text_faults(&trace, &TraceView, width);
            assert!(faults.is_empty(), "{faults:#?}");
        }
    }
}
