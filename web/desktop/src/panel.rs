//! The side panel: the texts, controls and result of a widget, by egui's stock controls.

use egui::{Button, ComboBox, DragValue, Slider, Ui};
use widget_kit::controls::shown;
use widget_kit::param::{ParamKind, ParamSpec};
use widget_kit::shell::Shell;
use widget_kit::spec::ButtonSpec;

/// Lists the controls that the widget shows, and its result.
pub fn panel(ui: &mut Ui, shell: &mut Shell) {
    let spec = shell.model().spec();
    ui.heading(spec.title);
    ui.separator();
    for id in shown(shell.model()) {
        if let Some(preset) = spec.presets.iter().find(|preset| preset.id == id) {
            press(ui, shell, preset.id, preset.label, preset.help);
        } else if let Some(param) = spec.params.iter().find(|param| param.id == id) {
            set(ui, shell, param);
        } else if let Some(ButtonSpec { id, label, help }) =
            spec.buttons.iter().find(|button| button.id == id)
        {
            press(ui, shell, id, label, help);
        }
    }
    ui.separator();
    let outcome = shell.model().outcome();
    if shell.asks() {
        ui.strong(spec.gesture);
        return;
    }
    ui.strong(&outcome.verdict);
    ui.label(outcome.in_full());
    if shell.model().disclosure().is_all() {
        for fact in &outcome.facts {
            ui.label(format!("{}: {}", fact.label, fact.text()));
        }
    }
}

fn press(ui: &mut Ui, shell: &mut Shell, id: &str, label: &str, help: &str) {
    let model = shell.model();
    let label = match id {
        "play" if model.is_pressed(id) => "Pause",
        _ => label,
    };
    let button = Button::new(label).selected(model.is_pressed(id));
    let response = ui.add_enabled(model.is_enabled(id), button);
    if response.on_hover_text(help).clicked() {
        // The button comes from the widget's own list.
        let _ = shell.press(id);
    }
}

fn set(ui: &mut Ui, shell: &mut Shell, param: &'static ParamSpec) {
    let value = shell.model().values().number(param.id);
    let mut new = value;
    let response = match param.kind {
        ParamKind::Slider { min, max, step } => {
            let slider = Slider::new(&mut new, min..=max)
                .step_by(step)
                .suffix(param.unit);
            // A value from a link may lie between two steps; it stays until the reader moves it.
            ui.add(
                slider
                    .clamping(egui::SliderClamping::Edits)
                    .text(param.label),
            )
        }
        ParamKind::Timeline { .. } => {
            let last = shell.model().timeline().map_or(0.0, |run| run.last);
            // A position beyond the end means the current end.
            new = new.min(last);
            ui.add(
                Slider::new(&mut new, 0.0..=last)
                    .integer()
                    .text(param.label),
            )
        }
        ParamKind::Seed { max } => {
            let field = DragValue::new(&mut new).range(0.0..=max).fixed_decimals(0);
            ui.horizontal(|ui| {
                let label = ui.label(param.label);
                ui.add(field).labelled_by(label.id)
            })
            .inner
        }
        ParamKind::Choice { options } => {
            let shown = ComboBox::new(param.id, param.label)
                .selected_text(options[value as usize].label)
                .show_ui(ui, |ui| {
                    for (index, option) in options.iter().enumerate() {
                        ui.selectable_value(&mut new, index as f64, option.label);
                    }
                });
            shown.response
        }
        ParamKind::Switch => {
            let mut on = value != 0.0;
            let response = ui.checkbox(&mut on, param.label);
            new = f64::from(u8::from(on));
            response
        }
        // The reader draws a text in the picture.
        ParamKind::Text { .. } => return,
    };
    response.on_hover_text(param.help);
    if new.to_bits() != value.to_bits() {
        // egui enforces the range; if rounding violates it, the old value remains.
        let _ = shell.model_mut().set(param.id, new);
        shell.act();
    }
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui::{Key, vec2};
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};
    use widget_kit::param::MORE;
    use widgets::registry::{SHELLS, find};

    use super::*;

    /// The panel of a widget, with all its controls.
    fn open(mut shell: Shell) -> Harness<'static, Shell> {
        let more = shell.model_mut().set(MORE.id, 1.0);
        more.expect("every widget has layers");
        shell.finish_work();
        let mut harness = Harness::builder()
            .with_size(vec2(400.0, 4000.0))
            .build_ui_state(panel, shell);
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
                let value = |harness: &Harness<'_, Shell>| {
                    harness.state().model().values().number(param.id)
                };
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
            .build_ui_state(panel, shell);
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
}
