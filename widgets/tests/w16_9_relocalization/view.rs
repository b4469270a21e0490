//! The localization driven through the accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn, value};

#[test]
fn a_press_goes_to_the_next_moment() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.9", width, |shell| {
            shell.finish_work();
            shell.model_mut().set("moment", 5.0).unwrap();
        });
        harness.get_by_label("Next moment").click();
        harness.run_steps(2);
        assert_eq!(value(&harness, "moment"), 6.0);
    }
}
