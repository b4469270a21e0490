//! The rows of the point-to-plane step, and the motion that none of them constrains.

use widget_kit::scene::{Layer, LegendEntry, Mark, Panel, Stroke, Tone};

use super::places::{MAX_M, frame, map_points, panel as place};
use crate::w16_3_cost_terraces::model::terrains::Terrains;
use crate::w16_3_cost_terraces::model::texts::row_in_words;

/// Length of a normal, and of the arrow, m.
const NORMAL_M: f64 = 0.3;
const ARROW_M: f64 = 1.5;

/// The head of the arrow, m, along and across.
const HEAD_M: [f64; 2] = [0.25, 0.12];

/// A normal for every row so far, the last one highlighted, and the null direction as an arrow; if every
/// direction is constrained, a bar of one standard deviation on either side along x.
pub fn panel(terrains: &Terrains) -> Panel {
    let constraints = terrains.row_constraints();
    let taken = &terrains.rows.rows[..terrains.rows_taken()];
    let center: [f64; 2] = terrains.rows.centroid.into();
    let normals: Vec<_> = taken
        .iter()
        .map(|row| [row.point.into(), (row.point + row.normal * NORMAL_M).into()])
        .collect();
    let lines = |segments, tone, width_px| Layer::segments(segments, Stroke::Solid, tone, width_px);
    let last: Vec<_> = normals.last().copied().into_iter().collect();
    let ends = last.iter().map(|[from, _]| *from).collect();
    let null = constraints.null.map(|null| arrow(center, [null.x, null.y]));
    let known = constraints.along_m.map(|along_m| {
        let [x, y] = center;
        vec![[[x - along_m, y], [x + along_m, y]]]
    });
    let layers = vec![
        map_points(terrains),
        lines(normals, Tone::Ink, 1.0),
        lines(last, Tone::Series(0), 2.5),
        Layer::points(ends, Mark::Triangle, Tone::Series(0), 4.5),
        lines(null.unwrap_or_default(), Tone::Series(1), 3.0),
        lines(known.unwrap_or_default(), Tone::Posterior, 4.0),
        Layer::points(vec![center], Mark::Plus, Tone::Ink, 5.0),
    ];
    place(
        "rows",
        &row_in_words(terrains),
        frame(terrains, MAX_M),
        layers,
        vec![
            LegendEntry::line("normals", Tone::Ink, Stroke::Solid),
            LegendEntry::marked_line("last row", Tone::Series(0), Mark::Triangle, Stroke::Solid),
            LegendEntry::line("unconstrained", Tone::Series(1), Stroke::Solid),
            LegendEntry::line("± 1 σ along x", Tone::Posterior, Stroke::Solid),
        ],
    )
}

/// A line with a head, along a direction; empty for a motion without shift.
fn arrow([x, y]: [f64; 2], [vx, vy]: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let length = pr_geom::math::norm2(vx, vy);
    if length < 1e-9 {
        return Vec::new();
    }
    let [ux, uy] = [vx / length, vy / length];
    let at = |along: f64, across: f64| [x + along * ux - across * uy, y + along * uy + across * ux];
    let [head_m, half_m] = HEAD_M;
    let tip = at(ARROW_M, 0.0);
    vec![
        [[x, y], tip],
        [at(ARROW_M - head_m, half_m), tip],
        [at(ARROW_M - head_m, -half_m), tip],
    ]
}
