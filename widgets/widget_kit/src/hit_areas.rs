//! Positions of a frame's controls: for focus rings, and for the decision what a touch drags.

use egui::{Rect, Response};

/// Positions of this frame's controls.
#[derive(Clone, Debug, Default)]
pub struct HitAreas {
    controls: Vec<(&'static str, Rect)>,
    drags: Vec<Rect>,
}

impl HitAreas {
    /// Records a control by the name of its parameter, button or preset.
    pub fn control(&mut self, id: &'static str, response: &Response) {
        match self.controls.iter_mut().find(|(known, _)| *known == id) {
            // The slider and the number field of one parameter share a ring.
            Some((_, rect)) => *rect = rect.union(response.rect),
            None => self.controls.push((id, response.rect)),
        }
    }

    /// Records something draggable, with the margin within which egui accepts a press.
    pub fn drag(&mut self, response: &Response) {
        let reach = response.ctx.global_style().interaction.interact_radius;
        self.drags.push(response.rect.expand(reach));
    }

    /// The rectangle of a control.
    #[must_use]
    pub fn rect(&self, id: &str) -> Option<Rect> {
        let found = self.controls.iter().find(|(known, _)| *known == id);
        found.map(|(_, rect)| *rect)
    }

    /// Whether something draggable is at that position.
    #[must_use]
    pub fn drags_at(&self, at: egui::Pos2) -> bool {
        self.drags.iter().any(|rect| rect.contains(at))
    }
}
