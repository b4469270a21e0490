//! The moving box as its slider takes points from it.

use widgets::registry::find;

use crate::support::fact;

#[test]
fn a_slider_takes_the_share_of_the_box() {
    let mut shell = find("w16.8").unwrap()();
    let before = fact(shell.model(), "plain_error_m");
    shell.model_mut().set("share", 21.0).unwrap();
    assert!(fact(shell.model(), "plain_error_m") != before, "{before}");
    // Without a box.
    shell.model_mut().set("share", 0.0).unwrap();
    assert_eq!(shell.model().outcome().verdict, "all three are home");
}
