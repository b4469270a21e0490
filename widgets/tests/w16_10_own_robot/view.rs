//! The widget's requests to its host, and its picture without a GPU.

use log_messages::{MapperReport, ScanReport, Stage};
use widget_kit::model::Model as _;
use widget_kit::scene::{Layer, Mark};
use widgets::registry::find;
use widgets::w16_10_own_robot::model::OwnRobot;
use widgets::w16_10_own_robot::view;

use crate::w16_10_own_robot::model::{mapped, progress, report};

/// The scan of a keyframe before it was deskewed, and after.
fn scan(keyframe: usize, sweep: Vec<[f64; 2]>) -> MapperReport {
    MapperReport::Scan(ScanReport {
        keyframe,
        points: vec![[2.0, 0.0], [2.0, 1.0]],
        sweep,
    })
}

#[test]
fn a_press_on_a_button_becomes_a_request() {
    let mut shell = find("w16.10").unwrap()();
    shell.press("open").unwrap();
    assert_eq!(shell.take_requests(), ["open"]);
}

#[test]
fn stop_is_enabled_while_a_log_is_read() {
    let mut shell = find("w16.10").unwrap()();
    assert!(shell.disabled().contains(&"cancel"));
    shell.press("cancel").unwrap();
    assert!(shell.take_requests().is_empty());
    report(shell.model_mut(), &progress(Stage::Reading, 20));
    assert!(!shell.disabled().contains(&"cancel"));
    shell.press("cancel").unwrap();
    assert_eq!(shell.take_requests(), ["cancel"]);
    report(shell.model_mut(), &progress(Stage::Done, 40));
    assert!(shell.disabled().contains(&"cancel"));
}

#[test]
fn a_scan_that_took_time_is_shown_before_and_after_deskewing() {
    let mut robot = mapped();
    let dots = |robot: &OwnRobot| {
        let layers = robot.scene().panels.swap_remove(0).layers;
        let dots = layers.into_iter().filter_map(|layer| match layer {
            Layer::Points {
                points,
                mark: Mark::Dot,
                ..
            } => Some(points),
            _ => None,
        });
        dots.collect::<Vec<_>>()
    };
    report(&mut robot, &scan(4, vec![]));
    assert!(dots(&robot).is_empty(), "it was one instant");
    report(&mut robot, &scan(3, vec![[2.5, 0.0]]));
    assert!(dots(&robot).is_empty(), "that of another keyframe");
    // Keyframe 4 is at x = 4 m.
    report(&mut robot, &scan(4, vec![[2.5, 0.0]]));
    assert_eq!(dots(&robot), [[[6.5, 0.0]]]);
}

#[test]
fn no_text_overlaps_or_is_cut_off_with_a_map_at_any_width() {
    let mut robot = mapped();
    report(&mut robot, &scan(4, vec![[2.0, 0.0], [2.4, 1.1]]));
    for width in [320.0, 390.0, 560.0, 700.0, 1100.0] {
        let faults = widget_kit::audit::text_faults(&robot, view::arrange, width);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
