//! The shapes of points: one for each meaning, so that no meaning depends on colour alone.

use crate::palette::Rgb;
use crate::scene::Mark;
use crate::surface::{Pen, Px, Surface};

/// Draws one mark.
pub fn mark(surface: &mut dyn Surface, at: Px, mark: Mark, radius: f32, color: Rgb) {
    let [x, y] = at;
    let r = radius;
    let pen = Pen::solid(color, (0.45 * r).clamp(1.2, 2.2));
    match mark {
        Mark::Circle => surface.circle(at, r, None, Some(pen)),
        Mark::Dot => surface.circle(at, r, Some(color), None),
        Mark::Triangle => {
            surface.polygon(
                &[
                    [x, y - r],
                    [x + 0.9 * r, y + 0.75 * r],
                    [x - 0.9 * r, y + 0.75 * r],
                ],
                color,
            );
        }
        Mark::Square => {
            let h = 0.85 * r;
            surface.polygon(
                &[
                    [x - h, y - h],
                    [x + h, y - h],
                    [x + h, y + h],
                    [x - h, y + h],
                ],
                color,
            );
        }
        Mark::Cross => {
            let h = 0.8 * r;
            surface.line(&[[x - h, y - h], [x + h, y + h]], pen);
            surface.line(&[[x - h, y + h], [x + h, y - h]], pen);
        }
        Mark::Plus => {
            surface.line(&[[x - r, y], [x + r, y]], pen);
            surface.line(&[[x, y - r], [x, y + r]], pen);
        }
    }
}

/// Whether a point can be drawn.
pub fn is_finite(at: &[f64; 2]) -> bool {
    at[0].is_finite() && at[1].is_finite()
}
