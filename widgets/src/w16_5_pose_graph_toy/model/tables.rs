//! The tables: every spring beside the picture, and the steps for the export.

use widget_kit::model::Table;

use super::PoseGraphToy;
use super::texts::{ends, kind};

/// All tables, the shown ones first.
pub fn all(toy: &PoseGraphToy) -> Vec<Table> {
    vec![springs(toy), steps(toy)]
}

fn springs(toy: &PoseGraphToy) -> Table {
    let shown = toy.shown();
    let rows = toy
        .course
        .edges
        .iter()
        .zip(&shown.edge_chi2)
        .map(|(view, chi2)| {
            let poses = &shown.poses;
            let now = poses[view.from.index()].between(&poses[view.to.index()]);
            vec![
                ends(view),
                kind(view).to_owned(),
                format!("{:.2}", view.edge.measurement.x()),
                format!("{:.2}", now.x()),
                format!("{:.1}", view.edge.information[(0, 0)]),
                format!("{chi2:.3}"),
            ]
        });
    Table::shown(
        "springs",
        "The springs",
        &[
            "spring",
            "kind",
            "measured ahead (m)",
            "now (m)",
            "stiffness",
            "χ²",
        ],
        rows.collect(),
    )
}

fn steps(toy: &PoseGraphToy) -> Table {
    let rows = toy
        .course
        .moments
        .iter()
        .enumerate()
        .flat_map(|(step, moment)| {
            moment.poses.iter().enumerate().map(move |(k, pose)| {
                vec![
                    step.to_string(),
                    moment.chi2.to_string(),
                    (k + 1).to_string(),
                    pose.x().to_string(),
                    pose.y().to_string(),
                    pose.theta().to_string(),
                ]
            })
        });
    Table::exported(
        "steps",
        "Every pose after every step",
        &["step", "χ²", "pose", "x (m)", "y (m)", "heading (rad)"],
        rows.collect(),
    )
}
