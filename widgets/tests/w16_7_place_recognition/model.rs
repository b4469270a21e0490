//! The comparison without its picture; reference values from `ch16 places`.

use ch16_lab::lap::{LapConfig, LapDetector, LapMatcher, NamedChoice};
use ch16_lab::places::{place_curves, place_pairs};
use widget_kit::model::{Activity, Assessment, Model, Motion};
use widget_kit::param::ParamKind;
use widget_kit::scene::{Layer, Tone};
use widgets::w16_7_place_recognition::model::{PlaceRecognition, panel};
use widgets::w16_7_place_recognition::spec::SPEC;

use crate::support::{fact, panel_of};

fn set(been: &mut PlaceRecognition, values: &[(&str, f64)]) {
    for (id, value) in values {
        been.set(id, *value).unwrap();
    }
    been.finish_work();
}

fn with(values: &[(&str, f64)]) -> PlaceRecognition {
    let mut been = PlaceRecognition::default();
    been.reveal();
    set(&mut been, values);
    been
}

#[test]
fn its_curves_are_those_of_the_command_line() {
    let been = with(&[]);
    let lap = LapConfig::default().with_matcher(LapMatcher::Ndt);
    let pairs = place_pairs(&lap);
    assert_eq!(fact(&been, "graded"), pairs.len() as f64);
    for curve in place_curves(&pairs) {
        let id = format!("{}_area", curve.detector.name());
        assert_eq!(fact(&been, &id), curve.average_precision, "{id}");
    }
}

#[test]
fn every_preset_does_what_its_button_claims() {
    let pressed = |preset: &str| {
        let mut been = PlaceRecognition::default();
        been.press(preset).unwrap();
        been.finish_work();
        been
    };
    assert_eq!(pressed("lap").values().number("new"), 0.0);
    let area = |been: &PlaceRecognition, detector| fact(been, &format!("{detector}_area"));
    let (lap, ring) = (with(&[]), pressed("ring"));
    // Every look-alike is a trap, for each detector that goes by looks.
    for detector in ["histogram", "context"] {
        assert!(area(&ring, detector) < 0.5 * area(&lap, detector));
    }
    assert_eq!(SPEC.presets.len(), 2, "a preset without a test");
}

/// A precision says nothing without its base rate: in the ring it is lower for the perfect detector, too.
#[test]
fn a_precision_stands_beside_that_of_a_guess_and_of_a_perfect_detector() {
    for world in [0.0, 1.0] {
        let been = with(&[("world", world), ("called", 30.0), ("detector", 1.0)]);
        let [guess, found, perfect] = [
            "chance_precision",
            "histogram_precision",
            "perfect_precision",
        ]
        .map(|name| fact(&been, name));
        assert_eq!(guess, fact(&been, "same") / fact(&been, "graded"));
        assert!(
            guess < found && found < perfect && perfect < 1.0,
            "{guess} {found} {perfect}"
        );
        let sentence = been.outcome().sentence;
        assert!(
            sentence.contains(&format!("{guess:.2} for a guess")),
            "{sentence}"
        );
    }
}

#[test]
fn the_options_are_the_detectors_of_the_core_in_their_order() {
    let detector = SPEC.params.iter().find(|param| param.id == "detector");
    let ParamKind::Choice { options } = detector.unwrap().kind else {
        panic!("a choice");
    };
    let names = LapDetector::all().map(|detector| detector.name());
    assert!(options.iter().map(|option| option.id).eq(names));
}

#[test]
fn a_looser_threshold_has_more_recall_and_less_precision() {
    let mut been = with(&[("called", 0.0)]);
    assert_eq!(been.outcome().verdict, "no pair is called the same");
    let (mut found, mut first) = (0.0, f64::NAN);
    for called in [5.0, 20.0, 40.0, 60.0] {
        set(&mut been, &[("called", called)]);
        let recall = fact(&been, "context_recall");
        assert!(recall >= found, "{called}");
        found = recall;
        if first.is_nan() {
            first = fact(&been, "context_precision");
        }
    }
    assert!(fact(&been, "context_precision") < first);
    assert!(found > 0.5);
}

#[test]
fn the_lap_is_driven_and_compared_in_pieces() {
    let mut pieces = PlaceRecognition::default();
    assert_eq!(pieces.outcome().verdict, "driving");
    let mut count = 0;
    while pieces.work().is_busy() {
        count += 1;
    }
    // 129 ticks of the drive and of the lap each, and the pairs.
    assert!(count > 300, "{count} pieces");
    assert!(!pieces.finish_work());
    assert_eq!(pieces.outcome(), with(&[]).outcome());
}

#[test]
fn a_pair_is_chosen_in_the_matrix_by_either_of_its_two_places() {
    let mut been = with(&[]);
    for at in [[40.0, 5.2], [4.8, 40.3]] {
        let handle = been.grab(panel::MATRIX, at, [0.1, 0.1]).unwrap();
        been.drag(handle, at);
        assert_eq!(been.values().number("new"), 40.0);
        assert_eq!(been.values().number("old"), 5.0);
        assert!(been.outcome().sentence.contains("Keyframes 5 and 40"));
    }
    let handle = been.grab(panel::MATRIX, [9.0, 3.0], [0.1, 0.1]).unwrap();
    for nowhere in [[f64::NAN, 3.0], [f64::INFINITY, 0.0]] {
        been.drag(handle, nowhere);
    }
    been.drag(handle, [-1e300, -1e300]);
    assert_eq!(been.values().number("new"), 40.0, "there is no pair there");
    been.drag(handle, [1e300, 1e300]);
    let last = been.timeline().unwrap().last;
    assert_eq!(been.values().number("new"), last);
    assert!(been.values().number("old") < last);
}

/// Where the handles of a panel are.
fn handles(been: &PlaceRecognition, panel: &str) -> Vec<[f64; 2]> {
    let layers = panel_of(been, panel).layers;
    let at = layers.iter().filter_map(|layer| match layer {
        Layer::Handle { at, .. } => Some(*at),
        _ => None,
    });
    at.collect()
}

#[test]
fn both_robots_are_dragged_along_the_path_with_their_views() {
    let mut been = with(&[("new", 30.0), ("old", 4.0)]);
    let [then, now] = handles(&been, panel::FLAT)[..] else {
        panic!("two robots");
    };
    let further = handles(&with(&[("new", 34.0), ("old", 8.0)]), panel::FLAT);
    for (id, from, to, expected) in [
        ("new", now, further[1], 34.0),
        ("old", then, further[0], 8.0),
    ] {
        let held = been.grab(panel::FLAT, from, [0.1, 0.1]).unwrap();
        been.drag(held, to);
        assert_eq!(been.values().number(id), expected);
        been.drag(held, [f64::NAN, 0.0]);
        assert_eq!(been.values().number(id), expected);
    }
    assert!(been.outcome().sentence.contains("Keyframes 8 and 34"));
    assert!(been.grab(panel::FLAT, [1.0, 8.0], [0.1, 0.1]).is_none());
}

#[test]
fn the_threshold_is_dragged_over_the_distances_and_its_slider_follows() {
    let mut been = with(&[]);
    let found = fact(&been, "context_recall");
    let [line] = handles(&been, panel::SCORES)[..] else {
        panic!("a threshold");
    };
    let held = been.grab(panel::SCORES, line, [0.01, 1.0]).unwrap();
    been.drag(held, [line[0] + 0.08, 0.0]);
    assert!(been.values().number("called") > 30.0);
    assert!(fact(&been, "context_recall") > found);
    been.drag(held, [-1e300, 0.0]);
    assert_eq!(been.values().number("called"), 0.0);
    been.drag(held, [1e300, 0.0]);
    assert_eq!(been.values().number("called"), 60.0);
}

#[test]
fn a_dot_is_a_pair_and_a_tap_on_it_shows_both_places() {
    let mut been = with(&[]);
    let marked = |been: &PlaceRecognition| {
        let layers = panel_of(been, panel::SCORES).layers;
        layers.iter().find_map(|layer| match layer {
            Layer::Points {
                points,
                tone: Tone::Posterior,
                ..
            } => points.first().copied(),
            _ => None,
        })
    };
    let dots = panel_of(&been, panel::SCORES).layers;
    let dots = dots.iter().filter_map(|layer| match layer {
        Layer::Points {
            points,
            tone: Tone::Series(_),
            ..
        } => Some(points.len()),
        _ => None,
    });
    assert_eq!(dots.sum::<usize>() as f64, fact(&been, "graded"));
    let before = marked(&been).unwrap();
    let same = [0.26, 1.0];
    been.tap(panel::SCORES, same, [0.02, 1.0]);
    assert_ne!(marked(&been).unwrap(), before);
    assert!(
        been.outcome()
            .sentence
            .contains("are rightly called the same:")
    );
}

#[test]
fn the_newer_view_is_slid_and_differs_least_at_its_best_turn() {
    let mut been = with(&[]);
    let [at] = handles(&been, panel::LOOKS)[..] else {
        panic!("a view to slide");
    };
    let held = been.grab(panel::LOOKS, at, [1.0, 0.1]).unwrap();
    for away in [-60.0, 30.0, 90.0] {
        been.drag(held, [at[0] + away, 0.0]);
        assert_eq!(been.values().number("turn"), away);
        assert!(handles(&been, panel::LOOKS)[0][1] > at[1], "{away}");
    }
    // A whole turn further it is the same view.
    been.drag(held, [at[0] + 360.0, 0.0]);
    assert_eq!(been.values().number("turn"), 0.0);
}

#[test]
fn while_it_plays_the_newer_view_turns_to_its_best_fit_at_each_keyframe() {
    let mut been = with(&[("new", 20.0)]);
    been.press("play").unwrap();
    let mut turns = 0;
    for _ in 0..40 {
        let before = handles(&been, panel::LOOKS)[0][0];
        been.advance(0.02);
        turns += usize::from(handles(&been, panel::LOOKS)[0][0] != before);
    }
    assert!(turns > 10, "{turns} of 40 frames");
}

#[test]
fn playing_drives_the_lap_from_its_start_to_its_end() {
    let mut been = PlaceRecognition::default();
    been.press("lap").unwrap();
    assert_eq!(
        been.advance(0.1),
        Activity::Busy,
        "the lap is not there yet"
    );
    been.finish_work();
    let mut newest = 0.0;
    while been.advance(0.1) == Activity::Busy {
        assert!(been.values().number("new") >= newest);
        newest = been.values().number("new");
    }
    assert_eq!(newest, been.timeline().unwrap().last);
    been.set_motion(Motion::Reduced);
    been.press("reset").unwrap();
    been.press("play").unwrap();
    assert_eq!(been.values().number("new"), newest);
}

#[test]
fn in_the_corridor_histograms_are_more_similar_than_contexts() {
    // Among graded pairs of different places, the histogram reports more as the same.
    let been = with(&[("called", 30.0)]);
    assert!(fact(&been, "context_area") > fact(&been, "histogram_area"));
    assert!(fact(&been, "nearby_area") > fact(&been, "histogram_area"));
}

#[test]
fn a_turned_scan_shifts_its_sectors_by_the_turn() {
    // The robot passes the corridor in both directions, so the return path is turned by half a turn.
    let been = with(&[]);
    let turn = fact(&been, "pair_turn_deg");
    assert!(turn.is_finite());
    let scene = been.scene();
    let looks = scene.panels.iter().find(|p| p.id == panel::LOOKS).unwrap();
    assert!(
        looks.title.contains(&format!("{turn:.0}°")),
        "{}",
        looks.title
    );
}

#[test]
fn every_preset_shows_a_lap_with_its_grades() {
    let mut been = PlaceRecognition::default();
    for preset in SPEC.presets {
        been.press(preset.id).unwrap();
        been.finish_work();
        assert!(fact(&been, "same") > 10.0, "{}", preset.id);
        assert_ne!(
            been.outcome().standing,
            Assessment::Neutral,
            "{}",
            preset.id
        );
    }
}

#[test]
fn which_pairs_are_one_place_is_drawn_once_the_reader_acts() {
    let mut been = PlaceRecognition::default();
    been.finish_work();
    let sides = |been: &PlaceRecognition| {
        let dots = panel_of(been, panel::SCORES).layers;
        let of_pairs = dots.iter().filter_map(|layer| match layer {
            Layer::Points { points, tone, .. } if *tone != Tone::Posterior => Some((*tone, points)),
            _ => None,
        });
        let drawn = of_pairs.filter(|(_, points)| !points.is_empty());
        drawn
            .map(|(tone, points)| (tone, points.iter().all(|at| at[1] > 0.0)))
            .collect::<Vec<_>>()
    };
    assert!(sides(&been).iter().all(|side| *side == (Tone::Ink, true)));
    been.reveal();
    assert!(sides(&been).iter().all(|(tone, _)| *tone != Tone::Ink));
    assert!(sides(&been).iter().any(|(_, is_above)| !is_above));
}
