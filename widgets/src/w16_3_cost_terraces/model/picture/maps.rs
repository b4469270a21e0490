//! The two landscapes with cross hair, ball, lowest cell and truth.

use widget_kit::scene::{
    Aspect, Axis, ColorBar, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight,
};

use super::{Looked, Moment, ball, haloed};
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
    let bounds = landscape.raster.bounds;
    let step = moment.step.min(landscape.ball.path_m.len() - 1);
    layers.extend(haloed_line(&landscape.ball.path_m[..=step], Stroke::Solid));
    layers.extend(haloed([0.0, 0.0], Mark::Plus, Tone::Truth, 8.0));
    layers.extend(haloed(landscape.lowest_m, Mark::Dot, Tone::Ink, 3.0));
    layers.push(Layer::Handle {
        at: moment.probe_m,
        tone: Tone::Prior,
        label: "choose where the balls drop",
    });
    layers.extend(ball(landscape.ball.path_m[step]));
    layers.push(Layer::label([0.0, 0.0], "truth".to_owned(), 10.0));
    if landscape.lowest_m != [0.0, 0.0] {
        layers.push(Layer::label(landscape.lowest_m, "lowest".to_owned(), 6.0));
    }
    layers.push(Layer::label(moment.probe_m, "drop".to_owned(), 12.0));
    Panel {
        id,
        title,
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(bounds.min[0], bounds.max[0]),
        y: Axis::hidden(bounds.min[1], bounds.max[1]),
        layers,
        legend: Vec::new(),
        color_bar: Some(match moment.colors {
            Colors::ByHeight => ColorBar {
                label: bar_label.to_owned(),
                min: landscape.range[0],
                max: landscape.range[1],
            },
            Colors::ByRank => ColorBar {
                label: "% fit better".to_owned(),
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

/// A posterior line on a band of paper.
fn haloed_line(points: &[[f64; 2]], stroke: Stroke) -> [Layer; 2] {
    [
        (Tone::Paper, Stroke::Solid, 4.0),
        (Tone::Posterior, stroke, 2.0),
    ]
    .map(|(tone, stroke, width_px)| Layer::line(points.to_vec(), stroke, tone, width_px))
}
