//! The slices through the cross hair, and the information at the truth.

use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use kit::ticks::signed;
use pr_geom::math;

use super::{Moment, shift_axis};
use crate::model::terrains::Terrains;

/// A vertical axis never spans less than this, in m² or in score: flat ground looks flat.
const LEAST_SPAN: f64 = 1e-3;

/// Which landscape is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// ICP's cost.
    Icp,
    /// NDT's score, the right way up.
    Ndt,
}

/// Direction of a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// East, in the row of samples nearest to the cross hair.
    X,
    /// North, in the column of samples nearest to the cross hair.
    Y,
}

/// One landscape along the line of samples nearest to the cross hair; the title says which line.
pub fn slice(terrains: &Terrains, moment: Moment, measure: Measure, along: Along) -> Panel {
    let (landscape, sign, name) = match measure {
        Measure::Icp => (&terrains.icp, 1.0, "ICP cost (m²)"),
        Measure::Ndt => (&terrains.ndt, -1.0, "NDT score"),
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
    let low = curve
        .iter()
        .map(|[_, value]| *value)
        .fold(f64::INFINITY, f64::min);
    let high = curve.iter().map(|[_, value]| *value).fold(low, f64::max);
    let high = high.max(low + LEAST_SPAN);
    let margin = 0.05 * (high - low);
    let (min, max) = (low - margin, high + margin);
    let upright = |at: f64, stroke, tone| Layer::Segments {
        segments: vec![[[at, min], [at, max]]],
        stroke,
        tone,
        width_px: 1.5,
    };
    Panel {
        id: match (measure, along) {
            (Measure::Icp, Along::X) => "icp-x",
            (Measure::Icp, Along::Y) => "icp-y",
            (Measure::Ndt, Along::X) => "ndt-x",
            (Measure::Ndt, Along::Y) => "ndt-y",
        },
        title,
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: shift_axis(label),
        y: Axis::new(name, min, max),
        layers: vec![
            upright(0.0, Stroke::Dashed, Tone::Truth),
            upright(here, Stroke::Dotted, Tone::Prior),
            Layer::Line {
                points: curve,
                stroke: Stroke::Solid,
                tone: Tone::Ink,
                width_px: 2.0,
            },
        ],
        legend: vec![
            LegendEntry::line("truth", Tone::Truth, Stroke::Dashed),
            LegendEntry::line("cross hair", Tone::Prior, Stroke::Dotted),
        ],
        color_bar: None,
    }
}

/// What is known of a shift at the truth: the ellipse of the shifts that lie one standard deviation
/// off, long where the walls say little.
pub fn information(terrains: &Terrains) -> Panel {
    let half_axes = terrains.information.half_axes_cm;
    let longest = half_axes
        .map(|[x, y]| math::norm2(x, y))
        .into_iter()
        .fold(0.0, f64::max);
    let axis = |label| Axis::new(label, -1.15 * longest, 1.15 * longest);
    Panel {
        id: "information",
        title: "Information at the truth".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Equal,
        x: axis("Δx (cm)"),
        y: axis("Δy (cm)"),
        layers: vec![
            Layer::Segments {
                segments: half_axes.map(|[x, y]| [[-x, -y], [x, y]]).to_vec(),
                stroke: Stroke::Dotted,
                tone: Tone::Posterior,
                width_px: 1.5,
            },
            Layer::Ellipse {
                center: [0.0, 0.0],
                half_axes,
                stroke: Stroke::Solid,
                tone: Tone::Posterior,
            },
            Layer::points(vec![[0.0, 0.0]], Mark::Plus, Tone::Truth, 6.0),
        ],
        legend: vec![
            LegendEntry::line(
                "one σ, if pairs were independent",
                Tone::Posterior,
                Stroke::Solid,
            ),
            LegendEntry::mark("truth", Tone::Truth, Mark::Plus),
        ],
        color_bar: None,
    }
}
