//! The moving box without its picture.

use widget_kit::model::{Activity, Model};
use widget_kit::scene::{Layer, Stroke, Tone};
use widgets::w16_8_moving_box::model::{MovingBox, panel};
use widgets::w16_8_moving_box::spec::SPEC;

use crate::support::{fact, panel_of};

fn with(values: &[(&str, f64)]) -> MovingBox {
    let mut moving = MovingBox::default();
    for (id, value) in values {
        moving.set(id, *value).unwrap();
    }
    moving
}

fn errors(moving: &MovingBox) -> [f64; 3] {
    ["plain_error_m", "trimmed_error_m", "huber_error_m"].map(|id| fact(moving, id))
}

#[test]
fn without_a_box_all_three_succeed() {
    let moving = with(&[("share", 0.0)]);
    assert_eq!(moving.outcome().verdict, "all three are home");
}

#[test]
fn a_fifth_of_the_points_biases_plain_and_hardly_the_others() {
    let [plain, trimmed, huber] = errors(&with(&[("share", 20.0)]));
    assert!(trimmed < 0.5 * plain && huber < 0.5 * plain);
    assert!(plain > 0.02, "{plain}");
}

#[test]
fn a_short_tau_does_the_work_of_trimming() {
    let [far, ..] = errors(&with(&[("share", 20.0)]));
    let [near, ..] = errors(&with(&[("share", 20.0), ("tau", 0.2)]));
    assert!(near < 0.5 * far, "{near} and {far}");
}

#[test]
fn a_box_that_did_not_move_causes_no_bias() {
    for error in errors(&with(&[("share", 40.0), ("moved", 0.0)])) {
        assert!(error < 0.02, "{error}");
    }
}

#[test]
fn the_curves_fill_in_seed_by_seed_and_end() {
    let mut moving = MovingBox::default();
    assert!(fact(&moving, "plain_bias_m").is_nan());
    let mut pieces = 0;
    while moving.work().is_busy() {
        pieces += 1;
    }
    // Seven shares of a hundred seeds: two sweeps and three registrations each.
    assert_eq!(pieces, 4 * 700);
    assert!(fact(&moving, "plain_bias_m") > fact(&moving, "trimmed_bias_m"));
    let scene = moving.scene();
    let bias = scene.panels.iter().find(|p| p.id == panel::BIAS).unwrap();
    assert!(bias.title.ends_with("over 100 seeds"), "{}", bias.title);
    // Neither the share nor the seed above restarts them; τ does.
    moving.set("share", 45.0).unwrap();
    moving.set("seed", 7.0).unwrap();
    assert_eq!(moving.work(), Activity::Idle);
    moving.set("tau", 0.5).unwrap();
    assert_eq!(moving.work(), Activity::Busy);
}

#[test]
fn the_share_is_dragged_along_the_curves() {
    let mut moving = MovingBox::default();
    let handle = moving.grab(panel::BIAS, [20.5, 1.0], [1.0, 1.0]).unwrap();
    moving.drag(handle, [40.6, 3.0]);
    assert_eq!(moving.values().number("share"), 40.0);
    moving.drag(handle, [f64::NAN, 0.0]);
    assert_eq!(moving.values().number("share"), 40.0);
    moving.drag(handle, [1e300, 0.0]);
    assert_eq!(moving.values().number("share"), 60.0);
    assert!(moving.grab(panel::BIAS, [20.0, 1.0], [1.0, 1.0]).is_none());
    assert!(moving.grab(panel::ROOM, [60.0, 1.0], [1.0, 1.0]).is_none());
}

#[test]
fn every_preset_does_what_its_button_claims() {
    let after = |id: &str| {
        let mut moving = MovingBox::default();
        moving.press(id).unwrap();
        moving
    };
    let fifth = errors(&after("fifth"));
    assert!(fifth[1] < 0.5 * fifth[0] && fifth[2] < 0.5 * fifth[0]);
    let most = errors(&after("most"));
    assert!(most[0] > fifth[0] && most[2] > fifth[2]);
    assert!(errors(&after("none")).iter().all(|error| *error < 0.02));
    let gate = errors(&after("gate"));
    assert!(gate[0] < 2.0 * gate[2].max(0.01));
    assert!(after("fifth").timeline().unwrap().last > 2.0);
    assert_eq!(SPEC.presets.len(), 4, "a preset without a test");
}

#[test]
fn the_box_is_dragged_in_the_room() {
    let mut moving = MovingBox::default();
    let middle = panel_of(&moving, panel::ROOM)
        .layers
        .iter()
        .find_map(|layer| match layer {
            Layer::Handle { at, .. } => Some(*at),
            _ => None,
        });
    let [x, y] = middle.expect("a handle on the box");
    let held = moving
        .grab(panel::ROOM, [x + 0.05, y], [0.05, 0.05])
        .unwrap();
    moving.drag(held, [x + 0.25, y + 0.3]);
    assert!((moving.values().number("moved") - 0.5).abs() < 1e-9);
    moving.drag(held, [f64::NAN, y]);
    moving.drag(held, [x + 9.0, y]);
    assert_eq!(moving.values().number("moved"), 0.8);
    moving.drag(held, [x - 9.0, y]);
    assert_eq!(moving.values().number("moved"), 0.0);
    let far = moving.grab(panel::ROOM, [-2.0, -2.0], [0.05, 0.05]);
    assert!(far.is_none());
}

/// The drawn lengths of the pulls on the box and of those on the walls, m.
fn pulls(moving: &MovingBox) -> [Vec<f64>; 2] {
    let layers = panel_of(moving, panel::ROOM).layers;
    let arrows = layers.iter().filter_map(|layer| match layer {
        Layer::Line {
            points,
            stroke: Stroke::Solid,
            tone: Tone::Series(k),
            ..
        } => Some((*k == 3, points)),
        _ => None,
    });
    let mut lengths = [Vec::new(), Vec::new()];
    for (on_box, points) in arrows {
        let of = |arrow: &[[f64; 2]]| {
            let [from, to] = [arrow[0], arrow[1]];
            (to[0] - from[0]).hypot(to[1] - from[1])
        };
        lengths[usize::from(!on_box)].extend(points.chunks(7).map(of));
    }
    lengths
}

#[test]
fn each_method_weighs_the_pulls_of_the_box_in_its_own_way() {
    let longest = |moving: &MovingBox| pulls(moving)[0].iter().copied().fold(0.0, f64::max);
    let [plain, trimmed, huber] = [0.0, 1.0, 2.0].map(|method| with(&[("method", method)]));
    // 180 points; the walls between them have pairs within τ.
    assert!(pulls(&plain).concat().len() > 150);
    assert!(pulls(&trimmed)[0].len() < pulls(&plain)[0].len());
    assert!(longest(&plain) > 1.0, "{}", longest(&plain));
    // Huber's width of 0.05 m, tenfold.
    assert!((longest(&huber) - 0.5).abs() < 1e-9, "{}", longest(&huber));
    let title = panel_of(&huber, panel::ROOM).title;
    assert!(
        title.starts_with("Huber: ") && title.contains("tenfold"),
        "{title}"
    );
}
