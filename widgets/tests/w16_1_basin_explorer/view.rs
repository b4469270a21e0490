//! The widget through the pointer.

use egui::{Pos2, pos2};
use egui_kittest::Harness;
use widget_kit::shell::Shell;
use widgets::w16_1_basin_explorer::model::panel;

use crate::support::{drawn, drawn_whole, point, value};

fn screen(harness: &Harness<'_, Shell>, panel: &str, at: [f64; 2]) -> Pos2 {
    let [x, y] = harness
        .state()
        .panel_to_screen(panel, at)
        .expect("the panel is shown");
    pos2(x, y)
}

fn drag(harness: &mut Harness<'_, Shell>, from: Pos2, to: Pos2) {
    for (pos, pressed) in [(from, Some(true)), (to, None), (to, Some(false))] {
        point(harness, pos, pressed);
    }
}

#[test]
fn the_cloud_is_dragged_by_its_sensor_and_turned_by_its_handle() {
    let mut harness = drawn_whole("w16.1", 1100.0);
    harness
        .state_mut()
        .model_mut()
        .set("iteration", 30.0)
        .unwrap();
    harness.run_steps(2);
    let from = screen(&harness, panel::SWEEPS, [0.5, -0.35]);
    let to = screen(&harness, panel::SWEEPS, [0.9, -0.35]);
    drag(&mut harness, from, to);
    assert!(
        (value(&harness, "dx") - 0.4).abs() < 0.05,
        "{}",
        value(&harness, "dx")
    );
    // Letting go plays.
    let shell = harness.state_mut();
    assert!(shell.model().is_pressed("play"));
    shell.press("reset").unwrap();
    harness.run_steps(2);
    let handle = screen(
        &harness,
        panel::SWEEPS,
        [0.9 + 0.35_f64.cos(), -0.35 + 0.35_f64.sin()],
    );
    let up = screen(&harness, panel::SWEEPS, [0.9, 0.65]);
    drag(&mut harness, handle, up);
    let turned = 90.0 - 0.35_f64.to_degrees();
    assert!(
        (value(&harness, "heading") - turned).abs() < 3.0,
        "{}",
        value(&harness, "heading")
    );
}

#[test]
fn a_click_on_a_basin_map_sets_the_start() {
    let mut harness = drawn_whole("w16.1", 1100.0);
    let model = harness.state_mut().model_mut();
    model.set("iteration", 30.0).unwrap();
    harness.run_steps(2);
    let spot = screen(&harness, panel::PLANE, [-90.0, 1.0]);
    drag(&mut harness, spot, spot);
    assert!((value(&harness, "heading") + 90.0).abs() < 1.0);
    assert!((value(&harness, "dx") - 1.0).abs() < 0.02);
    assert_eq!(value(&harness, "variant"), 1.0);
    assert_eq!(value(&harness, "iteration"), 0.0);
}

#[test]
fn the_verdict_follows_the_preset() {
    let mut harness = drawn_whole("w16.1", 1100.0);
    let presets = harness.state().model().spec().presets;
    let off = presets
        .iter()
        .find(|preset| preset.label == "Start 60° off");
    harness.state_mut().press(off.unwrap().id).unwrap();
    harness.run_steps(2);
    assert_eq!(harness.state().model().outcome().verdict, "quarter turn");
}

/// The canvas of a phone of 390 by 844 points leaves so much to claim, Play, control and verdict.
const PHONE_PX: f32 = 356.0;
const STAGE_PX: f32 = 844.0 - 270.0;

#[test]
fn the_maps_enter_on_a_phone_without_moving_the_controls_off_the_screen() {
    let height = |starts: &[f64]| {
        let mut harness = drawn("w16.1", PHONE_PX, |_| {});
        for heading in starts {
            harness
                .state_mut()
                .model_mut()
                .set("heading", *heading)
                .unwrap();
            harness.state_mut().model_mut().advance(1.0);
            harness.run_steps(2);
        }
        let shown = harness.state().panel_to_screen(panel::POINT, [0.0; 2]);
        (harness.state().stage_height(), shown.is_some())
    };
    let (alone, has_map) = height(&[]);
    assert!(!has_map && alone <= STAGE_PX, "{alone}");
    let (with_map, has_map) = height(&[40.0, 70.0]);
    assert!(has_map);
    assert!(
        (with_map - alone).abs() <= 8.0,
        "{alone} becomes {with_map}"
    );
}
