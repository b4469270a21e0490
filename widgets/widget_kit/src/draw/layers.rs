//! The layers of a panel.

use super::marks::{is_finite, mark};
use super::plan;
use crate::palette::{Rgb, Theme, readable_on, tone};
use crate::scene::{Layer, Mark, Stroke, Tone};
use crate::surface::{Align, Haloed, Pen, Px, Surface, TextSize};
use crate::transform::Transform;

/// Radius of a handle's ring in pixels: a target 24 pixels across, with its stroke.
pub const HANDLE_RADIUS: f32 = 9.0;

/// Draws one layer; `key` identifies its texture.
pub fn layer(surface: &mut dyn Surface, layer: &Layer, to: &Transform, theme: Theme, key: &str) {
    match layer {
        Layer::Points {
            points,
            mark: shape,
            tone: meaning,
            radius_px,
        } => {
            let color = tone(theme, *meaning);
            for at in points.iter().filter(|at| is_finite(at)) {
                mark(surface, to.to_px(*at), *shape, *radius_px, color);
            }
        }
        Layer::Line {
            points,
            stroke,
            tone: meaning,
            width_px,
        } => {
            let pen = pen(theme, *meaning, *width_px, *stroke);
            for run in points.split(|at| !is_finite(at)) {
                let run: Vec<Px> = run.iter().map(|at| to.to_px(*at)).collect();
                if run.len() > 1 {
                    surface.line(&run, pen);
                }
            }
        }
        Layer::Segments {
            segments,
            stroke,
            tone: meaning,
            width_px,
        } => {
            let pen = pen(theme, *meaning, *width_px, *stroke);
            for [a, b] in segments
                .iter()
                .filter(|[a, b]| is_finite(a) && is_finite(b))
            {
                surface.line(&[to.to_px(*a), to.to_px(*b)], pen);
            }
        }
        // The frame draws it, because it is all that its panel shows.
        Layer::Question(_) => {}
        Layer::Walls(walls) => plan::walls(surface, walls, to, theme),
        Layer::Seen {
            from,
            points,
            tone: meaning,
        } => {
            if is_finite(from) {
                let returns = points.iter().filter(|at| is_finite(at));
                let returns = returns.map(|at| to.to_px(*at)).collect();
                plan::seen(surface, to.to_px(*from), returns, tone(theme, *meaning));
            }
        }
        Layer::Threads { threads, reach } => {
            plan::threads(surface, threads, *reach, to, theme);
        }
        Layer::Pose {
            pose,
            mark: shape,
            tone: meaning,
            radius_px,
        } => {
            if pose.iter().all(|value| value.is_finite()) {
                plan::robot(surface, *pose, *shape, *meaning, *radius_px, to, theme);
            }
        }
        Layer::Handle {
            at, tone: meaning, ..
        } => {
            if is_finite(at) {
                handle(surface, to.to_px(*at), tone(theme, *meaning), theme);
            }
        }
        Layer::Ellipse {
            center,
            half_axes: [a, b],
            stroke,
            tone: meaning,
        } => {
            let pen = pen(theme, *meaning, 1.75, *stroke);
            let points: Vec<Px> = (0..=64)
                .map(|k| {
                    let (sin, cos) = (f64::from(k) / 64.0 * core::f64::consts::TAU).sin_cos();
                    to.to_px(core::array::from_fn(|i| {
                        center[i] + a[i] * cos + b[i] * sin
                    }))
                })
                .filter(|px| px.iter().all(|value| value.is_finite()))
                .collect();
            let middle = to.to_px(*center);
            if points.len() > 1 && middle.iter().all(|value| value.is_finite()) {
                plan::unsure(surface, middle, &points, pen.color);
                surface.line(&points, pen);
            }
        }
        Layer::Raster(raster) => surface.raster(to.rect_to_px(&raster.bounds), raster, key),
        Layer::Text {
            at,
            text,
            tone: meaning,
        } => {
            if is_finite(at) {
                words(surface, to.to_px(*at), text, *meaning, theme);
            }
        }
        // Drawn above all layers, once the positions of all labels are known.
        Layer::Label { .. } => {}
    }
}

/// A disc of paper with a ring and a dot, which looks draggable.
fn handle(surface: &mut dyn Surface, at: Px, color: Rgb, theme: Theme) {
    let paper = tone(theme, Tone::Paper);
    surface.circle(at, HANDLE_RADIUS, Some(paper), Some(Pen::solid(color, 2.5)));
    mark(surface, at, Mark::Dot, 3.5, color);
}

/// Text over data: black or white on the area of its class, otherwise with a halo of paper.
pub fn words(surface: &mut dyn Surface, at: Px, text: &str, meaning: Tone, theme: Theme) {
    let ink = tone(theme, meaning);
    if let Tone::Class(_) = meaning {
        let ink = readable_on(ink);
        surface.text(at, Align::Center, text, TextSize::Small, ink);
    } else {
        let halo = tone(theme, Tone::Paper);
        let colors = Haloed { ink, halo };
        surface.haloed_text(at, Align::Center, text, TextSize::Small, colors);
    }
}

fn pen(theme: Theme, meaning: Tone, width: f32, stroke: Stroke) -> Pen {
    Pen {
        color: tone(theme, meaning),
        width,
        stroke,
    }
}
