//! The slices through the crosshair, and the information at the truth over the results of many sweeps.

use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::{PictureState, shift_axis};
use crate::w16_3_cost_terraces::model::rests::Rests;
use crate::w16_3_cost_terraces::model::terrains::Terrains;
use crate::w16_3_cost_terraces::spec::ReliefMeasure;
use widget_kit::ticks::signed;

/// Smallest range of a vertical axis, in m² or in score, so that flat ground looks flat.
const MIN_SPAN: f64 = 1e-3;

/// Half width of the picture of the results, cm, the same for every location, so that the dot of the room is
/// not drawn as large as the needle of the corridor.
const RESTS_SPAN_CM: f64 = 4.0;

/// Size of the second ellipse, in standard deviations.
const MANY_DEVIATIONS: f64 = 3.0;

/// Direction of a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// East, in the row of samples nearest to the crosshair.
    X,
    /// North, in the column of samples nearest to the crosshair.
    Y,
}

/// One landscape along the line of samples nearest to the crosshair; the title says which line.
pub fn slice(terrains: &Terrains, moment: PictureState, along: Along) -> Panel {
    let landscape = terrains.of(moment.measure);
    let (sign, name) = match moment.measure {
        ReliefMeasure::Icp => (1.0, "ICP cost (m²)"),
        ReliefMeasure::Ndt => (-1.0, "NDT score"),
    };
    let [x, y] = moment.probe_m;
    let (title, label, here, heights) = match along {
        Along::X => {
            let title = format!("Along x at Δy = {} m", signed(landscape.sample_near(y), 3));
            (title, "Δx (m)", x, landscape.row(y))
        }
        Along::Y => {
            let title = format!("Along y at Δx = {} m", signed(landscape.sample_near(x), 3));
            (title, "Δy (m)", y, landscape.column(x))
        }
    };
    let curve: Vec<_> = heights
        .iter()
        .map(|[at, height]| [*at, sign * height])
        .collect();
    // Both slices of a landscape share the axis of the whole, so that a flat one looks flat.
    let [low, high] = landscape.range.map(|height| sign * height);
    let (low, high) = (low.min(high), low.max(high).max(MIN_SPAN));
    let margin = 0.05 * (high - low);
    let (min, max) = (low - margin, high + margin);
    let upright =
        |at: f64, stroke, tone| Layer::segments(vec![[[at, min], [at, max]]], stroke, tone, 1.5);
    Panel {
        id: match along {
            Along::X => "slice-x",
            Along::Y => "slice-y",
        },
        title,
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: shift_axis(label),
        y: Axis::new(name, min, max),
        layers: vec![
            upright(0.0, Stroke::Dashed, Tone::Truth),
            upright(here, Stroke::Dotted, Tone::Prior),
            Layer::line(curve, Stroke::Solid, Tone::Ink, 2.0),
        ],
        legend: vec![
            LegendEntry::line("truth", Tone::Truth, Stroke::Dashed),
            LegendEntry::line("crosshair", Tone::Prior, Stroke::Dotted),
        ],
        color_bar: None,
    }
}

/// The information about a shift at the truth, and the results of many sweeps: the ellipse of the shifts one
/// standard deviation away, which is long in a weakly constrained direction. The scale is the same for every
/// location.
pub fn information(terrains: &Terrains, rests: &Rests) -> Panel {
    let half_axes = terrains.information.half_axes_cm;
    let axis = |label| Axis::new(label, -RESTS_SPAN_CM, RESTS_SPAN_CM);
    let ellipse = |deviations: f64, stroke| Layer::Ellipse {
        center: [0.0, 0.0],
        half_axes: half_axes.map(|axis| axis.map(|v| deviations * v)),
        stroke,
        tone: Tone::Ink,
    };
    let rests_cm: Vec<_> = rests
        .now_m()
        .iter()
        .map(|at| at.map(|m| 100.0 * m))
        .collect();
    let title = match rests_cm.len() {
        0 => "Information at the truth".to_owned(),
        count => format!("Where {count} sweeps rest"),
    };
    Panel {
        id: "information",
        title,
        weight: Weight::Side,
        aspect: Aspect::Equal,
        x: axis("Δx (cm)"),
        y: axis("Δy (cm)"),
        layers: vec![
            Layer::points(rests_cm, Mark::Dot, Tone::Posterior, 2.0),
            ellipse(MANY_DEVIATIONS, Stroke::Dotted),
            ellipse(1.0, Stroke::Solid),
            Layer::points(vec![[0.0, 0.0]], Mark::Plus, Tone::Truth, 6.0),
        ],
        legend: vec![
            LegendEntry::mark("rests", Tone::Posterior, Mark::Dot),
            LegendEntry::line("information, 1 σ", Tone::Ink, Stroke::Solid),
            LegendEntry::line("3 σ", Tone::Ink, Stroke::Dotted),
            LegendEntry::mark("truth", Tone::Truth, Mark::Plus),
        ],
        color_bar: None,
    }
}
