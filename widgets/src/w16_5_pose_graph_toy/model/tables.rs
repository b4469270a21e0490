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
    let steps = toy.course.moments.iter().enumerate();
    let poses = steps.flat_map(|(step, state)| {
        let poses = state.poses.iter().enumerate();
        poses.map(move |(k, pose)| (step, state.chi2, k, pose))
    });
    Table::of_items(
        "steps",
        "Every pose after every step",
        poses,
        &[
            ("step", &|(step, ..)| (*step).into()),
            ("χ²", &|(_, chi2, ..)| (*chi2).into()),
            ("pose", &|(.., k, _)| (k + 1).into()),
            ("x (m)", &|(.., pose)| pose.x().into()),
            ("y (m)", &|(.., pose)| pose.y().into()),
            ("heading (rad)", &|(.., pose)| pose.theta().into()),
        ],
    )
}
