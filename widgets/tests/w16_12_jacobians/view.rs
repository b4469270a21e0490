//! The four solvers as the contradiction is set.

use widgets::registry::find;
use widgets::w16_12_jacobians::spec::MAX_STEPS;

#[test]
fn a_slider_takes_the_contradiction() {
    let mut shell = find("w16.12").unwrap()();
    let verdict = |shell: &widget_kit::shell::Shell| shell.model().outcome().verdict;
    assert_eq!(verdict(&shell), "before the first step");
    shell.model_mut().set("steps", MAX_STEPS as f64).unwrap();
    assert_eq!(verdict(&shell), "the wrong residual ends elsewhere");
    shell.model_mut().set("bias", 0.0).unwrap();
    assert_eq!(verdict(&shell), "all four end alike");
}
