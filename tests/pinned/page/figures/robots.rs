//! Results of recorded logs, from `docs/robots.md`: the logs are not part of the project, so a command writes
//! that page and this module reads it.

use crate::page::document::source;

/// The number in a table's cell, by the row's first cell and the column's head; `_` stands for a space.
pub fn value(row: &str, column: &str) -> Option<f64> {
    let plain = |cell: &str| cell.trim().trim_matches('`').to_owned();
    let (row, column) = (row.replace('_', " "), column.replace('_', " "));
    let page = source("docs/robots.md");
    let mut at = None;
    for line in page.lines() {
        let cells: Vec<String> = line.split('|').map(plain).collect();
        if cells.len() < 3 {
            at = None;
            continue;
        }
        at = at.or_else(|| cells.iter().position(|cell| *cell == column));
        if let Some(cell) = at.and_then(|at| cells.get(at))
            && cells[1] == row
        {
            return cell.split(' ').next()?.parse().ok();
        }
    }
    None
}
