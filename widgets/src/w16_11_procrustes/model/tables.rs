//! The tables: the best matrix of each kind beside the picture, the curves for the export.

use ch16_lab::procrustes::Handedness;
use widget_kit::model::Table;

use super::ProcrustesTrace;
use super::texts::plural;
use crate::w16_11_procrustes::spec::WHOLE_TURN_DEG;

/// All tables, the shown one first.
pub fn all(trace: &ProcrustesTrace) -> Vec<Table> {
    vec![matrices(trace), points(trace), curves(trace)]
}

/// The best matrix of each kind.
pub fn matrices(trace: &ProcrustesTrace) -> Table {
    let problem = &trace.problem;
    let rows = Handedness::ALL.map(|kind| {
        let best = problem.best(kind);
        let determinant = match kind {
            Handedness::Turn => "+1",
            Handedness::Mirror => "−1",
        };
        vec![
            plural(kind).to_owned(),
            determinant.to_owned(),
            format!("{:.1}", best.theta_rad.to_degrees()),
            format!("{:.3}", best.trace_m2),
            format!("{:.4}", problem.cost_m2(kind, best.theta_rad)),
        ]
    });
    Table::shown(
        "matrices",
        "The best of each kind",
        &["kind", "det", "angle (°)", "trace (m²)", "cost (m²)"],
        rows.to_vec(),
    )
}

fn points(trace: &ProcrustesTrace) -> Table {
    let pairs = trace.pairs.source.iter().zip(&trace.pairs.target);
    let rows = pairs.enumerate().map(|(k, (p, q))| {
        let cells = [p.x, p.y, q.x, q.y].map(|value| value.to_string());
        let mut row = vec![(k + 1).to_string()];
        row.extend(cells);
        row
    });
    Table::exported(
        "pairs",
        "The pairs",
        &[
            "pair",
            "source x (m)",
            "source y (m)",
            "target x (m)",
            "target y (m)",
        ],
        rows.collect(),
    )
}

fn curves(trace: &ProcrustesTrace) -> Table {
    let rows = (0..=WHOLE_TURN_DEG as u32).map(|degrees| {
        let theta_rad = f64::from(degrees).to_radians();
        let of = |kind| trace.problem.trace_m2(kind, theta_rad).to_string();
        vec![
            degrees.to_string(),
            of(Handedness::Turn),
            of(Handedness::Mirror),
        ]
    });
    Table::exported(
        "trace",
        "The trace over the angle",
        &["angle (°)", "rotations (m²)", "mirror images (m²)"],
        rows.collect(),
    )
}
