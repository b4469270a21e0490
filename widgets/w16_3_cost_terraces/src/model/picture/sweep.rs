//! The sweep on the map: what the shift under the cross hair means.

use kit::scene::{Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::Moment;
use crate::model::terrains::Terrains;

/// Room around the map's points, m.
const MARGIN_M: f64 = 0.7;

/// Map points, the sweep where it was dropped, its pairs, and the sweep where ICP's ball is.
pub fn panel(terrains: &Terrains, moment: Moment) -> Panel {
    let frame = frame(terrains.map_points_m());
    let step = moment.step.min(terrains.icp.ball.path_m.len() - 1);
    let mut layers = vec![
        Layer::Segments {
            segments: terrains.pairs_at(moment.probe_m),
            stroke: Stroke::Solid,
            tone: Tone::Ink,
            width_px: 0.75,
        },
        Layer::points(
            terrains.map_points_m().to_vec(),
            Mark::Cross,
            Tone::Measurement,
            3.0,
        ),
        Layer::points(
            terrains.sweep_at(moment.probe_m),
            Mark::Circle,
            Tone::Prior,
            2.5,
        ),
    ];
    if step > 0 {
        layers.push(Layer::points(
            terrains.sweep_at(terrains.icp.ball.path_m[step]),
            Mark::Square,
            Tone::Posterior,
            2.0,
        ));
    }
    Panel {
        id: "sweep",
        title: "The sweep on the map".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Equal,
        x: Axis::new("x (m)", frame.min[0], frame.max[0]),
        y: Axis::new("y (m)", frame.min[1], frame.max[1]),
        layers,
        legend: vec![
            LegendEntry::mark("map", Tone::Measurement, Mark::Cross),
            LegendEntry::mark("sweep at the drop", Tone::Prior, Mark::Circle),
            LegendEntry::mark("sweep at ICP's ball", Tone::Posterior, Mark::Square),
            LegendEntry::line("pairs", Tone::Ink, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn frame(points: &[[f64; 2]]) -> Bounds {
    let fold = |start: f64, pick: fn(f64, f64) -> f64, axis: usize| {
        points.iter().map(|at| at[axis]).fold(start, pick)
    };
    let low = |axis| fold(f64::INFINITY, f64::min, axis) - MARGIN_M;
    let high = |axis| fold(f64::NEG_INFINITY, f64::max, axis) + MARGIN_M;
    Bounds {
        min: [low(0), low(1)],
        max: [high(0), high(1)],
    }
}
