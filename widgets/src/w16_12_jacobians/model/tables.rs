//! The tables: the four results beside the picture, every step for the export.

use widget_kit::model::Table;
use widget_kit::plural::plural;

use super::{NAMES, WrongJacobians};

/// All tables, the shown one first.
pub fn all(widget: &WrongJacobians) -> Vec<Table> {
    vec![ends(widget), every_step(widget)]
}

fn ends(widget: &WrongJacobians) -> Table {
    let rows = NAMES.iter().enumerate().map(|(solver, name)| {
        let shown = widget.shown(solver);
        vec![
            (*name).to_owned(),
            widget.steps_of(solver).to_string(),
            format!("{:.4}", shown.off_m),
            format!("{:.2}", shown.chi2),
        ]
    });
    Table::shown(
        "ends",
        format!("The four after {}", plural(widget.step(), "step")),
        &["solver", "steps", "off (m)", "χ²"],
        rows.collect(),
    )
}

fn every_step(widget: &WrongJacobians) -> Table {
    let runs = widget.solved.runs.iter().zip(NAMES);
    let rows = runs.flat_map(|(run, name)| {
        run.iterates.iter().enumerate().map(move |(step, iterate)| {
            vec![
                name.to_owned(),
                step.to_string(),
                iterate.off_m.to_string(),
                iterate.chi2.to_string(),
            ]
        })
    });
    Table::exported(
        "steps",
        "Every step",
        &["solver", "step", "off (m)", "χ²"],
        rows.collect(),
    )
}
