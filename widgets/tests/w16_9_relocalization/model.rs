//! The localization without its picture.

use ch16_lab::lap::{BuiltInWorld, NamedChoice};
use widget_kit::model::{Activity, Assessment, Model, Motion};
use widget_kit::param::ParamKind;
use widget_kit::scene::{Layer, Tone};
use widgets::w16_9_relocalization::model::{Relocalization, panel};
use widgets::w16_9_relocalization::spec::SPEC;

use crate::support::{fact, panel_of};

/// The outcome as text, in which equal NaN are equal.
fn state_text(back: &Relocalization) -> String {
    format!("{:?}", back.outcome())
}

fn pressed(id: &str) -> Relocalization {
    let mut back = Relocalization::default();
    back.press(id).unwrap();
    back.finish_work();
    back.set("moment", 4000.0).unwrap();
    back
}

#[test]
fn on_the_driven_path_one_scan_is_enough_and_the_others_are_tracked() {
    let back = pressed("corridor");
    assert_eq!(back.outcome().verdict, "found");
    assert_eq!(fact(&back, "scans"), 1.0);
    // 0.3: the map of one lap has an error of 0.1 m.
    assert!(fact(&back, "found_error_m") < 0.3);
    assert!(fact(&back, "end_error_m") < 0.3);
    // The search rejects poses by bounds.
    assert!(fact(&back, "window") > 100.0 * fact(&back, "scored"));
}

#[test]
fn in_an_unmapped_room_no_pose_is_reported_before_the_door() {
    let back = pressed("room");
    assert!(fact(&back, "scans") > 10.0, "{:?}", back.outcome());
    assert_eq!(back.outcome().standing, Assessment::Good);
}

#[test]
fn in_one_of_two_equal_rooms_no_pose_is_reported() {
    let back = pressed("twins");
    let scans = fact(&back, "scans");
    assert!(scans.is_nan() || scans > 5.0, "{:?}", back.outcome());
    assert_ne!(back.outcome().standing, Assessment::Bad);
}

#[test]
fn another_lap_removes_the_wardrobe_from_its_old_position() {
    let mut back = Relocalization::default();
    back.finish_work();
    assert!(fact(&back, "wardrobe_points") > 20.0);
    back.press("forget").unwrap();
    back.finish_work();
    back.set("moment", 4000.0).unwrap();
    assert_eq!(fact(&back, "wardrobe_points"), 0.0);
    assert_eq!(back.outcome().verdict, "found");
}

#[test]
fn the_options_are_worlds_of_the_core_in_their_order() {
    let world = SPEC.params.iter().find(|param| param.id == "world");
    let ParamKind::Choice { options } = world.unwrap().kind else {
        panic!("a choice");
    };
    for (option, world) in options.iter().zip(BuiltInWorld::all()) {
        assert_eq!((option.id, option.label), (world.name(), world.label()));
    }
}

#[test]
fn everything_is_computed_in_pieces() {
    let mut pieces = Relocalization::default();
    assert_eq!(pieces.outcome().verdict, "a lap is driven");
    let mut count = 0;
    while pieces.work().is_busy() {
        count += 1;
    }
    // The ticks of the lap, driven and mapped, and those of the run.
    assert!(count > 300, "{count} pieces");
    assert!(!pieces.finish_work());
    let mut whole = Relocalization::default();
    whole.finish_work();
    assert_eq!(state_text(&pieces), state_text(&whole));
}

#[test]
fn the_robot_is_put_and_turned_on_the_map_and_the_map_stays() {
    let mut back = Relocalization::default();
    back.finish_work();
    let keyframes = fact(&back, "keyframes");
    let (x, y) = (back.values().number("x"), back.values().number("y"));
    let place = back.grab(panel::MAP, [x, y], [0.1, 0.1]).unwrap();
    back.drag(place, [9.33, 6.08]);
    assert_eq!(
        (back.values().number("x"), back.values().number("y")),
        (9.3, 6.1)
    );
    let heading = back.values().number("heading").to_radians();
    let tip = [9.3 + heading.cos(), 6.1 + heading.sin()];
    let turn = back.grab(panel::MAP, tip, [0.1, 0.1]).unwrap();
    back.drag(turn, [9.3, 9.0]);
    assert_eq!(back.values().number("heading"), 90.0);
    let mut pieces = 0;
    while back.work().is_busy() {
        pieces += 1;
    }
    // The lap is not driven again.
    assert!(pieces > 40);
    assert_eq!(fact(&back, "keyframes"), keyframes);
    for nowhere in [[f64::NAN, 3.0], [f64::INFINITY, 0.0]] {
        back.drag(place, nowhere);
    }
    assert_eq!(back.values().number("x"), 9.3);
    back.drag(place, [-1e300, 1e300]);
    assert_eq!(
        (back.values().number("x"), back.values().number("y")),
        (0.0, 9.0)
    );
    assert!(back.grab(panel::SCORES, [0.0, 0.0], [9.0, 9.0]).is_none());
}

#[test]
fn playing_goes_through_the_boxes_and_the_scans_to_the_end() {
    let mut back = Relocalization::default();
    back.press("room").unwrap();
    assert_eq!(back.advance(0.1), Activity::Busy, "it is not there yet");
    back.finish_work();
    let mut at = 0.0;
    let mut waited = 0;
    while back.advance(0.1) == Activity::Busy {
        assert!(back.values().number("moment") >= at);
        at = back.values().number("moment");
        waited += usize::from(back.scene().panels[0].title.contains("searching"));
    }
    assert!(waited > 0);
    assert_eq!(at, back.timeline().unwrap().last);
    back.set_motion(Motion::Reduced);
    back.press("reset").unwrap();
    back.press("play").unwrap();
    assert_eq!(back.values().number("moment"), at);
}

#[test]
fn the_two_rooms_that_fit_are_asked_about_until_one_is_left() {
    let mut back = Relocalization::default();
    back.finish_work();
    let asked = |back: &Relocalization| {
        let layers = panel_of(back, panel::MAP).layers;
        let places = layers.into_iter().filter_map(|layer| match layer {
            Layer::Label { at, text, .. } if text.ends_with("here?") => Some(at),
            _ => None,
        });
        places.collect::<Vec<_>>()
    };
    let last = back.timeline().unwrap().last;
    let doubtful = (0..).map(f64::from).take_while(|moment| *moment < last);
    let two = doubtful.clone().find_map(|moment| {
        back.set("moment", moment).unwrap();
        let places = asked(&back);
        (places.len() == 2).then_some(places)
    });
    let [one, other] = two.expect("the first scan fits twice")[..] else {
        panic!("two places");
    };
    // Its own room, and the one at the other end of the flat.
    assert!((one[0] - other[0]).abs() > 5.0, "{one:?} {other:?}");
    back.set("moment", last).unwrap();
    assert_eq!(asked(&back), Vec::<[f64; 2]>::new());
}

#[test]
fn every_ring_is_drawn_within_the_walls_and_the_legend_is_short() {
    let mut back = Relocalization::default();
    back.finish_work();
    for moment in 0..6 {
        back.set("moment", f64::from(moment)).unwrap();
        let map = panel_of(&back, panel::MAP);
        assert!(map.legend.len() <= 3, "{:?}", map.legend);
        for layer in map.layers {
            let Layer::Points {
                points,
                tone: Tone::Series(0),
                ..
            } = layer
            else {
                continue;
            };
            // The Apartment is 12 m by 9 m.
            let inside = |[x, y]: &[f64; 2]| (0.0..=12.0).contains(x) && (0.0..=9.0).contains(y);
            assert!(points.iter().all(inside), "{points:?}");
        }
    }
}

#[test]
fn it_opens_before_the_search_and_the_rings_collapse_onto_the_right_place() {
    let mut back = Relocalization::default();
    back.finish_work();
    assert_eq!(back.values().number("moment"), 0.0);
    assert_eq!(back.outcome().verdict, "where am I?");
    let rings = |back: &Relocalization| {
        let layers = panel_of(back, panel::MAP).layers;
        let here = layers.iter().filter_map(|layer| match layer {
            Layer::Points {
                points,
                tone: Tone::Series(0),
                ..
            } => Some(points.len()),
            _ => None,
        });
        here.sum::<usize>()
    };
    assert!(rings(&back) > 6, "{}", rings(&back));
    back.set("moment", 4000.0).unwrap();
    assert_eq!(rings(&back), 0);
    assert_eq!(back.outcome().verdict, "found");
}
