//! The widget drawn without a GPU.

use egui_kittest::Harness;
use widget_kit::model::Motion;
use widget_kit::shell::Shell;

use crate::support::{self, drawn, value};

fn harness(width: f32) -> Harness<'static, Shell> {
    drawn("w16.2", width, |shell| {
        shell.model_mut().set("more", 1.0).unwrap();
        // Animations of egui and of the loop would take frames to settle.
        shell.set_motion(Motion::Reduced);
    })
}

fn fact(harness: &Harness<'_, Shell>, id: &str) -> f64 {
    support::fact(harness.state().model(), id)
}

fn press(harness: &mut Harness<'_, Shell>, id: &str) {
    harness.state_mut().press(id).unwrap();
    harness.state_mut().finish_work();
    harness.run_steps(2);
}

fn set(harness: &mut Harness<'_, Shell>, id: &str, value: f64) {
    harness.state_mut().model_mut().set(id, value).unwrap();
    harness.state_mut().finish_work();
    harness.run_steps(2);
}

#[test]
fn another_noise_drives_another_lap_and_keeps_the_time() {
    let mut harness = harness(1100.0);
    let before = fact(&harness, "odometry_error_m");
    set(&mut harness, "noise", 1.05);
    assert_ne!(fact(&harness, "odometry_error_m"), before);
    assert_eq!(value(&harness, "t"), 92.0);
}

#[test]
fn a_value_between_two_steps_stays_until_it_is_moved() {
    let mut harness = harness(700.0);
    harness
        .state_mut()
        .model_mut()
        .set("noise", 1.2345)
        .unwrap();
    harness.run_steps(3);
    assert_eq!(value(&harness, "noise"), 1.2345);
}

#[test]
fn the_gate_slider_shows_its_threshold() {
    let mut harness = harness(1100.0);
    assert_eq!(fact(&harness, "gate_chi2"), 7.815);
    set(&mut harness, "gate", 0.951);
    // The 0.951 quantile of χ²₃ is 7.8598, by bisection of its distribution function.
    assert_eq!(fact(&harness, "gate_chi2"), 7.860);
}

#[test]
fn the_buttons_of_the_loop_go_before_at_and_after_it() {
    let mut harness = harness(700.0);
    let buttons = harness.state().model().spec().buttons;
    for (label, tick) in [
        ("Before the loop", 91.0),
        ("At the loop", 92.0),
        ("After the loop", 93.0),
        ("Next loop", 107.0),
        ("Step", 108.0),
        ("Reset", 0.0),
    ] {
        let button = buttons.iter().find(|button| button.label == label);
        press(&mut harness, button.unwrap().id);
        assert_eq!(value(&harness, "t"), tick, "{label}");
    }
}

#[test]
fn the_switch_removes_the_loops() {
    let mut harness = harness(700.0);
    set(&mut harness, "loops", 0.0);
    assert_eq!(fact(&harness, "loops_closed"), 0.0);
    assert!(harness.state().model().timeline().unwrap().marks.is_empty());
}

#[test]
fn a_loop_animates_and_then_the_widget_is_idle() {
    let mut harness = harness(1100.0);
    harness.state_mut().set_motion(Motion::Full);
    press(&mut harness, "at");
    assert!(harness.state().is_busy());
    harness.run_steps(240);
    assert!(
        !harness.state().is_busy(),
        "an idle widget asks for no frame"
    );
}

#[test]
fn no_label_overlaps_another_while_the_lap_by_ndt_runs() {
    let mut shell = widgets::registry::find("w16.2").unwrap()();
    for (id, value) in [("more", 1.0), ("matcher", 2.0)] {
        shell.model_mut().set(id, value).unwrap();
    }
    shell.finish_work();
    for tick in [92.0, 104.0, 110.0, 116.0, 122.0, 129.0] {
        shell.model_mut().set("t", tick).unwrap();
        for width in [390.0, 700.0, 1100.0] {
            let faults = shell.text_faults(width);
            assert!(faults.is_empty(), "tick {tick} at {width}: {faults:#?}");
        }
    }
}
