//! The trace as its controls are set.

use widgets::registry::find;

#[test]
fn a_slider_moves_a_point_and_a_choice_the_shape() {
    let mut shell = find("w16.11").unwrap()();
    let verdict = |shell: &widget_kit::shell::Shell| shell.model().outcome().verdict;
    assert_eq!(verdict(&shell), "a mirror image fits best");
    shell.model_mut().set("x1", 0.1).unwrap();
    assert_eq!(shell.model().values().number("x1"), 0.1);
    shell.model_mut().set("shape", 1.0).unwrap();
    assert_ne!(verdict(&shell), "a mirror image fits best");
}
