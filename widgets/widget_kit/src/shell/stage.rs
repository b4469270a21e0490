//! The panels of a widget: their layout, the pointer on them, and their painting.
//!
//! The layout comes first and the painting last. The controls come in between, so their changes show in the
//! same frame.

use egui::{Rect, Ui, pos2, vec2};

use super::{GAP, Shell};
use crate::egui_surface::{EguiMeasure, EguiSurface};
use crate::layout::PanelLayout;
use crate::pointer::Touched;
use crate::scene::{Panel, Scene};
use crate::view::{self, Arrangement, Placed, Row};
use crate::{draw, style};

/// Width from which the opening control is beside the verdict.
const BESIDE_THE_VERDICT: f32 = 480.0;
/// Its share of the width: a verdict has more text.
const CONTROL_SHARE: f32 = 0.38;

/// A panel with its layout for this frame; it is painted last, after all changes of the model.
pub(super) struct Reserved {
    placed: Placed,
    origin: [f32; 2],
    /// Revision of the scene that was laid out.
    revision: u64,
}

impl Shell {
    /// Panels, transport bar and side plots in one column.
    pub(super) fn stage(
        &mut self,
        ui: &mut Ui,
        at: [f32; 2],
        width: f32,
        out: &mut Vec<Reserved>,
    ) -> f32 {
        let Arrangement { stage, below, .. } = self.arrange(ui, width);
        let y = self.block(ui, at, width, Self::tabs);
        let y = self.reserve(ui, [at[0], y], width, &stage, out);
        let y = self.block(ui, [at[0], y], width, Self::transport);
        self.reserve(ui, [at[0], y], width, &below, out)
    }

    /// Everything in one column: panels, transport, verdict and controls, side plots, tables.
    pub(super) fn stage_narrow(
        &mut self,
        ui: &mut Ui,
        at: [f32; 2],
        width: f32,
        out: &mut Vec<Reserved>,
    ) -> f32 {
        let Arrangement {
            stage,
            under_control,
            below,
        } = self.arrange(ui, width);
        let y = self.block(ui, at, width, Self::tabs);
        let y = self.reserve(ui, [at[0], y], width, &stage, out);
        let y = self.block(ui, [at[0], y], width, Self::transport);
        if width >= BESIDE_THE_VERDICT && !self.model.disclosure().is_all() {
            let control = CONTROL_SHARE * width;
            let verdict = [at[0] + control + GAP, y];
            let y = self.block(ui, [at[0], y], control, Self::controls);
            let y = self.block(ui, [at[0], y], control, Self::more);
            return y.max(self.block(ui, verdict, width - control - GAP, Self::outcome));
        }
        let y = self.block(ui, [at[0], y], width, Self::controls);
        let y = self.block(ui, [at[0], y], width, Self::outcome);
        let y = self.block(ui, [at[0], y], width, Self::more);
        let y = self.reserve(ui, [at[0], y], width, &under_control, out);
        let y = self.reserve(ui, [at[0], y], width, &below, out);
        self.block(ui, [at[0], y], width, Self::tables)
    }

    fn arrange(&mut self, ui: &Ui, width: f32) -> Arrangement {
        let arrangement = self.view.arrange(&self.shown.scene, width);
        let disclosure = self.model.disclosure();
        let mut arrangement = arrangement.of_disclosure(&disclosure);
        let mut measure = EguiMeasure(ui.painter().clone());
        self.room.begin(!disclosure.is_all());
        let scene = &self.shown.scene;
        self.room.fit(&mut arrangement.stage, |rows| {
            view::place(scene, rows, width, &mut measure)
        });
        arrangement
    }

    /// Lays out the panels and handles the pointer on them.
    fn reserve(
        &mut self,
        ui: &mut Ui,
        at: [f32; 2],
        width: f32,
        rows: &[Row],
        out: &mut Vec<Reserved>,
    ) -> f32 {
        let mut measure = EguiMeasure(ui.painter().clone());
        let (placed, height) = view::place(&self.shown.scene, rows, width, &mut measure);
        let mut touched = false;
        for placed in placed {
            let origin = [at[0] + placed.origin[0], at[1] + placed.origin[1]];
            let Some(panel) = find(&self.shown.scene, placed.panel) else {
                continue;
            };
            let window = self.pointer.zoom.window(panel);
            let to = draw::transform(panel, &placed.layout, origin, &window);
            let effect = self
                .pointer
                .panel(ui, panel, &to, self.model.as_mut(), &mut self.hot);
            touched |= effect == Touched::Yes;
            self.first.is_over |= self.pointer.has_pressed();
            if self.pointer.zoom.is_zoomed(panel.id) {
                let size = vec2(96.0, style::TARGET);
                let corner = pos2(origin[0] + placed.layout.size[0] - size.x, origin[1]);
                let button = egui::Button::new("Reset zoom");
                if ui.put(Rect::from_min_size(corner, size), button).clicked() {
                    self.pointer.zoom.reset(panel.id);
                }
            }
            out.push(Reserved {
                placed,
                origin,
                revision: self.revision,
            });
        }
        if touched {
            self.touch();
        }
        if height > 0.0 {
            at[1] + height + GAP
        } else {
            at[1]
        }
    }

    /// Paints the panels with the current state of the model.
    pub(super) fn paint(&mut self, ui: &Ui, reserved: &[Reserved]) {
        self.refresh();
        let mut surface = EguiSurface::new(ui.painter(), &mut self.textures, self.theme);
        for reserved in reserved {
            let Reserved { placed, origin, .. } = reserved;
            let Some(panel) = find(&self.shown.scene, placed.panel) else {
                continue;
            };
            let window = self.pointer.zoom.window(panel);
            let [width, height] = placed.layout.size;
            let whole = Rect::from_min_size(pos2(origin[0], origin[1]), vec2(width, height));
            if !ui.is_rect_visible(whole) {
                continue;
            }
            let again = (reserved.revision != self.revision)
                .then(|| PanelLayout::new(panel, width, placed.layout.asked, &mut surface))
                // If the text needs another row, the next frame lays it out.
                .filter(|layout| layout.size == placed.layout.size);
            let layout = again.as_ref().unwrap_or(&placed.layout);
            draw::panel(&mut surface, panel, layout, *origin, &window, self.theme);
            let to = draw::transform(panel, layout, *origin, &window);
            self.panels.push((panel.id, to));
        }
    }
}

fn find<'a>(scene: &'a Scene, id: &str) -> Option<&'a Panel> {
    scene.panels.iter().find(|panel| panel.id == id)
}
