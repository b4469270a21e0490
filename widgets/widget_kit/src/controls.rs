//! The controls of a widget, generated from its list of parameters.

use egui::accesskit::Role;
use egui::{Align, Button, DragValue, Layout, Slider, Ui, WidgetInfo, WidgetText};

use crate::hit_areas::HitAreas;
use crate::model::Model;
use crate::param::MORE;
use crate::param::{Choice, ParamKind, ParamSpec};
use crate::pointer::Touched;
use crate::ticks::signed;

/// Width below which a column of controls is not split in two.
const TWO_COLUMNS: f32 = 480.0;

/// Shows every parameter of the disclosure that has no other control. Returns whether any was set.
pub fn params(ui: &mut Ui, model: &mut dyn Model, hot: &mut HitAreas) -> Touched {
    let disclosure = model.disclosure();
    let specs: Vec<_> = model
        .values()
        .iter()
        .filter(|(spec, _)| !on_transport_bar(spec) && spec.id != MORE.id)
        // The reader sets a text in the picture instead of typing it.
        .filter(|(spec, _)| !matches!(spec.kind, ParamKind::Text { .. }))
        .filter(|(spec, _)| disclosure.has_param(spec.id))
        .collect();
    let mut touched = Touched::No;
    let mut show = |ui: &mut Ui, (spec, value)| {
        if param(ui, model, spec, value, hot) {
            touched = Touched::Yes;
        }
    };
    if ui.available_width() < TWO_COLUMNS {
        for shown in specs {
            show(ui, shown);
        }
        return touched;
    }
    let half = specs.len().div_ceil(2);
    ui.columns(2, |columns| {
        for (index, shown) in specs.into_iter().enumerate() {
            show(&mut columns[index / half], shown);
        }
    });
    touched
}

/// The controls that a widget shows at present, by name. What it does not show is no stop of the keyboard either.
#[must_use]
pub fn shown(model: &dyn Model) -> Vec<&'static str> {
    let (spec, disclosure) = (model.spec(), model.disclosure());
    let timeline = model.timeline().map(|timeline| timeline.param);
    let has_param = |param: &&'static ParamSpec| match param.kind {
        ParamKind::Timeline { .. } => timeline == Some(param.id),
        // The reader draws a text, or opens it; typing is for those who know it.
        ParamKind::Text { .. } => disclosure.is_all(),
        _ if on_transport_bar(param) => disclosure.is_all(),
        _ => param.id == MORE.id || disclosure.has_param(param.id),
    };
    let presets = spec.presets.iter().map(|preset| preset.id);
    let params = spec.params.iter().copied().filter(has_param);
    let buttons = spec.buttons.iter().map(|button| button.id);
    presets
        .filter(|_| disclosure.is_all())
        .chain(params.map(|param| param.id))
        .chain(buttons.filter(|id| disclosure.has_button(id)))
        .collect()
}

/// Whether the transport bar shows the parameter instead.
#[must_use]
pub fn on_transport_bar(spec: &ParamSpec) -> bool {
    matches!(spec.kind, ParamKind::Timeline { .. }) || spec.id == crate::playback::SPEED.id
}

/// Shows one parameter. Returns whether it was set.
fn param(
    ui: &mut Ui,
    model: &mut dyn Model,
    spec: &'static ParamSpec,
    value: f64,
    hot: &mut HitAreas,
) -> bool {
    let new = match spec.kind {
        ParamKind::Slider { min, max, step } => slider(ui, spec, value, [min, max, step], hot),
        ParamKind::Seed { max } => seed(ui, spec, value, max, hot),
        ParamKind::Choice { options } => {
            ui.label(spec.label).on_hover_text(spec.help);
            choice(ui, spec, options, value, hot)
        }
        ParamKind::Switch => switch(ui, spec, value, hot),
        ParamKind::Timeline { .. } | ParamKind::Text { .. } => None,
    };
    ui.add_space(2.0);
    // egui enforces the range; if rounding violates it, the old value remains.
    new.is_some_and(|new| model.set(spec.id, new).is_ok())
}

fn slider(
    ui: &mut Ui,
    spec: &'static ParamSpec,
    value: f64,
    [min, max, step]: [f64; 3],
    hot: &mut HitAreas,
) -> Option<f64> {
    let mut new = value;
    let decimals = spec.decimals();
    ui.horizontal(|ui| {
        let label = ui.label(spec.label).on_hover_text(spec.help);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let field = DragValue::new(&mut new)
                .speed(step)
                .range(min..=max)
                .custom_formatter(|value, _| signed(value, decimals))
                .custom_parser(|text| text.replace('−', "-").trim().parse().ok())
                .suffix(unit_suffix(spec.unit))
                .update_while_editing(false);
            let response = ui.add(field).on_hover_text(spec.help);
            hot.control(spec.id, &response);
            hot.drag(&response);
            response.accessible_name(format!("{} as a number", spec.label));
            label.id
        })
        .inner
    });
    ui.spacing_mut().slider_width = ui.available_width();
    let response = ui.add(
        Slider::new(&mut new, min..=max)
            .step_by(step)
            // A value from a link may lie between two steps; it stays until the reader moves it.
            .clamping(egui::SliderClamping::Edits)
            .show_value(false),
    );
    hot.control(spec.id, &response);
    hot.drag(&response);
    response.widget_info(|| WidgetInfo::slider(true, new, spec.label));
    response.on_hover_text(spec.help);
    changed(value, new).map(tidy)
}

/// Rounds away 0.9500000000000001, which steps from the minimum produce and links would contain.
fn tidy(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

fn seed(
    ui: &mut Ui,
    spec: &'static ParamSpec,
    value: f64,
    max: f64,
    hot: &mut HitAreas,
) -> Option<f64> {
    let mut new = value;
    ui.horizontal(|ui| {
        let label = ui.label(spec.label).on_hover_text(spec.help);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let field = DragValue::new(&mut new)
                .speed(0.1)
                .range(0.0..=max)
                .fixed_decimals(0)
                .update_while_editing(false);
            let response = ui.add(field).on_hover_text(spec.help);
            hot.control(spec.id, &response);
            hot.drag(&response);
            response.labelled_by(label.id);
        });
    });
    changed(value, new.round())
}

/// Options side by side, with the selected one filled.
pub fn choice(
    ui: &mut Ui,
    spec: &'static ParamSpec,
    options: &[Choice],
    value: f64,
    hot: &mut HitAreas,
) -> Option<f64> {
    let mut new = value;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (index, option) in options.iter().enumerate() {
            let chosen = value == index as f64;
            let response =
                ui.add(Button::selectable(chosen, option.label).frame_when_inactive(true));
            response.widget_info(|| {
                let name = format!("{}: {}", spec.label, option.label);
                WidgetInfo::selected(Role::RadioButton, true, chosen, name)
            });
            hot.control(spec.id, &response);
            if response.on_hover_text(spec.help).clicked() {
                new = index as f64;
            }
        }
    });
    changed(value, new)
}

fn switch(ui: &mut Ui, spec: &'static ParamSpec, value: f64, hot: &mut HitAreas) -> Option<f64> {
    let mut on = value != 0.0;
    let response = ui.checkbox(&mut on, WidgetText::from(spec.label));
    hot.control(spec.id, &response);
    response.on_hover_text(spec.help);
    changed(value, f64::from(u8::from(on)))
}

fn unit_suffix(unit: &str) -> String {
    match unit {
        "" | "°" => unit.to_owned(),
        _ => format!("\u{202f}{unit}"),
    }
}

fn changed(old: f64, new: f64) -> Option<f64> {
    (old.to_bits() != new.to_bits()).then_some(new)
}
