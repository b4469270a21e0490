//! The tables: the event log, and the data of every plot.

use widget_kit::model::Table;

use super::ControlRoom;
use super::log::Event;
use super::picture::parts;

/// Number of events in the table beside the picture.
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

/// The data of every part in the current tick.
fn this_tick(room: &ControlRoom) -> Table {
    let done = room.now().into_iter().flat_map(parts::data);
    Table::shown(
        "control-room-tick",
        format!("Tick {}, part by part", room.tick()),
        &["part", "what it did"],
        done.map(|(name, data)| vec![name.to_owned(), data])
            .collect(),
    )
}

/// The newest events up to a tick, newest first.
fn newest_events(events: &[Event], now: usize) -> Table {
    let past = &events[..events.partition_point(|event| event.tick <= now)];
    Table::shown(
        "control-room-log",
        "Event log, newest first",
        &["tick", "part", "event"],
        past.iter().rev().take(SHOWN_EVENTS).map(row).collect(),
    )
}

/// All events, for the export.
fn full_log(events: &[Event]) -> Table {
    Table::exported(
        "control-room-events",
        "Event log",
        &["tick", "part", "event"],
        events.iter().map(row).collect(),
    )
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
    let history = &room.history;
    Table::of_items(
        "control-room-over-time",
        "The run, tick by tick",
        &room.record.lap.reports,
        &[
            ("tick", &|report| report.tick.into()),
            ("tau (m)", &|report| history.tau_m[report.tick].into()),
            ("pairs", &|report| {
                report.registration.matched.inliers.into()
            }),
            ("rmse (m)", &|report| {
                report.registration.matched.rmse_m.into()
            }),
            ("iterations", &|report| {
                report.registration.matched.iterations.into()
            }),
            ("odometry error (m)", &|report| {
                history.odometry_error_m[report.tick].into()
            }),
            ("estimate error (m)", &|report| {
                history.estimate_error_m[report.tick].into()
            }),
            ("map disagreement (m)", &|report| {
                history.disagreement_m[report.tick].into()
            }),
        ],
    )
}
