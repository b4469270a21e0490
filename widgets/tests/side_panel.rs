//! Every widget in the side panel of a host without a page.

use egui::accesskit::Role;
use egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use widget_kit::controls::shown;
use widget_kit::param::{MORE, ParamKind, ParamSpec};
use widget_kit::shell::Shell;
use widget_kit::side_panel::side_panel;
use widgets::registry::{SHELLS, find};

/// The panel of a widget, with all its controls.
fn open(mut shell: Shell) -> Harness<'static, Shell> {
    let more = shell.model_mut().set(MORE.id, 1.0);
    more.expect("every widget has layers");
    shell.finish_work();
    let mut harness = Harness::builder()
        .with_size(vec2(400.0, 4000.0))
        .build_ui_state(side_panel, shell);
    harness.run_steps(2);
    harness
}

/// The control of a parameter in the accessibility tree; a text has none.
fn role(param: &ParamSpec) -> Option<Role> {
    match param.kind {
        ParamKind::Slider { .. } | ParamKind::Timeline { .. } => Some(Role::Slider),
        ParamKind::Seed { .. } => Some(Role::SpinButton),
        ParamKind::Choice { .. } => Some(Role::ComboBox),
        ParamKind::Switch => Some(Role::CheckBox),
        ParamKind::Text { .. } => None,
    }
}

#[test]
fn every_control_is_there_under_its_name_and_the_verdict_too() {
    for make in SHELLS {
        let harness = open(make());
        let model = harness.state().model();
        let (spec, ids) = (model.spec(), shown(model));
        for param in spec.params.iter().filter(|param| ids.contains(&param.id)) {
            let Some(role) = role(param) else { continue };
            let found = harness.query_by_role_and_label(role, param.label);
            assert!(found.is_some(), "{}: {}", spec.id, param.label);
        }
        let buttons = spec
            .buttons
            .iter()
            .filter(|button| ids.contains(&button.id));
        let labels = buttons.map(|button| button.label);
        for label in labels.chain(spec.presets.iter().map(|preset| preset.label)) {
            let found = harness.query_by_role_and_label(Role::Button, label);
            assert!(found.is_some(), "{}: {label}", spec.id);
        }
        let verdict = model.outcome().verdict;
        assert!(harness.query_by_label(&verdict).is_some(), "{verdict}");
    }
}

#[test]
fn every_slider_takes_an_arrow_key_by_its_own_step() {
    for make in SHELLS {
        let mut harness = open(make());
        let model = harness.state().model();
        let (spec, ids) = (model.spec(), shown(model));
        for param in spec.params.iter().filter(|param| ids.contains(&param.id)) {
            let ParamKind::Slider { min, max, step } = param.kind else {
                continue;
            };
            let value =
                |harness: &Harness<'_, Shell>| harness.state().model().values().number(param.id);
            let before = value(&harness);
            let (key, by) = if before + step <= max {
                (Key::ArrowRight, step)
            } else {
                (Key::ArrowLeft, -step)
            };
            harness
                .get_by_role_and_label(Role::Slider, param.label)
                .focus();
            harness.run_steps(2);
            harness.key_press(key);
            harness.run_steps(2);
            // Steps are plural from the smallest value.
            let expected = min + ((before + by - min) / step).round() * step;
            let now = value(&harness);
            let name = (spec.id, param.id);
            assert!(
                (now - expected).abs() < 1e-9,
                "{name:?}: {before} became {now}"
            );
            let slider = harness.get_by_role_and_label(Role::Slider, param.label);
            let told = slider.accesskit_node().numeric_value();
            assert_eq!(told, Some(now), "{name:?}");
            let shell = harness.state_mut();
            shell.model_mut().set(param.id, before).unwrap();
            shell.finish_work();
        }
    }
}

#[test]
fn a_gesture_stands_there_until_the_first_press() {
    let shell = find("w16.5").unwrap()();
    let gesture = shell.model().spec().gesture;
    let mut harness = Harness::builder()
        .with_size(vec2(400.0, 2000.0))
        .build_ui_state(side_panel, shell);
    harness.run_steps(2);
    assert!(harness.query_by_label(gesture).is_some());
    harness
        .get_by_role_and_label(Role::Button, "One step")
        .click();
    harness.run_steps(2);
    assert!(harness.query_by_label(gesture).is_none());
    let verdict = harness.state().model().outcome().verdict;
    assert!(harness.query_by_label(&verdict).is_some());
}

#[test]
fn a_button_with_nothing_to_do_is_disabled() {
    let mut harness = open(find("w16.10").unwrap()());
    let stop = harness.get_by_label("Stop");
    assert!(stop.accesskit_node().is_disabled());
    stop.click();
    harness.run_steps(2);
    assert!(harness.state_mut().take_requests().is_empty());
    harness.get_by_label("Open a log…").click();
    harness.run_steps(2);
    assert_eq!(harness.state_mut().take_requests(), ["open"]);
}
