//! The tables: the event log, and the data of every plot.

use kit::model::{Table, TablePlace};

use super::ControlRoom;
use super::log::Event;
use super::picture::lanes;

/// Events that the table beside the picture shows.
const SHOWN_EVENTS: usize = 8;

/// The tables beside the picture.
pub fn shown(room: &ControlRoom) -> Vec<Table> {
    vec![this_tick(room), newest_events(&room.events, room.tick())]
}

/// All tables, the shown ones first.
pub fn all(room: &ControlRoom) -> Vec<Table> {
    let mut tables = shown(room);
    tables.extend([full_log(&room.events), over_time(room)]);
    tables
}

/// What every lane did in the tick shown.
fn this_tick(room: &ControlRoom) -> Table {
    let done = room.now().into_iter().flat_map(lanes::data);
    Table {
        id: "control-room-tick",
        title: format!("Tick {}, lane by lane", room.tick()),
        columns: ["lane", "what it did"].map(str::to_owned).to_vec(),
        rows: done
            .map(|(name, data)| vec![name.to_owned(), data])
            .collect(),
        place: TablePlace::Shown,
    }
}

/// The newest events up to a tick, newest first.
fn newest_events(events: &[Event], now: usize) -> Table {
    let past = &events[..events.partition_point(|event| event.tick <= now)];
    Table {
        id: "control-room-log",
        title: "Event log, newest first".to_owned(),
        columns: ["tick", "part", "event"].map(str::to_owned).to_vec(),
        rows: past.iter().rev().take(SHOWN_EVENTS).map(row).collect(),
        place: TablePlace::Shown,
    }
}

/// All events, for the export.
fn full_log(events: &[Event]) -> Table {
    Table {
        id: "control-room-events",
        title: "Event log".to_owned(),
        columns: ["tick", "part", "event"].map(str::to_owned).to_vec(),
        rows: events.iter().map(row).collect(),
        place: TablePlace::ExportOnly,
    }
}

fn row(event: &Event) -> Vec<String> {
    vec![
        event.tick.to_string(),
        event.part.to_owned(),
        event.text.clone(),
    ]
}

/// All samples of the run, one row a tick.
fn over_time(room: &ControlRoom) -> Table {
    let head = [
        "tick",
        "tau (m)",
        "pairs",
        "rmse (m)",
        "iterations",
        "odometry error (m)",
        "estimate error (m)",
        "map disagreement (m)",
    ];
    let history = &room.history;
    let rows = room.record.lap.reports.iter().map(|report| {
        let matched = &report.registration.matched;
        let tick = report.tick;
        vec![
            tick.to_string(),
            history.tau_m[tick].to_string(),
            matched.inliers.to_string(),
            matched.rmse_m.to_string(),
            matched.iterations.to_string(),
            history.odometry_error_m[tick].to_string(),
            history.estimate_error_m[tick].to_string(),
            finite(history.disagreement_m[tick]),
        ]
    });
    Table {
        id: "control-room-over-time",
        title: "The run, tick by tick".to_owned(),
        columns: head.map(str::to_owned).to_vec(),
        rows: rows.collect(),
        place: TablePlace::ExportOnly,
    }
}

/// The number, or nothing where there is none.
fn finite(value: f64) -> String {
    if value.is_finite() {
        value.to_string()
    } else {
        String::new()
    }
}
