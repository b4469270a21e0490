//! The widget as a reader meets it: through egui's accessibility tree and the pointer.

use egui::accesskit::Role;
use egui::{Event, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use kit::param::ParamKind;
use kit::shell::Shell;
use w16_1_basin_explorer::model::{BasinExplorer, panel};
use w16_1_basin_explorer::spec::{PARAMS, SPEC};
use w16_1_basin_explorer::view::BasinView;

fn harness(width: f32) -> Harness<'static, Shell> {
    let mut shell = w16_1_basin_explorer::widget();
    shell.model_mut().set("more", 1.0).unwrap();
    let mut harness = Harness::builder()
        .with_size(vec2(width, 2600.0))
        .build_ui_state(|ui, shell: &mut Shell| shell.ui(ui), shell);
    harness.run_steps(2);
    harness
}

fn value(harness: &Harness<'_, Shell>, id: &str) -> f64 {
    harness.state().model().values().get(id)
}

fn screen(harness: &Harness<'_, Shell>, panel: &str, at: [f64; 2]) -> Pos2 {
    let [x, y] = harness
        .state()
        .panel_to_screen(panel, at)
        .expect("the panel is shown");
    pos2(x, y)
}

fn drag(harness: &mut Harness<'_, Shell>, from: Pos2, to: Pos2) {
    for (pos, pressed) in [(from, Some(true)), (to, None), (to, Some(false))] {
        harness.event(Event::PointerMoved(pos));
        if let Some(pressed) = pressed {
            harness.event(Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
        harness.run_steps(2);
    }
}

#[test]
fn every_control_of_the_list_is_on_screen_under_its_name() {
    for width in [340.0, 700.0, 1100.0] {
        let harness = harness(width);
        harness.get_by_role_and_label(Role::Button, "Less");
        for spec in PARAMS.iter().filter(|spec| spec.id != "more") {
            let (role, name) = match spec.kind {
                ParamKind::Slider { .. } | ParamKind::Timeline { .. } => {
                    (Role::Slider, spec.label.to_owned())
                }
                ParamKind::Seed { .. } => (Role::SpinButton, spec.label.to_owned()),
                ParamKind::Choice { options } => (
                    Role::RadioButton,
                    format!("{}: {}", spec.label, options[0].label),
                ),
                ParamKind::Switch => (Role::CheckBox, spec.label.to_owned()),
                ParamKind::Text { .. } => unreachable!("no text here"),
            };
            let rect = harness.get_by_role_and_label(role, &name).rect();
            assert!(
                rect.left() >= 0.0 && rect.right() <= width,
                "{name} leaves {width}: {rect}"
            );
            assert!(rect.bottom() <= harness.state().content_height(), "{name}");
        }
        for label in SPEC.presets.iter().map(|preset| preset.label) {
            let rect = harness.get_by_role_and_label(Role::Button, label).rect();
            assert!(rect.right() <= width && rect.height() >= 24.0, "{label}");
        }
    }
}

#[test]
fn the_cloud_is_dragged_by_its_sensor_and_turned_by_its_handle() {
    let mut harness = harness(1100.0);
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
    let mut harness = harness(1100.0);
    let model = harness.state_mut().model_mut();
    model.set("iteration", 30.0).unwrap();
    harness.run_steps(2);
    let spot = screen(&harness, panel::PLANE, [-90.0, 1.0]);
    drag(&mut harness, spot, spot);
    assert!((value(&harness, "heading") + 90.0).abs() < 1.0);
    assert!((value(&harness, "dx") - 1.0).abs() < 0.02);
    assert_eq!(value(&harness, "variant"), 1.0);
    let changed: Vec<_> = harness
        .state_mut()
        .take_changes()
        .into_iter()
        .map(|c| c.id)
        .collect();
    for id in ["heading", "dx", "variant", "iteration"] {
        assert!(changed.contains(&id), "{id} is not told");
    }
}

#[test]
fn the_verdict_on_screen_follows_the_preset() {
    let mut harness = harness(1100.0);
    harness
        .get_by_role_and_label(Role::Button, "Start 60° off")
        .click();
    harness.run_steps(2);
    assert!(harness.query_by_label("quarter turn").is_some());
}

#[test]
fn no_text_overlaps_or_is_cut_off_at_any_width() {
    for width in [320.0, 340.0, 390.0, 520.0, 560.0, 700.0, 1100.0, 1400.0] {
        let faults = kit::audit::text_faults(&BasinExplorer::new(), &BasinView, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
