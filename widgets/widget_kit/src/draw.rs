//! Draws a panel on a surface: shared by the live picture, SVG and print.

mod edge;
mod frame;
mod labels;
mod layers;
mod marks;
mod plan;

use crate::layout::PanelLayout;
use crate::palette::Theme;
use crate::scene::{Bounds, Panel};
use crate::surface::{Px, Surface};
use crate::transform::Transform;
pub use layers::HANDLE_RADIUS;

/// The transform of a panel whose top left corner is at `origin`; `window` is the visible part.
#[must_use]
pub fn transform(panel: &Panel, layout: &PanelLayout, origin: Px, window: &Bounds) -> Transform {
    Transform::new(layout.plot.moved(origin), *window, panel.aspect)
}

/// Draws a panel with its frame, layers, colour bar and legend.
pub fn panel(
    surface: &mut dyn Surface,
    panel: &Panel,
    layout: &PanelLayout,
    origin: Px,
    window: &Bounds,
    theme: Theme,
) {
    let transform = transform(panel, layout, origin, window);
    if let Some(words) = panel.question() {
        frame::question(surface, words, &transform.plot(), theme);
        return;
    }
    frame::back(surface, panel, &transform, theme);
    let plot = transform.plot();
    surface.clip(Some(plot));
    for (index, layer) in panel.layers.iter().enumerate() {
        let key = format!("{}/{index}", panel.id);
        let over = edge::reach_over(layer, &transform);
        if let Some(reach) = over {
            surface.clip(Some(plot.grown(reach)));
        }
        layers::layer(surface, layer, &transform, theme, &key);
        if over.is_some() {
            surface.clip(Some(plot));
        }
    }
    labels::labels(surface, panel, &transform, theme);
    surface.clip(None);
    frame::front(surface, panel, layout, origin, &transform, theme);
}
