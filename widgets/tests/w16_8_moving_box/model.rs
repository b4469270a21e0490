//! The moving box without its picture.

use widget_kit::model::{Activity, Model};
use widget_kit::palette::Theme;
use widget_kit::scene::{Layer, Scene, Stroke, Tone};
use widget_kit::svg::{scene_places, scene_svg};
use widgets::w16_8_moving_box::model::{MovingBox, panel};
use widgets::w16_8_moving_box::spec::{MAX_ITERATIONS, SPEC};

use crate::support::{fact, panel_of};

fn with(values: &[(&str, f64)]) -> MovingBox {
    let mut moving = MovingBox::default();
    moving.set("iteration", MAX_ITERATIONS).unwrap();
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
fn trimming_without_a_dropped_pair_is_plain() {
    let [plain, trimmed, _] = errors(&with(&[("share", 20.0), ("dropped", 0.0)]));
    assert_eq!(trimmed, plain);
}

#[test]
fn a_huber_width_beyond_the_move_of_the_box_pulls_like_plain() {
    let [plain, _, wide] = errors(&with(&[("share", 20.0), ("huber", 0.3)]));
    let [_, _, narrow] = errors(&with(&[("share", 20.0), ("huber", 0.01)]));
    assert!(
        wide > 0.8 * plain && narrow < 0.5 * wide,
        "{narrow}, {wide}, {plain}"
    );
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
    assert!(bias.title.ends_with("over 100 trials"), "{}", bias.title);
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
    let moved = |moving: &MovingBox| ["moved", "moved-y"].map(|id| moving.values().number(id));
    moving.drag(held, [x + 0.25, y - 0.3]);
    let [along, across] = moved(&moving);
    assert!((along - 0.5).abs() < 1e-9 && (across + 0.3).abs() < 1e-9);
    moving.drag(held, [f64::NAN, y]);
    moving.drag(held, [x + 9.0, y - 9.0]);
    assert_eq!(moved(&moving), [0.8, -1.2]);
    moving.drag(held, [x - 9.0, y + 9.0]);
    assert_eq!(moved(&moving), [0.0, 0.5]);
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
    let larger = |moving: &MovingBox| {
        let title = panel_of(moving, panel::ROOM).title;
        let (_, from) = title.split_once("pairs ×").unwrap();
        from[..1].parse::<f64>().unwrap()
    };
    // 1e-9: Huber's width of 0.05 m.
    assert!((longest(&huber) - 0.05 * larger(&huber)).abs() < 1e-9);
    // The box moved by three decimetres; the nearest point of its old outline is a decimetre away.
    assert!(longest(&plain) > 0.1 * larger(&plain));
}

#[test]
fn no_pull_leaves_the_picture_wherever_the_box_is() {
    for moved in [0.0, 0.3, 0.8] {
        for moved_y in [-1.2, -0.4, 0.5] {
            for tau in [0.7, 1.6] {
                let moving = with(&[("moved", moved), ("moved-y", moved_y), ("tau", tau)]);
                let room = panel_of(&moving, panel::ROOM);
                for layer in &room.layers {
                    let Layer::Line {
                        points,
                        tone: Tone::Series(_),
                        ..
                    } = layer
                    else {
                        continue;
                    };
                    let is_inside = |at: &[f64; 2]| {
                        at[0].is_nan()
                            || ((room.x.min..=room.x.max).contains(&at[0])
                                && (room.y.min..=room.y.max).contains(&at[1]))
                    };
                    assert!(points.iter().all(is_inside), "{moved}, {moved_y}, τ {tau}");
                }
            }
        }
    }
}

#[test]
fn where_the_methods_end_is_drawn_once_the_box_is_dragged_or_a_step_is_made() {
    let answers = |moving: &MovingBox| {
        let panels = moving.scene().panels;
        let layers = panels.iter().flat_map(|panel| &panel.layers);
        let of_methods = layers.filter(|layer| {
            matches!(
                layer,
                Layer::Line {
                    tone: Tone::Series(_),
                    ..
                } | Layer::Points {
                    tone: Tone::Series(_),
                    ..
                }
            )
        });
        of_methods.count()
    };
    let mut stepped = MovingBox::default();
    stepped.work();
    assert_eq!(answers(&stepped), 0);
    stepped.press("step").unwrap();
    assert!(answers(&stepped) > 5);
    let mut dragged = MovingBox::default();
    let handle = dragged.grab(panel::BIAS, [20.0, 1.0], [1.0, 1.0]).unwrap();
    dragged.drag(handle, [30.0, 1.0]);
    assert!(answers(&dragged) > 5);
}

/// Positions of the methods and of their names on the room's picture at the width of a phone's panel, px.
fn methods_and_names(moving: &MovingBox) -> Vec<([f32; 2], [f32; 2])> {
    const WIDTH_PX: f32 = 342.0;
    let room = panel_of(moving, panel::ROOM);
    let labels = room.layers.iter().filter_map(|layer| match layer {
        Layer::Label { at, text, .. } => Some((*at, text.clone())),
        _ => None,
    });
    let (points, names): (Vec<_>, Vec<_>) =
        labels.map(|(at, name)| ((panel::ROOM, at), name)).unzip();
    let scene = Scene { panels: vec![room] };
    let places = scene_places(&scene, WIDTH_PX, &points);
    let svg = scene_svg(&scene, "", "", WIDTH_PX, Theme::Light);
    let written = |name: &String| {
        let (before, _) = svg.rsplit_once(&format!(">{name}</text>"))?;
        let (_, element) = before.rsplit_once("<text ")?;
        let number = |attribute: &str| {
            let (_, rest) = element.split_once(attribute)?;
            rest.split('"').next()?.parse::<f32>().ok()
        };
        Some([number("x=\"")?, number("y=\"")?])
    };
    let pairs = places.into_iter().zip(&names);
    pairs
        .filter_map(|(place, name)| Some((place, written(name)?)))
        .collect()
}

#[test]
fn the_name_of_a_method_stands_nearest_to_its_own_mark() {
    let mut named = 0;
    for share in [10.0, 20.0, 30.0, 40.0, 50.0] {
        for moved_y in [-0.6, 0.0, 0.3] {
            let shown = methods_and_names(&with(&[("share", share), ("moved-y", moved_y)]));
            let (marks, names): (Vec<_>, Vec<_>) = shown.into_iter().unzip();
            for (own, [x, y]) in names.into_iter().enumerate() {
                // From a line of text, half as wide as Huber's name at 14 px.
                let away = |[left, top]: [f32; 2]| {
                    let aside = ((left - x).abs() - 20.0).max(0.0);
                    aside.hypot((top - y).abs())
                };
                let nearest = marks
                    .iter()
                    .map(|mark| away(*mark))
                    .fold(f32::MAX, f32::min);
                // 3 px: marks that touch. 51 px, three lines of text: a name with its leader is still beside its mark.
                let is_own = away(marks[own]) <= nearest + 3.0 && away(marks[own]) < 51.0;
                assert!(
                    is_own,
                    "{own} at {share} %, {moved_y} m: {marks:?}, {x}, {y}"
                );
                named += 1;
            }
        }
    }
    assert!(named > 30, "{named}");
}
