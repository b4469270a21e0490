//! Places text near points without overlaps.

use super::layers::words;
use super::marks::is_finite;
use crate::palette::{self, Theme};
use crate::scene::{Layer, Panel, Tone};
use crate::surface::{Pen, Px, PxRect, Surface, TextSize};
use crate::transform::Transform;

/// Height of a line of small text with its margin.
const LINE: f32 = 17.0;
/// Margin between the text and its neighbours.
const ROOM: f32 = 3.0;
/// Candidate positions, as multiples of half the text's size: above and below the point, then beside it.
const SIDES: [[f32; 2]; 8] = [
    [0.0, -1.0],
    [0.0, 1.0],
    [1.0, 0.0],
    [-1.0, 0.0],
    [1.0, -1.0],
    [-1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
];
/// Largest displacement of a text, in lines.
const MAX_LINES: u16 = 6;

/// Draws the labels of a panel, in the order of the layers.
pub fn labels(surface: &mut dyn Surface, panel: &Panel, to: &Transform, theme: Theme) {
    let mut taken = Vec::new();
    for layer in &panel.layers {
        if let Layer::Text { at, text, .. } = layer
            && is_finite(at)
        {
            let width = surface.text_width(text, TextSize::Small);
            taken.push(around(to.to_px(*at), width));
        }
    }
    let plot = to.plot();
    let labels = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Label { at, text, clear_px } if is_finite(at) && plot.contains(to.to_px(*at)) => {
            Some((to.to_px(*at), text, clear_px))
        }
        _ => None,
    });
    let labels: Vec<_> = labels.collect();
    let points: Vec<Px> = labels.iter().map(|(px, ..)| *px).collect();
    for (px, text, clear_px) in labels {
        let width = surface.text_width(text, TextSize::Small);
        if let Some(place) = place(px, width, *clear_px, &plot, &taken, &points) {
            leader(surface, px, &place, *clear_px, theme);
            surface.rect(place, palette::tone(theme, Tone::Paper));
            words(surface, place.center(), text, Tone::Ink, theme);
            taken.push(place);
        }
    }
}

/// A line from the point to a text that had to move away from it.
fn leader(surface: &mut dyn Surface, at: Px, place: &PxRect, clear_px: f32, theme: Theme) {
    if distance(at, place) > clear_px + LINE {
        let pen = Pen::solid(palette::tone(theme, Tone::Ink), 1.0);
        surface.line(&[at, nearest(at, place)], pen);
    }
}

/// The spot of a rectangle nearest to a point.
fn nearest([x, y]: Px, place: &PxRect) -> Px {
    [
        x.clamp(place.left, place.right()),
        y.clamp(place.top, place.bottom()),
    ]
}

fn distance(at: Px, place: &PxRect) -> f32 {
    let near = nearest(at, place);
    let [x, y] = [near[0] - at[0], near[1] - at[1]];
    (x * x + y * y).sqrt()
}

/// The nearest free rectangle for text of that width to which no other of the labelled points is nearer; `None` if there
/// is none.
fn place(
    at: Px,
    width: f32,
    clear_px: f32,
    plot: &PxRect,
    taken: &[PxRect],
    points: &[Px],
) -> Option<PxRect> {
    let reach = |away: f32| {
        let beyond = [clear_px + 0.5 * width + ROOM, clear_px + 0.5 * LINE];
        SIDES.map(|[x, y]| {
            [
                at[0] + x * (beyond[0] + away),
                at[1] + y * (beyond[1] + away),
            ]
        })
    };
    let on_it = (clear_px == 0.0).then_some(at);
    let around_it =
        (0..=4 * MAX_LINES).flat_map(|quarters| reach(0.25 * f32::from(quarters) * LINE));
    let mut free = on_it.into_iter().chain(around_it).filter_map(|middle| {
        let place = within(around(middle, width), plot)?;
        let covers = place.contains(at) && clear_px > 0.0;
        let is_free = !covers && taken.iter().all(|other| !overlap(&place, other));
        is_free.then_some(place)
    });
    let is_its_own = |place: &PxRect| {
        let own = distance(at, place);
        points.iter().all(|other| distance(*other, place) >= own)
    };
    free.find(is_its_own)
}

/// The rectangle of a text centered at `at`.
fn around(at: Px, width: f32) -> PxRect {
    PxRect::new(at[0] - 0.5 * width, at[1] - 0.5 * LINE, width, LINE)
}

/// Shifts the rectangle sideways into the plot; `None` if it is too wide, or above or below the plot.
fn within(rect: PxRect, plot: &PxRect) -> Option<PxRect> {
    let fits = rect.width <= plot.width - 2.0 * ROOM
        && rect.top >= plot.top
        && rect.bottom() <= plot.bottom();
    let left = rect.left.clamp(
        plot.left + ROOM,
        (plot.right() - ROOM - rect.width).max(plot.left + ROOM),
    );
    fits.then_some(PxRect { left, ..rect })
}

fn overlap(a: &PxRect, b: &PxRect) -> bool {
    a.left < b.right() + ROOM
        && b.left < a.right() + ROOM
        && a.top < b.bottom()
        && b.top < a.bottom()
}
