//! The blocks of a widget around its panels.

use egui::{Button, Frame, RichText, Ui, vec2};

use super::Shell;
use crate::model::apply_preset;
use crate::param::MORE;
use crate::pointer::Touched;
use crate::spec::DEFAULTS;
use crate::style::TARGET;
use crate::{controls, readout, transport};

impl Shell {
    /// Title, misconception, and presets.
    pub(super) fn header(&mut self, ui: &mut Ui) {
        let spec = self.model.spec();
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(spec.id).weak());
            ui.heading(spec.title);
        });
        ui.label(spec.misconception);
        if spec.presets.is_empty() || !self.model.disclosure().is_all() {
            return;
        }
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("What to try").strong());
            for preset in spec.presets {
                let response = ui.add(Button::new(preset.label).min_size(vec2(0.0, TARGET)));
                self.hot.control(preset.id, &response);
                if response.on_hover_text(preset.help).clicked() {
                    // A failing preset names an unknown parameter; the tests press all presets.
                    let _ = apply_preset(self.model.as_mut(), preset);
                    self.act();
                }
            }
        });
    }

    /// What to notice.
    pub(super) fn notice(&mut self, ui: &mut Ui) {
        let spec = self.model.spec();
        if spec.notice.is_empty() || !self.model.disclosure().is_all() {
            return;
        }
        ui.label(RichText::new("What to notice").strong());
        for sentence in spec.notice {
            ui.horizontal_top(|ui| {
                ui.label("•");
                ui.add(egui::Label::new(*sentence).wrap());
            });
        }
    }

    /// The tabs over the picture, if the widget has two views.
    pub(super) fn tabs(&mut self, ui: &mut Ui) {
        let Some(tabs) = self.model.tabs() else {
            return;
        };
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            for (is_second, name) in [(false, tabs.first), (true, tabs.button.label)] {
                let is_shown = is_second == tabs.is_second;
                let tab = Button::selectable(is_shown, name).frame_when_inactive(true);
                let response = ui.add(tab.min_size(vec2(64.0, TARGET)));
                if is_second {
                    self.hot.control(tabs.button.id, &response);
                }
                if response.on_hover_text(tabs.button.help).clicked() && !is_shown {
                    // The button is one of the widget's.
                    let _ = self.model.press(tabs.button.id);
                    self.act();
                }
            }
        });
    }

    /// Buttons, speed, timeline.
    pub(super) fn transport(&mut self, ui: &mut Ui) {
        let touched = transport::bar(ui, self.model.as_mut(), self.theme, &mut self.hot);
        if touched == Touched::Yes {
            self.act();
        }
    }

    /// The controls, with "defaults" below them.
    pub(super) fn controls(&mut self, ui: &mut Ui) {
        if controls::params(ui, self.model.as_mut(), &mut self.hot) == Touched::Yes {
            self.act();
        }
        let disclosure = self.model.disclosure();
        let defaults = self
            .model
            .spec()
            .buttons
            .iter()
            .find(|button| button.id == DEFAULTS.id && disclosure.has_button(button.id));
        if let Some(spec) = defaults
            && transport::button(ui, spec, true, false, &mut self.hot).clicked()
        {
            // The button comes from the widget's own list.
            let _ = self.model.press(spec.id);
            self.act();
        }
    }

    /// Verdict and numbers after the changes by the controls.
    pub(super) fn outcome(&mut self, ui: &mut Ui) {
        self.refresh();
        Frame::group(ui.style()).inner_margin(10.0).show(ui, |ui| {
            ui.set_min_width(ui.available_width());
            let outcome = &self.shown.outcome;
            if self.asks() {
                readout::question(ui, self.model.spec().question, outcome);
                return;
            }
            readout::verdict(ui, outcome, self.theme);
            if self.model.disclosure().is_all() {
                readout::facts(ui, &self.shown.outcome);
            }
        });
    }

    /// The button that shows everything or hides it again.
    pub(super) fn more(&mut self, ui: &mut Ui) {
        let Some((spec, shown)) = self.model.values().find(MORE.id) else {
            return;
        };
        let label = if shown == 0.0 { "More" } else { "Less" };
        let response = ui.add(Button::new(label).min_size(vec2(64.0, TARGET)));
        self.hot.control(spec.id, &response);
        if response.on_hover_text(spec.help).clicked() {
            // The parameter is in the list, and a switch is 0 or 1.
            let _ = self.model.set(spec.id, 1.0 - shown);
            self.act();
        }
    }

    /// Tables beside the picture.
    pub(super) fn tables(&mut self, ui: &mut Ui) {
        if !self.model.disclosure().is_all() {
            return;
        }
        for table in &self.shown.tables {
            readout::table(ui, table, self.theme);
            ui.add_space(6.0);
        }
    }

    /// Controls, outcome and tables in one column.
    pub(super) fn side(&mut self, ui: &mut Ui) {
        self.controls(ui);
        ui.add_space(6.0);
        self.outcome(ui);
        ui.add_space(6.0);
        self.more(ui);
        ui.add_space(6.0);
        self.tables(ui);
    }
}
