//! Place recognition driven through the accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn, value};

#[test]
fn a_press_drives_to_the_next_keyframe() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.7", width, |shell| {
            shell.finish_work();
            shell.model_mut().set("new", 30.0).unwrap();
        });
        harness.get_by_label("Next keyframe").click();
        harness.run_steps(2);
        assert_eq!(value(&harness, "new"), 31.0);
    }
}
