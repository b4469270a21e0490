//! Until the reader acts: a ring around each handle, which pulses once.

use egui::{Stroke, Ui, pos2};

use crate::draw::HANDLE_RADIUS;
use crate::egui_surface::color;
use crate::model::Motion;
use crate::palette::{self, Theme};
use crate::scene::{Layer, Scene};
use crate::transform::Transform;

/// Duration of the pulse, s.
const PULSE_S: f32 = 1.2;
/// Distance of the resting ring from the handle, px.
const RESTING_PX: f32 = 4.0;
/// Largest distance of the pulse, px.
const WIDEST_PX: f32 = 18.0;

/// Whether the reader has acted, and the pulse until then.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FirstAct {
    /// Whether the reader has acted.
    pub is_over: bool,
    /// Whether the ring pulses or rests.
    pub motion: Motion,
    elapsed_s: f32,
}

impl FirstAct {
    /// Whether the pulse needs another frame.
    pub fn is_pulsing(&self) -> bool {
        !self.is_over && self.motion == Motion::Full && self.elapsed_s < PULSE_S
    }

    /// Paints the rings, and advances the pulse.
    pub fn paint(
        &mut self,
        ui: &Ui,
        scene: &Scene,
        panels: &[(&'static str, Transform)],
        theme: Theme,
    ) {
        if self.is_over {
            return;
        }
        let pulse = self.is_pulsing().then_some(self.elapsed_s / PULSE_S);
        self.elapsed_s += ui.input(|input| input.stable_dt);
        for (id, to) in panels {
            let panel = scene.panels.iter().find(|panel| panel.id == *id);
            for layer in panel.iter().flat_map(|panel| &panel.layers) {
                let Layer::Handle { at, tone, .. } = layer else {
                    continue;
                };
                let [x, y] = to.to_px(*at);
                let ink = color(palette::tone(theme, *tone));
                let ring = |off: f32, share: f32| {
                    let stroke = Stroke::new(2.0, ink.gamma_multiply(share));
                    ui.painter()
                        .circle_stroke(pos2(x, y), HANDLE_RADIUS + off, stroke);
                };
                ring(RESTING_PX, 0.6);
                if let Some(share) = pulse {
                    ring(RESTING_PX + share * (WIDEST_PX - RESTING_PX), 1.0 - share);
                }
            }
        }
    }
}
