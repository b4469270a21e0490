//! The panels of a widget on any surface, without the pointer.

use crate::draw;
use crate::model::{Model, shown_scene};
use crate::palette::Theme;
use crate::scene::Scene;
use crate::surface::{Measure, Px, Surface};
use crate::view::{Arrangement, MARGIN, View};

/// Draws the panels of a widget's current state, as its live picture does. Returns the height of the picture.
pub fn picture(
    surface: &mut dyn Surface,
    model: &dyn Model,
    view: View,
    width_px: f32,
    theme: Theme,
) -> f32 {
    let scene = shown_scene(model);
    let width = width_px - 2.0 * MARGIN;
    let arrangement = view(&scene, width).of_disclosure(&model.disclosure());
    2.0 * MARGIN
        + panels(
            surface,
            &scene,
            &arrangement,
            [MARGIN, MARGIN],
            width,
            theme,
        )
}

/// Draws only the panels of a scene in the kit's arrangement. Returns their height.
pub fn scene_picture(surface: &mut dyn Surface, scene: &Scene, width_px: f32, theme: Theme) -> f32 {
    let width = width_px - 2.0 * MARGIN;
    let arrangement = Arrangement::by_weight(scene, width);
    panels(surface, scene, &arrangement, [MARGIN, 0.0], width, theme)
}

/// Positions on the [`scene_picture`] of points, each of a named panel.
pub fn scene_places(
    measure: &mut dyn Measure,
    scene: &Scene,
    width_px: f32,
    points: &[(&str, [f64; 2])],
) -> Vec<Px> {
    let width = width_px - 2.0 * MARGIN;
    let (placed, _) = Arrangement::by_weight(scene, width).place(scene, width, measure);
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
    arrangement: &Arrangement,
    [left, top]: Px,
    width: f32,
    theme: Theme,
) -> f32 {
    let (placed, height) = arrangement.place(scene, width, surface);
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
