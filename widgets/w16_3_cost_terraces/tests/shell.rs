//! The widget driven as a reader drives it, through egui's accessibility tree and its pointer.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::shell::Shell;

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut shell = w16_3_cost_terraces::widget();
    shell.model_mut().set("more", 1.0).unwrap();
    let mut harness = Harness::builder()
        .with_size(vec2(width, 2400.0))
        .with_max_steps(3000)
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
    harness.run_steps(3);
    harness
}

fn value(harness: &Harness<'_, Shell>, id: &str) -> f64 {
    harness.state().model().values().get(id)
}

fn verdict(harness: &Harness<'_, Shell>) -> String {
    harness.state().model().outcome().verdict
}

fn press_key(harness: &mut Harness<'_, Shell>, slider: &str, key: Key) {
    harness.get_by_role_and_label(Role::Slider, slider).focus();
    harness.run_steps(2);
    harness.key_press(key);
    harness.run_steps(2);
}

fn click_at(harness: &mut Harness<'_, Shell>, pos: Pos2) {
    harness.event(Event::PointerMoved(pos));
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.run_steps(2);
    }
}

#[test]
fn every_slider_takes_arrow_keys_by_its_own_step() {
    for width in [1100.0, 700.0, 390.0] {
        let mut harness = harness(width);
        for (label, id, stepped) in [
            ("pair limit τ", "tau", 0.2),
            ("NDT cell", "ndt-cell", 0.6),
            ("heading offset", "heading", 1.0),
            ("cells a side", "cells", 57.0),
            ("drop at Δx", "probe-x", 0.45),
            ("drop at Δy", "probe-y", 0.15),
        ] {
            press_key(&mut harness, label, Key::ArrowRight);
            let now = value(&harness, id);
            assert!((now - stepped).abs() < 1e-9, "{id} is {now} at {width}");
        }
    }
}

#[test]
fn the_scene_is_chosen_by_its_button() {
    let mut harness = harness(1100.0);
    harness
        .get_by_role_and_label(Role::RadioButton, "scene: corridor")
        .click();
    harness.run_steps(2);
    assert_eq!(value(&harness, "scene"), 1.0);
}

#[test]
fn a_click_on_either_map_moves_both_cross_hairs() {
    let mut harness = harness(1100.0);
    for (panel, at) in [("icp", [0.5, -0.5]), ("ndt", [-0.75, 0.25])] {
        let [x, y] = harness.state().panel_to_screen(panel, at).unwrap();
        click_at(&mut harness, pos2(x, y));
        // A pixel is 8 mm here.
        assert!((value(&harness, "probe-x") - at[0]).abs() < 0.01);
        assert!((value(&harness, "probe-y") - at[1]).abs() < 0.01);
    }
}

#[test]
fn a_preset_drops_the_balls_and_the_widget_comes_to_rest() {
    let mut harness = harness(1100.0);
    harness.get_by_label("Shrink τ to 0.15 m").click();
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
    let mut harness = harness(700.0);
    press_key(&mut harness, "drop at Δx", Key::ArrowRight);
    harness
        .get_by_role_and_label(Role::Button, "Defaults")
        .click();
    harness.run_steps(2);
    assert_eq!(value(&harness, "probe-x"), 0.4);
}
