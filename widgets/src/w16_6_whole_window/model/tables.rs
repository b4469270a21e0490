//! The tables: the headings of the room and both results beside the picture, the search for the export.

use widget_kit::model::Table;
use widget_kit::ticks::signed;

use super::WholeWindow;
use super::search_task::TURNS;
use super::texts::heading_error_deg;

/// The tables beside the picture.
pub fn shown(window: &WholeWindow) -> Vec<Table> {
    vec![turns(window), answers(window)]
}

/// All tables, the shown ones first.
pub fn all(window: &WholeWindow) -> Vec<Table> {
    let mut tables = shown(window);
    tables.push(boxes(window));
    tables
}

/// The best pose, and the best ones at the other headings of the room.
fn turns(window: &WholeWindow) -> Table {
    let found = window.search_task.found.as_ref();
    let best = found.and_then(|found| found.home.as_ref().map(|(best, _)| *best));
    let rivals = TURNS.iter().enumerate().filter_map(|(k, (name, _))| {
        let rival = found?.rivals[k]?;
        Some((*name, rival))
    });
    let rows = best
        .map(|best| ("best pose", best))
        .into_iter()
        .chain(rivals)
        .map(|(name, scored)| {
            let behind = best.map_or(0.0, |best| best.score - scored.score);
            let turned = heading_error_deg(window, scored.pose.theta());
            vec![
                name.to_owned(),
                format!("{:.3}", scored.score),
                format!("{behind:.3}"),
                signed(turned, 1),
            ]
        });
    Table::shown(
        "turns",
        "The room's rotations",
        &["best pose at", "score", "behind", "off (°)"],
        rows.collect(),
    )
}

/// ICP alone, and ICP from the result of the search.
fn answers(window: &WholeWindow) -> Table {
    let alone = Some(("ICP alone", &window.search_task.alone));
    let searched = window
        .refined()
        .map(|refined| ("search, then ICP", refined));
    let rows = alone.into_iter().chain(searched).map(|(name, refined)| {
        let end = &refined.outcome;
        vec![
            name.to_owned(),
            end.ending.name().to_owned(),
            format!("{:.3}", end.error_m),
            signed(end.error_deg, 1),
            end.iterations.to_string(),
        ]
    });
    Table::shown(
        "answers",
        "Both answers from this start",
        &["who", "ends in", "off (m)", "off (°)", "steps of ICP"],
        rows.collect(),
    )
}

/// Every expanded box.
fn boxes(window: &WholeWindow) -> Table {
    let head = [
        "step",
        "low x (m)",
        "high x (m)",
        "low y (m)",
        "high y (m)",
        "low heading (rad)",
        "high heading (rad)",
        "bound",
        "became",
    ];
    let seen = window.search_task.window.boxes();
    let taken = window.search_task.window.moments().iter().enumerate();
    let rows = taken.filter_map(|(step, moment)| {
        let seen = &seen[moment.taken?];
        let poses = &seen.poses;
        let ends = poses.x_m.iter().chain(&poses.y_m).chain(&poses.heading_rad);
        let mut row = vec![step.to_string()];
        row.extend(ends.map(ToString::to_string));
        row.push(poses.bound.to_string());
        row.push(
            seen.fate
                .map_or_else(String::new, |fate| format!("{fate:?}")),
        );
        Some(row)
    });
    Table::exported("boxes", "Every box expanded", &head, rows.collect())
}
