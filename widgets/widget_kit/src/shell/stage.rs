//! The panels of a widget: their layout, the pointer on them, and their painting.
//!
//! The layout comes first and the painting last. Work on the model comes in between, and shows in the same frame.

use egui::{Rect, Ui, pos2, vec2};

use super::{Shell, room};
use crate::draw;
use crate::egui_surface::{EguiMeasure, EguiSurface};
use crate::layout::PanelLayout;
use crate::pointer::Touched;
use crate::scene::{Panel, Scene};
use crate::view::{self, MARGIN, PANEL_GAP, Placed, Row};

/// A panel with its layout for this frame; it is painted last, after all changes of the model.
pub(super) struct Reserved {
    placed: Placed,
    origin: [f32; 2],
    /// Revision of the scene that was laid out.
    revision: u64,
}

impl Shell {
    /// Lays out the panels and handles the pointer on them. Returns them with their height.
    pub(super) fn reserve(&mut self, ui: &Ui, at: [f32; 2], width: f32) -> (Vec<Reserved>, f32) {
        let mut measure = EguiMeasure(ui.painter().clone());
        let arrangement = (self.view)(&self.scene, width);
        let mut arrangement = arrangement.of_disclosure(&self.model.disclosure());
        room::fit(&mut arrangement.stage, self.room - 2.0 * MARGIN, |rows| {
            view::place(&self.scene, rows, width, &mut measure)
        });
        let mut place = |rows: &[Row]| view::place(&self.scene, rows, width, &mut measure);
        let (mut placed, mut height) = place(&arrangement.stage);
        self.stage_height = height + 2.0 * MARGIN;
        let (below, below_height) = place(&arrangement.below);
        if !below.is_empty() {
            let top = self.stage_height - MARGIN + self.gap + PANEL_GAP;
            placed.extend(below.into_iter().map(|mut placed| {
                placed.origin[1] += top;
                placed
            }));
            height = top + below_height;
        }
        let mut touched = false;
        let mut reserved = Vec::with_capacity(placed.len());
        for placed in placed {
            let origin = [at[0] + placed.origin[0], at[1] + placed.origin[1]];
            let Some(panel) = find(&self.scene, placed.panel) else {
                continue;
            };
            let window = self.pointer.zoom.window(panel);
            let to = draw::transform(panel, &placed.layout, origin, &window);
            let effect = self.pointer.panel(ui, panel, &to, self.model.as_mut());
            touched |= effect == Touched::Yes;
            if self.pointer.has_pressed() && !self.first.is_over {
                self.act();
            }
            reserved.push(Reserved {
                placed,
                origin,
                revision: self.revision,
            });
        }
        if touched {
            self.touch();
        }
        (reserved, height)
    }

    /// Paints the panels with the current state of the model.
    pub(super) fn paint(&mut self, ui: &Ui, reserved: &[Reserved]) {
        self.refresh();
        let mut surface = EguiSurface::new(ui.painter(), &mut self.textures, self.theme);
        for reserved in reserved {
            let Reserved { placed, origin, .. } = reserved;
            let Some(panel) = find(&self.scene, placed.panel) else {
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
