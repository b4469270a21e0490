//! The robot of another log on the map, and recordings with several topics.

use log_messages::{LocalizationState, LocalizedScan, MapperReport, Offer, OtherLog, Stage};
use widget_kit::model::{Assessment, Model};
use widget_kit::scene::{Layer, Stroke};
use widgets::w16_10_own_robot::model::OwnRobot;

use crate::w16_10_own_robot::model::{mapped, progress, report, tell};

const NAN: f64 = f64::NAN;

/// Five scans: lost, doubtful, found, followed, lost again.
fn places() -> Vec<LocalizedScan> {
    use LocalizationState::{Doubtful, Found, Lost, Tracking};
    let scans = [
        ([NAN; 3], Lost, NAN),
        ([1.0, 0.2, 0.0], Doubtful, NAN),
        ([2.0, 0.2, 0.0], Found, 0.05),
        ([2.5, 0.2, 0.1], Tracking, 0.04),
        ([NAN; 3], Lost, NAN),
    ];
    let scans = scans.into_iter().enumerate();
    scans
        .map(|(scan, (pose, state, sigma_m))| LocalizedScan {
            scan,
            stamp_s: 10.0 + scan as f64,
            pose,
            state,
            fit: 0.8,
            ellipse: [sigma_m, 0.5 * sigma_m, 0.0],
        })
        .collect()
}

fn with_visitor(is_over: bool) -> OwnRobot {
    let mut robot = mapped();
    let other = OtherLog {
        name: "tuesday.log".to_owned(),
        share: 0.4,
        is_over,
        counts: [1, 1, 1, 2],
        first: Some(2),
        remarks: Vec::new(),
        places: places(),
    };
    report(&mut robot, &MapperReport::OtherLog(other));
    robot
}

#[test]
fn another_log_starts_anywhere_or_at_the_selected_keyframe() {
    let mut robot = mapped();
    robot.press("locate").unwrap();
    robot.press("locate-sample").unwrap();
    assert_eq!(robot.take_requests(), ["locate", "locate-sample"]);
    robot.set("start", 1.0).unwrap();
    robot.set("keyframe", 2.0).unwrap();
    robot.take_requests();
    robot.press("locate").unwrap();
    assert_eq!(robot.take_requests(), ["locate 2 0 0"]);
    tell(&mut robot, "dropped", "tuesday.log");
    assert_eq!(robot.take_requests(), ["locate-dropped 2 0 0"]);
    robot.set("drop", 1.0).unwrap();
    assert_eq!(robot.take_requests(), ["drop where"]);
    robot.press("defaults").unwrap();
    assert_eq!(robot.take_requests(), ["close", "drop map"]);
}

#[test]
fn its_verdicts_are_reported_and_can_be_stepped_through() {
    let mut robot = with_visitor(true);
    let sentence = |robot: &OwnRobot| robot.outcome().sentence;
    let whole = "The robot of tuesday.log is found at scan 2: of 5 scans, 2 are localized, 1 doubtful, 2 lost.";
    assert!(sentence(&robot).contains(whole), "{}", sentence(&robot));
    assert!(sentence(&robot).contains("At scan 4 it is lost."));
    robot.press("change").unwrap();
    assert_eq!(
        robot.values().number("scan"),
        0.0,
        "after the last change comes the first scan"
    );
    robot.press("change").unwrap();
    assert_eq!(robot.values().number("scan"), 2.0);
    assert!(
        sentence(&robot)
            .contains("At scan 2 it is found at x 2.0 m, y 0.2 m, turned 0°, known to 0.05 m.")
    );
    robot.press("change").unwrap();
    assert_eq!(robot.values().number("scan"), 4.0);
    let facts = robot.outcome().facts;
    let fact = |id: &str| facts.iter().find(|fact| fact.id == id).unwrap().value;
    assert_eq!(
        (
            fact("where_localized"),
            fact("where_doubtful"),
            fact("where_lost")
        ),
        (2.0, 1.0, 2.0)
    );
    let tables = robot.tables();
    let table = tables.iter().find(|table| table.id == "where").unwrap();
    let verdicts: Vec<&str> = table.rows.iter().map(|row| row[2].as_str()).collect();
    assert_eq!(verdicts, ["lost", "doubtful", "found", "followed", "lost"]);
    assert!(robot.outcome().sentence.contains("tuesday.log"));
}

#[test]
fn its_path_is_drawn_over_the_map_with_doubtful_parts_dotted() {
    let mut robot = with_visitor(true);
    robot.set("scan", 3.0).unwrap();
    let scene = robot.scene();
    let lines = |wanted: Stroke| {
        let layers = scene.panels[0].layers.iter();
        let known = layers.filter_map(|layer| match layer {
            Layer::Line {
                points,
                stroke,
                tone,
                ..
            } if *stroke == wanted && *tone == widget_kit::scene::Tone::Class(2) => {
                Some(points.iter().filter(|point| point[0].is_finite()).count())
            }
            _ => None,
        });
        known.sum::<usize>()
    };
    assert_eq!((lines(Stroke::Solid), lines(Stroke::Dotted)), (2, 1));
    let is_ellipse = |layer: &&Layer| matches!(layer, Layer::Ellipse { .. });
    let ellipse = scene.panels[0].layers.iter().find(is_ellipse);
    let Some(Layer::Ellipse {
        center, half_axes, ..
    }) = ellipse
    else {
        panic!("no ellipse");
    };
    assert_eq!(*center, [2.5, 0.2]);
    assert!(
        (half_axes[0][0] - 0.12).abs() < 1e-12,
        "three standard deviations"
    );
    let legend = &scene.panels[0].legend;
    assert!(
        legend
            .iter()
            .any(|entry| entry.label == "the other log, localized")
    );
    let faults =
        widget_kit::audit::text_faults(&robot, widgets::w16_10_own_robot::view::arrange, 390.0);
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn localization_is_paused_and_resumed_by_play() {
    let mut robot = with_visitor(false);
    assert_eq!(robot.outcome().verdict, "looking for the robot");
    assert_eq!(robot.outcome().standing, Assessment::Neutral);
    assert!(
        robot
            .outcome()
            .sentence
            .contains("found at scan 2, 40% done")
    );
    robot.press("play").unwrap();
    assert_eq!(robot.take_requests(), ["pause"]);
    report(&mut robot, &progress(Stage::Done, 40));
    assert_eq!(robot.outcome().verdict, "held");
    robot.take_requests();
    robot.press("play").unwrap();
    assert_eq!(robot.take_requests(), ["resume"]);
}

#[test]
fn a_log_without_scans_is_reported() {
    let mut robot = mapped();
    let other = OtherLog {
        name: "x.log".to_owned(),
        is_over: true,
        remarks: vec!["x.log is not a CARMEN log".to_owned()],
        ..OtherLog::default()
    };
    report(&mut robot, &MapperReport::OtherLog(other));
    assert!(
        robot
            .outcome()
            .sentence
            .contains(" x.log is not a CARMEN log.")
    );
    assert_eq!(robot.outcome().verdict, "1 of 1 loop in doubt");
    robot.press("change").unwrap();
    let mut robot = with_visitor(true);
    tell(&mut robot, "opening", "other.log");
    assert!(robot.robot().other_log.is_none());
    assert!(LocalizationState::Found.is_localized() && !LocalizationState::Doubtful.is_localized());
}

#[test]
fn another_topic_is_taken_if_the_recording_has_one() {
    let mut robot = mapped();
    assert!(!robot.is_enabled("other"));
    let offer = |option: &str, names: &[&str]| Offer {
        option: option.to_owned(),
        taken: names[0].to_owned(),
        names: names.iter().map(|&name| name.to_owned()).collect(),
    };
    let offers = vec![
        offer("scan-topic", &["/front", "/back"]),
        offer("odom-topic", &["/odom"]),
        offer("body-frame", &["base", "laser", "map"]),
    ];
    report(&mut robot, &MapperReport::Offers(offers));
    let shown = robot.shown_tables();
    let table = shown.iter().find(|table| table.id == "offers").unwrap();
    assert_eq!(
        table.rows,
        [
            ["scan topic", "/front", "/back"],
            ["body frame", "base", "laser, map"]
        ]
    );
    robot.press("other").unwrap();
    assert_eq!(robot.take_requests(), ["option scan-topic /back"]);
    robot.set("option", 3.0).unwrap();
    robot.press("other").unwrap();
    assert_eq!(robot.take_requests(), ["option body-frame laser"]);
    robot.set("option", 1.0).unwrap();
    robot.press("other").unwrap();
    assert!(robot.take_requests().is_empty());
}
