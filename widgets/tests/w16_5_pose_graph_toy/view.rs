//! The toy driven through its accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn, value};

#[test]
fn a_press_makes_one_step() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.5", width, |shell| {
            shell.model_mut().set("graph", 0.0).unwrap();
        });
        harness.get_by_label("One step").click();
        harness.run_steps(2);
        assert_eq!(value(&harness, "steps"), 1.0);
        assert!(harness.query_by_label("at rest").is_some());
    }
}
