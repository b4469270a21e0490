//! The four solvers as the contradiction is set.

use widgets::registry::find;
use widgets::w16_12_jacobians::spec::{LEAST_BIAS_DEG, MAX_STEPS};

use crate::support::fact;

#[test]
fn a_slider_takes_the_contradiction() {
    let mut shell = find("w16.12").unwrap()();
    let verdict = |shell: &widget_kit::shell::Shell| shell.model().outcome().verdict;
    assert_eq!(verdict(&shell), "before the first step");
    shell.model_mut().set("steps", MAX_STEPS as f64).unwrap();
    assert_eq!(verdict(&shell), "the wrong residual ends elsewhere");
    let off_m = |shell: &widget_kit::shell::Shell| fact(shell.model(), "residual_off_m");
    let before = off_m(&shell);
    shell.model_mut().set("bias", LEAST_BIAS_DEG).unwrap();
    assert!(off_m(&shell) < 0.5 * before);
    // The lesson stays: even the least contradiction shows it.
    assert_eq!(verdict(&shell), "the wrong residual ends elsewhere");
    assert!(shell.model_mut().set("bias", 0.0).is_err());
}
