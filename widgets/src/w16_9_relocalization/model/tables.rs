//! The tables: each scan of the run, for the export.

use widget_kit::model::Table;

use super::Relocalization;

/// All tables.
pub fn all(back: &Relocalization) -> Vec<Table> {
    let scans = back.finished().into_iter().flat_map(|(_, run)| {
        let reports = run.reports().iter().enumerate();
        reports.map(move |(tick, report)| (run, tick, report))
    });
    vec![Table::of_items(
        "scans",
        "Every scan of the run",
        scans,
        &[
            ("scan", &|(_, tick, _)| (*tick).into()),
            ("verdict", &|(.., report)| report.verdict.name().into()),
            ("share that fits", &|(.., report)| report.score.into()),
            ("best place's score", &|(.., report)| {
                report.search.map(|found| found.best.score).into()
            }),
            ("next place's score", &|(.., report)| {
                report.runner_up().map(|found| found.score).into()
            }),
            ("position error (m)", &|(run, tick, _)| {
                run.error_m(*tick).into()
            }),
        ],
    )]
}
