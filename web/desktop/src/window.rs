//! A window with a widget in it: its picture, and its controls in a panel beside it.

use egui::{PopupAnchor, Tooltip};
use widget_kit::palette::Theme;
use widget_kit::shell::Shell;
use widget_kit::side_panel::side_panel;

/// Width of the side panel, points.
const PANEL: f32 = 340.0;
/// Distance of a handle's effect from the pointer, points: what is grabbed stays visible.
const POINTER_GAP: f32 = 16.0;

/// Opens a window with that widget and returns when it is closed.
///
/// # Errors
/// [`eframe::Error`] if no window can be opened, for example without a display.
pub fn run(shell: Shell) -> eframe::Result {
    let title = shell.model().spec().title;
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_inner_size([1180.0, 860.0])
            .with_min_inner_size([700.0, 480.0])
            .with_title(title),
        ..Default::default()
    };
    eframe::run_native(title, options, Box::new(|_| Ok(Box::new(Window { shell }))))
}

struct Window {
    shell: Shell,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.shell.set_theme(match ui.ctx().theme() {
            egui::Theme::Light => Theme::Light,
            egui::Theme::Dark => Theme::Dark,
        });
        egui::Panel::right("controls")
            .exact_size(PANEL)
            .show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| side_panel(ui, &mut self.shell));
            });
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| self.shell.ui(ui));
        if let Some(effect) = self.shell.handle() {
            Tooltip::always_open(
                ui.ctx().clone(),
                ui.layer_id(),
                ui.scope_id(),
                PopupAnchor::Pointer,
            )
            .gap(POINTER_GAP)
            .show(|ui| ui.label(effect));
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
