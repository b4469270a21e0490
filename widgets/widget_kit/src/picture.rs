//! A complete widget without its controls on any surface: title, panels, verdict and numbers.

use crate::draw;
use crate::layout::wrap;
use crate::model::Model;
use crate::palette::{self, Rgb, Theme, tone};
use crate::readout::fact_text;
use crate::scene::{Scene, Tone};
use crate::surface::{Align, Measure, Px, Surface, TextSize};
use crate::view::{Arrangement, Row, View, place};

/// Space around the picture.
const MARGIN: f32 = 12.0;
/// Line spacing of the text.
const LINE: f32 = 19.0;
/// Line spacing of the title.
const TITLE_LINE: f32 = 26.0;
/// Space between blocks.
const GAP: f32 = 12.0;

/// Draws the current state of a widget; with `asks` its question in place of the verdict. Returns the height of
/// the picture.
pub fn picture(
    surface: &mut dyn Surface,
    model: &dyn Model,
    view: &dyn View,
    asks: bool,
    width_px: f32,
    theme: Theme,
) -> f32 {
    let scene = model.scene();
    let outcome = model.outcome();
    let spec = model.spec();
    let width = width_px - 2.0 * MARGIN;
    let ink = tone(theme, Tone::Ink);
    let mut y = MARGIN;
    let paragraph = |surface: &mut dyn Surface, y: f32, text: &str, size, color: Rgb| {
        let line_height = match size {
            TextSize::Title => TITLE_LINE,
            _ => LINE,
        };
        let mut y = y;
        for line in wrap(text, width, size, surface) {
            y += line_height;
            let at = [MARGIN, y - 0.5 * line_height];
            surface.text(at, Align::Left, &line, size, color);
        }
        y
    };

    let title = format!("{} {}", spec.id, spec.title);
    y = paragraph(surface, y, &title, TextSize::Title, ink) + 0.5 * GAP;
    let disclosure = model.disclosure();
    let Arrangement {
        stage,
        under_control,
        below,
    } = view.arrange(&scene, width).of_disclosure(&disclosure);
    for rows in [stage, under_control, below] {
        let height = panels(surface, &scene, &rows, [MARGIN, y], width, theme);
        if height > 0.0 {
            y += height + GAP;
        }
    }
    if asks {
        return paragraph(surface, y, spec.question, TextSize::Body, ink) + MARGIN;
    }
    let verdict = palette::standing(theme, outcome.standing);
    y = paragraph(surface, y, &outcome.verdict, TextSize::Body, verdict);
    y = paragraph(surface, y, &outcome.sentence, TextSize::Body, ink);
    if !disclosure.is_all() {
        return y + MARGIN;
    }
    let facts: Vec<_> = outcome
        .facts
        .iter()
        .map(|fact| format!("{} {}", fact.label, fact_text(fact)))
        .collect();
    paragraph(surface, y, &facts.join(" · "), TextSize::Body, ink) + MARGIN
}

/// Draws only the panels of a scene in the kit's arrangement. Returns their height.
pub fn scene_picture(surface: &mut dyn Surface, scene: &Scene, width_px: f32, theme: Theme) -> f32 {
    let width = width_px - 2.0 * MARGIN;
    let Arrangement {
        mut stage, below, ..
    } = Arrangement::by_weight(scene, width);
    stage.extend(below);
    panels(surface, scene, &stage, [MARGIN, 0.0], width, theme)
}

/// Positions on the [`scene_picture`] of points, each of a named panel.
pub fn scene_places(
    measure: &mut dyn Measure,
    scene: &Scene,
    width_px: f32,
    points: &[(&str, [f64; 2])],
) -> Vec<Px> {
    let width = width_px - 2.0 * MARGIN;
    let Arrangement {
        mut stage, below, ..
    } = Arrangement::by_weight(scene, width);
    stage.extend(below);
    let (placed, _) = place(scene, &stage, width, measure);
    let found = points.iter().filter_map(|(id, at)| {
        let placed = placed.iter().find(|placed| placed.panel == *id)?;
        let panel = scene.panels.iter().find(|panel| panel.id == *id)?;
        let origin = [MARGIN + placed.origin[0], placed.origin[1]];
        Some(draw::transform(panel, &placed.layout, origin, &panel.bounds()).to_px(*at))
    });
    found.collect()
}

fn panels(
    surface: &mut dyn Surface,
    scene: &Scene,
    rows: &[Row],
    [left, top]: Px,
    width: f32,
    theme: Theme,
) -> f32 {
    let (placed, height) = place(scene, rows, width, surface);
    for placed in &placed {
        let panels = scene.panels.iter();
        for panel in panels.filter(|panel| panel.id == placed.panel) {
            let origin = [left + placed.origin[0], top + placed.origin[1]];
            let window = panel.bounds();
            draw::panel(surface, panel, &placed.layout, origin, &window, theme);
        }
    }
    height
}
