//! A robot that drives, of whom the page tells the engine what comes.

use robot_io::log::LogOptions;
use slam_robot::engine::Engine;
use slam_robot::update::{DriveReport, Update};

const ADVERTISED: &str = r#"{"op": "advertise", "channels": [
    {"id": 1, "topic": "/scan", "encoding": "cdr", "schemaName": "sensor_msgs/msg/LaserScan"}]}"#;

/// The report on the drive, if there is a new one.
fn reported(engine: &mut Engine<'_>) -> Option<DriveReport> {
    let updates = engine.updates();
    updates.into_iter().find_map(|update| match update {
        Update::Drive(report) => Some(report),
        _ => None,
    })
}

#[test]
fn what_came_of_a_drive_is_reported_whenever_it_has_changed() {
    let mut engine = Engine::listen("ws://robot:8765", &LogOptions::default());
    assert!(reported(&mut engine).unwrap().is_driving);
    assert_eq!(reported(&mut engine), None);
    engine.hear_text(ADVERTISED);
    assert_eq!(engine.take_requests().len(), 1);
    let report = reported(&mut engine).unwrap();
    assert_eq!(
        (report.reads, report.lasers),
        (vec!["/scan".to_owned()], vec!["/scan".to_owned()])
    );
    assert_eq!(reported(&mut engine), None);
    engine.end_without_scans();
    let report = reported(&mut engine).unwrap();
    let said =
        "ws://robot:8765: no scan came; it has /scan (sensor_msgs/msg/LaserScan). Start the driver";
    assert!(
        !report.is_driving && report.said.starts_with(said),
        "{}",
        report.said
    );
    assert_eq!(reported(&mut engine), None);
}
