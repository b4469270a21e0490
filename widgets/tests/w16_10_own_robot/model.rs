//! The widget's reaction to the worker's reports, and its orders to the worker.

use log_messages::{
    GradeReport, KeyframeReport, LoopDecision, LoopReport, MapReport, MapperOrder, MapperProgress,
    MapperReport, Stage,
};
use widget_kit::host_messages::Delivery;
use widget_kit::model::{Activity, Assessment, Model, text_alternative};
use widget_kit::scene::{Layer, Tone};
use widgets::w16_10_own_robot::model::OwnRobot;

/// A message of the page.
pub fn tell(robot: &mut OwnRobot, kind: &str, text: &str) {
    robot.receive(&Delivery {
        kind,
        text,
        ..Delivery::default()
    });
}

/// A report of the worker.
pub fn report(model: &mut dyn Model, report: &MapperReport) {
    model.receive(&Delivery {
        kind: report.kind(),
        bytes: &report.to_bytes(),
        ..Delivery::default()
    });
}

pub fn progress(stage: Stage, scans: usize) -> MapperReport {
    MapperReport::Progress(MapperProgress {
        stage,
        share: if stage == Stage::Done { 1.0 } else { 0.5 },
        scans,
        ..MapperProgress::default()
    })
}

/// A loop from keyframe 3 to 0 of which 0.8 of the scan fits.
fn link(chi2: f64, decision: LoopDecision) -> LoopReport {
    LoopReport {
        new: 3,
        old: 0,
        share: 0.8,
        rmse_m: 0.02,
        points: 90.0,
        margin: f64::NAN,
        chi2,
        gate_chi2: 16.3,
        decision,
        reason: String::new(),
    }
}

fn keyframes(count: u32) -> MapperReport {
    let keyframe = |k| KeyframeReport {
        stamp_s: k,
        pose: [k, 0.0, 0.0],
        odometry: [f64::NAN; 3],
        fit: 1.0 - 0.1 * k,
        sigma_m: 0.01 * k,
    };
    MapperReport::Keyframes((0..count).map(|k| keyframe(f64::from(k))).collect())
}

fn doubts(sentences: &[&str], keyframes: &[usize]) -> MapperReport {
    MapperReport::Doubts {
        sentences: sentences.iter().map(|&text| text.to_owned()).collect(),
        keyframes: keyframes.to_vec(),
    }
}

fn map(columns: usize, cells: Vec<u8>) -> MapperReport {
    MapperReport::Map(MapReport {
        columns,
        min: [-1.0, -0.5],
        cell_m: 1.0,
        cells,
    })
}

/// Five keyframes on a line, two loops, the second one rejected.
pub fn mapped() -> OwnRobot {
    let mut robot = OwnRobot::new();
    tell(&mut robot, "opening", "my.log");
    let rejected = LoopReport {
        new: 4,
        old: 1,
        share: 0.3,
        rmse_m: 0.2,
        points: 12.0,
        reason: "12 points fit, 30 are asked".to_owned(),
        ..link(90.0, LoopDecision::Rejected)
    };
    for part in [
        MapperReport::File {
            name: "my.log".to_owned(),
            has_scans: true,
        },
        keyframes(5),
        map(2, vec![0, 255]),
        MapperReport::Loops(vec![link(20.0, LoopDecision::Closed), rejected]),
        doubts(&["the loop contradicts"], &[3]),
        progress(Stage::Done, 40),
    ] {
        report(&mut robot, &part);
    }
    robot.take_requests();
    robot
}

/// What the worker gets of the widget.
pub fn orders(robot: &mut OwnRobot) -> Vec<MapperOrder> {
    let requests = robot.take_requests().into_iter();
    requests
        .map(|request| MapperOrder::from_request(&request).unwrap_or_else(|| panic!("{request}")))
        .collect()
}

#[test]
fn play_maps_the_sample_then_pauses_it_then_plays_the_path() {
    let mut robot = OwnRobot::new();
    robot.press("play").unwrap();
    assert_eq!(robot.take_requests(), ["sample"]);
    assert_eq!(robot.robot().progress.stage, Stage::Opening);
    assert!(robot.timeline().unwrap().playing);
    robot.press("play").unwrap();
    assert_eq!(robot.take_requests(), ["pause"]);
    assert!(!robot.timeline().unwrap().playing);
    tell(&mut robot, "opening", "ring.log");
    assert!(
        !robot.timeline().unwrap().playing,
        "it was held before it came"
    );
    robot.press("play").unwrap();
    assert_eq!(robot.take_requests(), ["resume"]);

    let mut robot = mapped();
    assert_eq!(robot.advance(1.0), Activity::Idle);
    robot.press("play").unwrap();
    assert_eq!(robot.values().number("keyframe"), 0.0);
    let mut frames = 0;
    while robot.advance(0.1) == Activity::Busy {
        frames += 1;
        assert!(frames < 1000, "it never ends");
    }
    assert_eq!(robot.values().number("keyframe"), 4.0);
    assert_eq!(
        orders(&mut robot),
        [MapperOrder::Look(4)],
        "of orders to look the last one stands"
    );
}

#[test]
fn other_doubts_are_reported_even_if_no_loop_contradicts() {
    let mut robot = mapped();
    report(&mut robot, &MapperReport::Loops(Vec::new()));
    let sentence = |robot: &OwnRobot| robot.outcome().sentence.clone();
    assert!(sentence(&robot).contains("but the list of doubts is not empty"));
    assert_eq!(robot.outcome().standing, Assessment::Neutral);
    report(&mut robot, &doubts(&[], &[]));
    assert!(sentence(&robot).contains("no loop contradicts the graph."));
    assert_eq!(robot.outcome().standing, Assessment::Good);
}

#[test]
fn counts_of_one_are_singular() {
    let mut robot = mapped();
    assert!(
        robot
            .outcome()
            .sentence
            .contains("40 scans became 5 keyframes")
    );
    report(&mut robot, &keyframes(1));
    report(&mut robot, &progress(Stage::Done, 1));
    report(&mut robot, &MapperReport::Loops(Vec::new()));
    let sentence = robot.outcome().sentence.clone();
    assert!(
        sentence.contains("1 scan became 1 keyframe on a path of 0 m. It holds 0 loops"),
        "{sentence}"
    );
}

#[test]
fn a_contradicting_loop_is_reported_and_shown_first() {
    let robot = mapped();
    let outcome = robot.outcome();
    assert_eq!(
        (outcome.standing, outcome.verdict.as_str()),
        (Assessment::Doubtful, "1 of 1 loop in doubt")
    );
    assert!(outcome.sentence.contains("one loop contradicts the graph"));
    assert!(outcome.sentence.contains("none of it is sent anywhere"));
    let fact = |id: &str| {
        outcome
            .facts
            .iter()
            .find(|fact| fact.id == id)
            .unwrap()
            .value
    };
    assert_eq!(
        (fact("loops"), fact("loops_rejected"), fact("loops_doubted")),
        (1.0, 1.0, 1.0)
    );
    assert_eq!(
        (fact("scans"), fact("path_length_m"), fact("worst_sigma_m")),
        (40.0, 4.0, 0.04)
    );
    let tables = robot.shown_tables();
    assert_eq!(tables[0].rows[0][0], "▸ 0");
    assert_eq!(tables[0].rows[1][6], "rejected");
}

#[test]
fn a_loop_that_the_reader_accepts_or_rejects_is_no_longer_one_to_look_into() {
    use LoopDecision::{Closed, Confirmed, Removed};
    for (loops, verdict, standing) in [
        (
            vec![link(20.0, Closed), link(30.0, Closed)],
            "2 of 2 loops",
            Assessment::Doubtful,
        ),
        (
            vec![link(20.0, Confirmed), link(30.0, Closed)],
            "1 of 2 loops",
            Assessment::Doubtful,
        ),
        (
            vec![link(20.0, Confirmed), link(30.0, Removed)],
            "none of 1 loop",
            Assessment::Good,
        ),
    ] {
        let mut robot = mapped();
        report(&mut robot, &doubts(&[], &[]));
        report(&mut robot, &MapperReport::Loops(loops.clone()));
        let outcome = robot.outcome();
        assert_eq!(outcome.verdict, format!("{verdict} in doubt"));
        assert_eq!(outcome.standing, standing, "{verdict}");
        let is_accepted = loops[0].decision == Confirmed;
        assert_eq!(outcome.sentence.contains("1 accepted by you"), is_accepted);
    }
    let [amber, red] = [Assessment::Doubtful, Assessment::Bad]
        .map(|standing| widget_kit::palette::standing(widget_kit::palette::Theme::Light, standing));
    assert_ne!(amber, red);
}

#[test]
fn the_list_can_be_stepped_through_and_every_choice_becomes_an_order() {
    let mut robot = mapped();
    robot.press("next").unwrap();
    assert_eq!(
        (
            robot.values().number("loop"),
            robot.values().number("keyframe")
        ),
        (1.0, 4.0)
    );
    assert!(robot.shown_tables()[0].title.contains("12 points fit"));
    robot.press("turn").unwrap();
    robot.press("next").unwrap();
    assert_eq!(
        robot.values().number("loop"),
        0.0,
        "after the last comes the first"
    );
    robot.press("previous").unwrap();
    robot.press("mark").unwrap();
    robot.set("keyframe", 1.0).unwrap();
    robot.press("add").unwrap();
    robot.press("unpin").unwrap();
    robot.press("doubt").unwrap();
    assert_eq!(robot.values().number("keyframe"), 3.0);
    robot.set("poor", 0.75).unwrap();
    robot.press("doubt").unwrap();
    assert_eq!(robot.values().number("keyframe"), 4.0, "0.6 of it fits");
    robot.set("file", 4.0).unwrap();
    robot.press("save").unwrap();
    robot.press("cancel").unwrap();
    let requests = robot.take_requests();
    let [turn, add, unpin, look] = [
        MapperOrder::Turn(1),
        MapperOrder::Add(4, 1),
        MapperOrder::Unpin,
        MapperOrder::Look(4),
    ]
    .map(|it| it.request());
    let save = "save graph.g2o".to_owned();
    assert_eq!(
        requests,
        [turn, add, unpin, look, save, "cancel".to_owned()]
    );
}

#[test]
fn a_press_selects_a_keyframe_and_a_drag_moves_the_selected_one() {
    let mut robot = mapped();
    let reach = [0.3, 0.3];
    assert_eq!(robot.grab("map", [2.0, 1.0], reach), None);
    let at = [2.1, 0.1];
    let handle = robot.grab("map", at, reach).unwrap();
    assert_eq!(handle.id, "keyframe");
    robot.drag(handle, at);
    assert_eq!(robot.values().number("keyframe"), 2.0);
    assert_eq!(orders(&mut robot), [MapperOrder::Look(2)]);
    let handle = robot.grab("map", at, reach).unwrap();
    assert_eq!(handle.id, "held");
    robot.drag(handle, at);
    assert_eq!(
        robot.take_requests(),
        Vec::<String>::new(),
        "a press is no drag"
    );
    robot.drag(handle, [2.1, 0.6]);
    robot.drag(handle, [2.1, 1.1]);
    let [MapperOrder::Pin(2, [x, y, _])] = orders(&mut robot)[..] else {
        panic!("one order to pin keyframe 2");
    };
    assert_eq!([x, y].map(|m| (m * 1e6).round() / 1e6), [2.0, 1.0]);
    let sentence = robot.outcome().sentence;
    assert!(
        sentence.contains("Keyframe 2 is held at x 2.00 m, y 1.00 m."),
        "{sentence}"
    );
    robot.drag(handle, [f64::NAN, 1e300]);
    assert_eq!(robot.take_requests(), Vec::<String>::new());
}

#[test]
fn arrow_keys_move_the_selected_keyframe_like_a_drag() {
    let mut robot = mapped();
    robot.set("keyframe", 2.0).unwrap();
    robot.take_requests();
    for (key, button) in robot.keys() {
        robot.press(button).unwrap();
        let expected = match *key {
            "ArrowLeft" => [1.95, 0.0, 0.0],
            "ArrowUp" => [2.0, 0.05, 0.0],
            // Back again.
            _ => [2.0, 0.0, 0.0],
        };
        assert_eq!(orders(&mut robot), [MapperOrder::Pin(2, expected)], "{key}");
    }
    assert_eq!(robot.keys().len(), 4);
    report(&mut robot, &progress(Stage::Reading, 20));
    robot.press("north").unwrap();
    let none = Vec::<String>::new();
    assert_eq!(robot.take_requests(), none, "the graph is not there yet");
    let mut robot = OwnRobot::new();
    robot.press("north").unwrap();
    assert_eq!(robot.take_requests(), none);
}

#[test]
fn a_selected_loop_is_described_with_its_evidence() {
    let mut robot = mapped();
    let first = "The listed loop goes from keyframe 3 to 0: closed; 0.80 of the scan fits, 0.020 m off; χ² 20.0 of 16.3.";
    assert!(robot.summary().ends_with(first), "{}", robot.summary());
    robot.press("next").unwrap();
    let second = "from keyframe 4 to 1: rejected, because 12 points fit, 30 are asked; 0.30 of the scan fits";
    let sentence = robot.outcome().sentence;
    assert!(sentence.contains(second), "{sentence}");
    assert_eq!(text_alternative(&robot, false).matches(second).count(), 1);
    // A loop of a graph from a file has no registration, and may have no χ².
    let bare = LoopReport {
        share: f64::NAN,
        ..link(f64::NAN, LoopDecision::Closed)
    };
    report(&mut robot, &MapperReport::Loops(vec![bare]));
    assert!(robot.summary().ends_with("from keyframe 3 to 0: closed."));
}

#[test]
fn requests_without_a_map_are_answered() {
    let mut robot = mapped();
    tell(&mut robot, "answer", "The loop 3 to 0 is in the graph.");
    tell(&mut robot, "failed", "x.log is empty; use a recorded log");
    assert_eq!(
        robot.outcome().sentence,
        "x.log is empty; use a recorded log"
    );
    tell(
        &mut robot,
        "answer",
        "truth.tum waits for a log to be opened.",
    );
    assert_eq!(
        robot.outcome().sentence,
        "x.log is empty; use a recorded log. truth.tum waits for a log to be opened."
    );
}

#[test]
fn a_path_of_one_keyframe_has_length_zero() {
    let mut robot = mapped();
    report(&mut robot, &keyframes(1));
    let sentence = robot.outcome().sentence;
    assert!(sentence.contains("on a path of 0 m"), "{sentence}");
}

#[test]
fn a_malformed_delivery_changes_no_state() {
    let mut robot = mapped();
    let before = robot.robot().clone();
    report(&mut robot, &map(0, vec![0]));
    report(&mut robot, &map(2, vec![0; 3]));
    tell(&mut robot, "weather", "fine");
    for bytes in [
        &b""[..],
        &[255; 40],
        &progress(Stage::Done, 7).to_bytes()[..5],
    ] {
        robot.receive(&Delivery {
            kind: "progress",
            bytes,
            ..Delivery::default()
        });
    }
    // NaN stands for a missing number, and does not equal itself.
    assert_eq!(format!("{before:?}"), format!("{:?}", robot.robot()));
    let unknown = KeyframeReport {
        stamp_s: f64::NAN,
        pose: [f64::NAN; 3],
        odometry: [f64::NAN; 3],
        fit: f64::NAN,
        sigma_m: f64::NAN,
    };
    report(&mut robot, &MapperReport::Keyframes(vec![unknown; 2]));
    let far = LoopReport {
        new: usize::MAX,
        ..link(f64::INFINITY, LoopDecision::Closed)
    };
    report(&mut robot, &MapperReport::Loops(vec![far]));
    let _ = (
        robot.scene(),
        robot.outcome(),
        robot.summary(),
        robot.tables(),
    );
}

#[test]
fn the_path_is_coloured_by_the_selected_quantity() {
    let mut robot = mapped();
    let bar = |robot: &OwnRobot| robot.scene().panels[0].color_bar.clone();
    let shades = |robot: &OwnRobot| {
        let scene = robot.scene();
        let layers = scene.panels[0].layers.iter();
        layers
            .filter(|layer| {
                matches!(
                    layer,
                    Layer::Segments {
                        tone: widget_kit::scene::Tone::Level(_),
                        ..
                    }
                )
            })
            .count()
    };
    assert_eq!((bar(&robot).unwrap().max, shades(&robot)), (4.0, 4));
    robot.set("colour", 2.0).unwrap();
    assert_eq!(bar(&robot).unwrap().label, "σ (m)");
    robot.set("colour", 3.0).unwrap();
    assert_eq!(
        (bar(&robot), shades(&robot)),
        (None, 0),
        "no reference was given"
    );
    let grade = GradeReport {
        words: "5 poses: 0.2 m off".to_owned(),
        error_m: 0.2,
        errors_m: vec![0.0, 0.1, 0.2, f64::NAN, 0.4],
    };
    report(&mut robot, &MapperReport::Grade(grade));
    assert_eq!(shades(&robot), 3);
    assert!(robot.outcome().sentence.contains("5 poses: 0.2 m off."));
}

#[test]
fn another_file_replaces_the_first_and_an_invalid_one_is_reported() {
    let mut robot = mapped();
    robot.press("sure").unwrap();
    assert_eq!(robot.take_requests(), ["close", "sample"]);
    assert_eq!(robot.robot().progress.stage, Stage::Opening);
    let mut robot = mapped();
    robot.set("keyframe", 2.0).unwrap();
    tell(&mut robot, "opening", "other.bag");
    assert!(robot.robot().keyframes.is_empty());
    assert_eq!(robot.values().number("keyframe"), 999_999.0);
    tell(
        &mut robot,
        "failed",
        "other.bag is empty; use a recorded log",
    );
    let outcome = robot.outcome();
    assert_eq!(outcome.standing, Assessment::Bad);
    assert_eq!(outcome.sentence, "other.bag is empty; use a recorded log");
}

#[test]
fn what_could_not_be_fetched_is_told_once_and_no_file_is_blamed() {
    let mut robot = OwnRobot::new();
    let problem = "The sample could not be fetched; open a log of your own, or try again.";
    tell(&mut robot, "failed", problem);
    assert_eq!(robot.outcome().sentence, problem);
    let words = robot
        .scene()
        .panels
        .into_iter()
        .flat_map(|panel| panel.layers);
    let words: Vec<String> = words
        .filter_map(|layer| match layer {
            Layer::Question(words) => Some(words),
            _ => None,
        })
        .collect();
    assert_eq!(words, ["There is no map yet."]);
}

/// In its own frame the odometry drives along y, and its steps are a tenth too long.
#[test]
fn the_wheels_alone_start_where_the_map_has_the_first_keyframe_with_odometry() {
    let mut robot = mapped();
    let keyframe = |k: u8| KeyframeReport {
        stamp_s: f64::from(k),
        pose: [f64::from(k), 1.0, 0.0],
        odometry: match k {
            0 => [f64::NAN; 3],
            _ => [7.0, 1.1 * f64::from(k), core::f64::consts::FRAC_PI_2],
        },
        fit: 1.0,
        sigma_m: 0.01,
    };
    let keyframes = (0..4).map(keyframe).collect();
    report(&mut robot, &MapperReport::Keyframes(keyframes));
    let sentence = robot.outcome().sentence;
    assert!(
        sentence.contains("after 3 m the wheels alone are 0.2 m out. "),
        "{sentence}"
    );
    let path = |robot: &OwnRobot| {
        let layers = robot.scene().panels[0].layers.clone();
        layers.into_iter().find_map(|layer| match layer {
            Layer::Line {
                points,
                tone: Tone::Prediction,
                ..
            } => Some(points),
            _ => None,
        })
    };
    let points = path(&robot).expect("a path");
    assert!(points[0][0].is_nan(), "{points:?}");
    for (point, x) in points[1..].iter().zip([1.0, 2.1, 3.2]) {
        let off_m = (point[0] - x).hypot(point[1] - 1.0);
        assert!(off_m < 1e-9, "{points:?}");
    }
    robot.set("keyframe", 1.0).unwrap();
    assert_eq!(
        path(&robot).expect("a path").len(),
        2,
        "up to the one shown"
    );
    assert_eq!(path(&mapped()), None, "a log without odometry");
}

#[test]
fn the_view_follows_the_wheels_up_to_twice_the_size_of_the_map() {
    // The robot drives 20 m along x; its wheels lead it along y.
    let view = |wheels_m: f64| {
        let mut robot = mapped();
        let keyframe = |k: u8| KeyframeReport {
            stamp_s: f64::from(k),
            pose: [5.0 * f64::from(k), 0.0, 0.0],
            odometry: [0.0, wheels_m * f64::from(k) / 4.0, 0.0],
            fit: 1.0,
            sigma_m: 0.01,
        };
        report(
            &mut robot,
            &MapperReport::Keyframes((0..5).map(keyframe).collect()),
        );
        let map = robot.scene().panels.swap_remove(0);
        assert!(map.is_plan(), "it has a bar of metres in place of axes");
        map.y.max
    };
    assert!(view(8.0) > 8.0);
    assert!(view(1e3) < 30.0);
}
