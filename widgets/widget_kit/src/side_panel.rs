//! The texts, controls and result of a widget in egui's own controls, for hosts without a page.

use crate::controls::shown;
use crate::param::{ParamKind, ParamSpec};
use crate::shell::Shell;
use crate::spec::ButtonSpec;
use egui::{Button, ComboBox, DragValue, Slider, Ui};

/// Lists the controls that the widget shows, and its result.
pub fn side_panel(ui: &mut Ui, shell: &mut Shell) {
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
