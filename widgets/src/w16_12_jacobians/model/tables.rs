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
    let steps = runs.flat_map(|(run, name)| {
        let iterates = run.iterates.iter().enumerate();
        iterates.map(move |(step, iterate)| (name, step, iterate))
    });
    Table::of_items(
        "steps",
        "Every step",
        steps,
        &[
            ("solver", &|(name, ..)| (*name).into()),
            ("step", &|(_, step, _)| (*step).into()),
            ("off (m)", &|(.., iterate)| iterate.off_m.into()),
            ("χ²", &|(.., iterate)| iterate.chi2.into()),
        ],
    )
}
