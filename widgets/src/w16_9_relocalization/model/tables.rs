//! The tables: each scan of the run, for the export.

use widget_kit::model::Table;

use super::Relocalization;

/// All tables.
pub fn all(back: &Relocalization) -> Vec<Table> {
    let rows = back.finished().into_iter().flat_map(|(_, run)| {
        let reports = run.reports().iter().enumerate();
        reports.map(|(tick, report)| {
            let number = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
            let best = report.search.map(|found| found.best.score);
            let next = report.runner_up().map(|found| found.score);
            vec![
                tick.to_string(),
                report.verdict.name().to_owned(),
                number(report.score),
                number(best),
                number(next),
                number(run.error_m(tick)),
            ]
        })
    });
    let head = [
        "scan",
        "verdict",
        "share that fits",
        "best place's score",
        "next place's score",
        "position error (m)",
    ];
    vec![Table::exported(
        "scans",
        "Every scan of the run",
        &head,
        rows.collect(),
    )]
}
