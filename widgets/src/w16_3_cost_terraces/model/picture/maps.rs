//! The two landscapes with cross hair, ball, lowest cell and truth.

use kit::scene::{Aspect, ColorBar, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::{Looked, Moment, shift_axis};
use crate::w16_3_cost_terraces::model::landscape::Landscape;
use crate::w16_3_cost_terraces::spec::Colors;
use crate::w16_3_cost_terraces::spec::HALF_SPAN_M;

/// ICP's cost; dark is low. The dropped sweeps are animated over it.
pub fn icp(landscape: &Landscape, moment: Moment, rests_m: &[[f64; 2]]) -> Panel {
    let title = |height: f64| format!("ICP cost {height:.4} m²");
    let mut panel = map("icp", &title, "m²", landscape, moment);
    if !rests_m.is_empty() {
        let halo_and_dot = [(Tone::Paper, 3.0), (Tone::Posterior, 1.75)];
        panel.layers.extend(
            halo_and_dot.map(|(tone, radius_px)| {
                Layer::points(rests_m.to_vec(), Mark::Dot, tone, radius_px)
            }),
        );
        let entry = LegendEntry::mark("dropped sweeps", Tone::Posterior, Mark::Dot);
        panel.legend.push(entry);
    }
    panel
}

/// NDT's negated score, so that both balls descend; dark is low.
pub fn ndt(landscape: &Landscape, moment: Moment) -> Panel {
    let title = |height: f64| format!("NDT score {:.4}", -height);
    let mut panel = map("ndt", &title, "score", landscape, moment);
    if let (Some(bar), Colors::ByHeight) = (&mut panel.color_bar, moment.colors) {
        // From the highest score, which is dark, to the lowest.
        (bar.min, bar.max) = (-bar.min, -bar.max);
    }
    // One legend for both maps, below the first.
    panel.legend.clear();
    panel
}

/// `title` describes the height at the cross hair.
fn map(
    id: &'static str,
    title: &dyn Fn(f64) -> String,
    bar_label: &str,
    landscape: &Landscape,
    moment: Moment,
) -> Panel {
    let mut layers = vec![Layer::Raster(landscape.raster.clone())];
    layers.extend(cross_hair(moment.probe_m, Stroke::Solid));
    let title = match moment.looked {
        Looked::Pointer(at) => {
            layers.extend(cross_hair(at, Stroke::Dotted));
            format!("{} under the pointer", title(landscape.value_near(at)))
        }
        Looked::CrossHair | Looked::Ball => {
            format!("{} at the cross hair", title(landscape.at_probe()))
        }
    };
    layers.extend(haloed_line(&landscape.ball.path_m, Stroke::Dotted));
    let step = moment.step.min(landscape.ball.path_m.len() - 1);
    layers.extend(haloed_line(&landscape.ball.path_m[..=step], Stroke::Solid));
    layers.extend(haloed([0.0, 0.0], Mark::Plus, Tone::Truth, 8.0));
    layers.extend(haloed(landscape.lowest_m, Mark::Dot, Tone::Ink, 3.0));
    layers.push(Layer::Handle {
        at: moment.probe_m,
        tone: Tone::Prior,
        label: "choose where the balls drop",
    });
    layers.extend(haloed(
        landscape.ball.path_m[step],
        Mark::Square,
        Tone::Posterior,
        6.0,
    ));
    Panel {
        id,
        title,
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: shift_axis("Δx (m)"),
        y: shift_axis("Δy (m)"),
        layers,
        legend: vec![
            LegendEntry::mark("drop", Tone::Prior, Mark::Circle),
            LegendEntry::mark("ball", Tone::Posterior, Mark::Square),
            LegendEntry::line("its path", Tone::Posterior, Stroke::Dotted),
            LegendEntry::mark("lowest cell", Tone::Ink, Mark::Dot),
            LegendEntry::mark("truth", Tone::Truth, Mark::Plus),
        ],
        color_bar: Some(match moment.colors {
            Colors::ByHeight => ColorBar {
                label: bar_label.to_owned(),
                min: landscape.range[0],
                max: landscape.range[1],
            },
            Colors::ByRank => ColorBar {
                label: "% of cells are lower".to_owned(),
                min: 0.0,
                max: 100.0,
            },
        }),
    }
}

/// Ink on a band of paper, visible on dark and bright cells.
fn cross_hair([x, y]: [f64; 2], stroke: Stroke) -> [Layer; 2] {
    let segments = vec![
        [[-HALF_SPAN_M, y], [HALF_SPAN_M, y]],
        [[x, -HALF_SPAN_M], [x, HALF_SPAN_M]],
    ];
    [(Tone::Paper, Stroke::Solid, 3.0), (Tone::Ink, stroke, 1.0)]
        .map(|(tone, stroke, width_px)| Layer::segments(segments.clone(), stroke, tone, width_px))
}

/// A mark on a slightly larger one of paper.
fn haloed(at: [f64; 2], mark: Mark, tone: Tone, radius_px: f32) -> [Layer; 2] {
    let halo = if mark == Mark::Plus { Mark::Dot } else { mark };
    [
        (Tone::Paper, halo, radius_px + 2.0),
        (tone, mark, radius_px),
    ]
    .map(|(tone, mark, radius_px)| Layer::points(vec![at], mark, tone, radius_px))
}

/// A posterior line on a band of paper.
fn haloed_line(points: &[[f64; 2]], stroke: Stroke) -> [Layer; 2] {
    [
        (Tone::Paper, Stroke::Solid, 4.0),
        (Tone::Posterior, stroke, 2.0),
    ]
    .map(|(tone, stroke, width_px)| Layer::line(points.to_vec(), stroke, tone, width_px))
}
