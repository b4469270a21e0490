//! The whole window driven through its accessibility tree, without a GPU.

use egui_kittest::kittest::Queryable as _;

use crate::support::{drawn, value};

#[test]
fn a_press_expands_one_box() {
    for width in [390.0, 1100.0] {
        let mut harness = drawn("w16.6", width, |shell| assert!(shell.finish_work()));
        harness.get_by_label("One box").click();
        harness.run_steps(2);
        assert_eq!(value(&harness, "progress"), 1.0);
        assert!(harness.query_by_label("the search finds home").is_some());
    }
}
