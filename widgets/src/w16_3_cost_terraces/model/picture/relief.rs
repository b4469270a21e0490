//! The relief with crosshair, ball, lowest cell and truth.

use widget_kit::scene::{
    Aspect, Axis, ColorBar, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight,
};

use super::{Looked, PictureState, RELIEF, ball, haloed, name};
use crate::w16_3_cost_terraces::model::morph::Morph;
use crate::w16_3_cost_terraces::model::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::{Colors, HALF_SPAN_M, ReliefMeasure};

/// ICP's cost or NDT's negated score, so that a ball descends on both; dark is low. Dropped sweeps fly over ICP's.
pub fn panel(
    terrains: &Terrains,
    rests_m: &[[f64; 2]],
    morph: &Morph,
    moment: PictureState,
) -> Panel {
    let landscape = terrains.of(moment.measure);
    let mut layers = vec![Layer::Raster(morph.raster.clone())];
    layers.extend(cross_hair(moment.probe_m, Stroke::Solid));
    let title = match moment.looked {
        Looked::Pointer(at) => {
            layers.extend(cross_hair(at, Stroke::Dotted));
            format!(
                "Here ICP costs {:.4} m², NDT scores {:.2}",
                terrains.icp.value_near(at),
                -terrains.ndt.value_near(at)
            )
        }
        Looked::CrossHair | Looked::Ball => {
            format!("{}: the darker, the better it fits", name(moment.measure))
        }
    };
    let path = &landscape.ball.path_m;
    let step = moment.step.min(landscape.ball.steps());
    layers.extend(haloed_line(&path[..=step]));
    layers.extend(haloed([0.0, 0.0], Mark::Plus, Tone::Truth, 8.0));
    layers.extend(haloed(landscape.lowest_m, Mark::Dot, Tone::Ink, 3.0));
    layers.push(Layer::Handle {
        at: moment.probe_m,
        tone: Tone::Prior,
        label: "choose where the ball drops",
    });
    let share = moment.step as f64 / landscape.ball.steps().max(1) as f64;
    let [icp, ndt] = [&terrains.icp.ball, &terrains.ndt.ball]
        .map(|ball| ball.at_step((share * ball.steps() as f64).round() as usize));
    layers.extend(ball(morph.between(icp, ndt)));
    layers.push(Layer::label([0.0, 0.0], "truth".to_owned(), 10.0));
    if landscape.lowest_m != [0.0, 0.0] {
        layers.push(Layer::label(landscape.lowest_m, "lowest".to_owned(), 6.0));
    }
    layers.push(Layer::label(moment.probe_m, "drop".to_owned(), 12.0));
    let mut legend = Vec::new();
    if moment.measure == ReliefMeasure::Icp && !rests_m.is_empty() {
        let halo_and_dot = [(Tone::Paper, 3.0), (Tone::Posterior, 1.75)];
        layers.extend(
            halo_and_dot.map(|(tone, radius_px)| {
                Layer::points(rests_m.to_vec(), Mark::Dot, tone, radius_px)
            }),
        );
        legend.push(LegendEntry::mark(
            "dropped sweeps",
            Tone::Posterior,
            Mark::Dot,
        ));
    }
    let bounds = morph.raster.bounds;
    Panel {
        id: RELIEF,
        title,
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::hidden(bounds.min[0], bounds.max[0]),
        y: Axis::hidden(bounds.min[1], bounds.max[1]),
        layers,
        legend,
        color_bar: Some(color_bar(terrains, moment)),
    }
}

fn color_bar(terrains: &Terrains, moment: PictureState) -> ColorBar {
    let [low, high] = terrains.of(moment.measure).range;
    let (label, min, max) = match (moment.colors, moment.measure) {
        (Colors::ByRank, _) => ("% are better", 0.0, 100.0),
        (Colors::ByHeight, ReliefMeasure::Icp) => ("m²", low, high),
        // From the highest score, which is dark, to the lowest.
        (Colors::ByHeight, ReliefMeasure::Ndt) => ("score", -low, -high),
    };
    ColorBar {
        label: label.to_owned(),
        min,
        max,
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
fn haloed_line(points: &[[f64; 2]]) -> [Layer; 2] {
    [(Tone::Paper, 4.0), (Tone::Posterior, 2.0)]
        .map(|(tone, width_px)| Layer::line(points.to_vec(), Stroke::Solid, tone, width_px))
}
