//! The widget through its pointer.

use egui::pos2;
use egui_kittest::Harness;
use widget_kit::shell::Shell;

use crate::support::{click_at, drawn_whole, value};

fn verdict(harness: &Harness<'_, Shell>) -> String {
    harness.state().model().outcome().verdict
}

#[test]
fn the_scene_is_chosen_by_its_name() {
    let mut harness = drawn_whole("w16.3", 1100.0);
    let model = harness.state_mut().model_mut();
    model.set_text("scene", "corridor").unwrap();
    assert_eq!(value(&harness, "scene"), 1.0);
}

#[test]
fn a_click_on_the_relief_moves_the_cross_hair() {
    let mut harness = drawn_whole("w16.3", 1100.0);
    for at in [[0.5, -0.5], [-0.75, 0.25]] {
        let [x, y] = harness.state().panel_to_screen("relief", at).unwrap();
        click_at(&mut harness, pos2(x, y));
        // A pixel is 8 mm here.
        assert!((value(&harness, "probe-x") - at[0]).abs() < 0.01);
        assert!((value(&harness, "probe-y") - at[1]).abs() < 0.01);
    }
}

#[test]
fn a_preset_drops_the_ball_and_the_widget_comes_to_rest() {
    let mut harness = drawn_whole("w16.3", 1100.0);
    let presets = harness.state().model().spec().presets;
    let shrink = presets
        .iter()
        .find(|preset| preset.label == "Shrink τ to 0.15 m");
    harness.state_mut().press(shrink.unwrap().id).unwrap();
    harness.run_steps(2);
    assert!(harness.state().is_busy());
    let frames = 60 * 120;
    for _ in 0..frames {
        harness.step();
        if !harness.state().is_busy() {
            break;
        }
    }
    assert!(
        !harness.state().is_busy(),
        "an idle widget asks for no frame"
    );
    assert_eq!(verdict(&harness), "ICP sticks");
    let last = harness.state().model().timeline().unwrap().last;
    assert!(value(&harness, "t") >= last);
}

#[test]
fn defaults_put_the_cross_hair_back() {
    let mut harness = drawn_whole("w16.3", 700.0);
    harness
        .state_mut()
        .model_mut()
        .set("probe-x", 0.45)
        .unwrap();
    harness.state_mut().press("defaults").unwrap();
    assert_eq!(value(&harness, "probe-x"), 0.4);
}
