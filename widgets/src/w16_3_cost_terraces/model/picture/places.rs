//! The sweep over its target: ICP's partners, and NDT's Gaussians.

use pr_geom::{math, sort_numbers};
use widget_kit::scene::{
    Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight,
};

use super::{Looked, PictureState};
use crate::w16_3_cost_terraces::model::terrains::{Bell, Pairing, Terrains};

/// Margin around the map's walls, m.
const MARGIN_M: f64 = 0.5;

/// Largest extent of the picture of the pairs along an axis, m; the long corridor is cut off.
pub(super) const MAX_M: f64 = 6.0;

/// Width of the picture of the Gaussians, m; it is a close-up, because they are as thin as the walls.
const CLOSE_M: f64 = 2.5;

/// Share of the points, at either end of an axis, outside of the frame: a beam may leave through a door.
const STRAY_SHARE: f64 = 0.02;

/// The sweep at the current shift with its partners; those that are about to change are highlighted. If the
/// ball is elsewhere, the sweep is drawn there, too.
pub fn pairs(terrains: &Terrains, moment: PictureState) -> Panel {
    let Pairing {
        pairs,
        changing,
        next,
        points,
    } = terrains.pairing_at(moment.looked_m(terrains));
    let segments =
        |segments, stroke, tone, width_px| Layer::segments(segments, stroke, tone, width_px);
    let mut layers = vec![
        segments(pairs, Stroke::Solid, Tone::Ink, 0.75),
        map_points(terrains),
        sweep(terrains, moment),
    ];
    let ball_m = moment.ball_m(terrains);
    if moment.step > 0 && ball_m != moment.looked_m(terrains) {
        let sweep = terrains.sweep_at(ball_m);
        layers.push(Layer::points(sweep, Mark::Square, Tone::Posterior, 2.0));
    }
    layers.extend([
        segments(changing, Stroke::Solid, Tone::Ink, 2.5),
        segments(next, Stroke::Solid, Tone::Series(0), 2.5),
        Layer::points(points, Mark::Triangle, Tone::Series(0), 4.5),
    ]);
    let title = match moment.looked {
        Looked::CrossHair => "Matches at the crosshair",
        Looked::Ball => "Matches at the ball",
        Looked::Pointer(_) => "Matches under the pointer",
    };
    panel(
        "sweep",
        title,
        frame(terrains, MAX_M),
        layers,
        vec![
            LegendEntry::mark("map", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("sweep", Tone::Prior, Mark::Circle),
            LegendEntry::mark("at the ball", Tone::Posterior, Mark::Square),
            LegendEntry::marked_line(
                "changes next",
                Tone::Series(0),
                Mark::Triangle,
                Stroke::Solid,
            ),
        ],
    )
}

/// One Gaussian for each cell: the ellipses of one and two standard deviations.
pub fn bells(terrains: &Terrains, moment: PictureState) -> Panel {
    let bells = terrains.bells();
    let mut layers = vec![
        Layer::segments(
            bells.iter().flat_map(|bell| edges(bell.cell_m)).collect(),
            Stroke::Solid,
            Tone::Faint,
            1.0,
        ),
        sweep(terrains, moment),
    ];
    layers.extend(bells.iter().flat_map(|bell| {
        [(2.0, Stroke::Dotted), (1.0, Stroke::Solid)].map(|(deviations, stroke)| Layer::Ellipse {
            center: bell.mean_m,
            half_axes: bell.half_axes_m.map(|axis| axis.map(|v| deviations * v)),
            stroke,
            tone: Tone::Measurement,
        })
    }));
    let width_m = terrains.ndt_cell_m();
    panel(
        "bells",
        &format!("{} bells, cells {width_m:.2} m", bells.len()),
        close_frame(terrains, &bells),
        layers,
        vec![
            LegendEntry::line("bell, 1 σ", Tone::Measurement, Stroke::Solid),
            LegendEntry::line("2 σ", Tone::Measurement, Stroke::Dotted),
            LegendEntry::line("cell", Tone::Faint, Stroke::Solid),
            LegendEntry::mark("sweep", Tone::Prior, Mark::Circle),
        ],
    )
}

/// The lower left end of the walls; if it has no Gaussian, the same height upwards from the lowest one.
fn close_frame(terrains: &Terrains, bells: &[Bell]) -> Bounds {
    let Bounds { mut min, mut max } = frame(terrains, CLOSE_M);
    let is_across = |bell: &&Bell| (min[0]..max[0]).contains(&bell.mean_m[0]);
    let heights = bells.iter().filter(is_across).map(|bell| bell.mean_m[1]);
    let lowest_m = heights.fold(f64::INFINITY, math::min);
    if lowest_m.is_finite() && lowest_m > max[1] {
        let height_m = max[1] - min[1];
        min[1] = lowest_m - MARGIN_M;
        max[1] = min[1] + height_m;
    }
    Bounds { min, max }
}

pub(super) fn map_points(terrains: &Terrains) -> Layer {
    let points = terrains.map_points_m().to_vec();
    Layer::points(points, Mark::Cross, Tone::Measurement, 2.5)
}

fn sweep(terrains: &Terrains, moment: PictureState) -> Layer {
    let points = terrains.sweep_at(moment.looked_m(terrains));
    match moment.looked {
        Looked::Ball => Layer::points(points, Mark::Square, Tone::Posterior, 2.0),
        Looked::CrossHair | Looked::Pointer(_) => {
            Layer::points(points, Mark::Circle, Tone::Prior, 2.5)
        }
    }
}

fn edges(Bounds { min, max }: Bounds) -> [[[f64; 2]; 2]; 4] {
    let corners = [min, [max[0], min[1]], max, [min[0], max[1]]];
    [0, 1, 2, 3].map(|k: usize| [corners[k], corners[(k + 1) % 4]])
}

pub(super) fn panel(
    id: &'static str,
    title: &str,
    frame: Bounds,
    layers: Vec<Layer>,
    legend: Vec<LegendEntry>,
) -> Panel {
    Panel {
        id,
        title: title.to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(frame.min[0], frame.max[0]),
        y: Axis::hidden(frame.min[1], frame.max[1]),
        layers,
        legend,
        color_bar: None,
    }
}

/// The walls of the map, at most `most_m` of them along each axis: along x from the left or, if there is no
/// left end, about the sensor; along y from below.
pub(super) fn frame(terrains: &Terrains, most_m: f64) -> Bounds {
    let [(left, right), (low, high)] = [0, 1].map(|axis| walls(terrains.map_points_m(), axis));
    let sensor_x = terrains.scene().world_from_sensor().x();
    let left = if right - left > MAX_M {
        sensor_x - 0.5 * most_m
    } else {
        left
    };
    Bounds {
        min: [left, low],
        max: [right.min(left + most_m), high.min(low + most_m)],
    }
}

/// Extent of the points along an axis without the strays, with the margin, m.
fn walls(points: &[[f64; 2]], axis: usize) -> (f64, f64) {
    let mut sorted: Vec<f64> = points.iter().map(|at| at[axis]).collect();
    sort_numbers(&mut sorted);
    let stray = (STRAY_SHARE * sorted.len() as f64) as usize;
    let end = |index: Option<usize>| index.and_then(|k| sorted.get(k)).copied().unwrap_or(0.0);
    let (first, last) = (end(Some(stray)), end(sorted.len().checked_sub(stray + 1)));
    (first - MARGIN_M, last + MARGIN_M)
}
