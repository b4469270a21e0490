//! The reader's own flat: drawn by pointer and buttons, stored in links and files, driven.

use ch16_lab::lap::{LapConfig, LapRunner};
use pr_sim::{Course, Sketch};
use widget_kit::host_messages::Delivery;
use widget_kit::model::{Handle, shown_scene};

use super::*;
use crate::w16_2_full_lap::model::plan_element::PlanElement;
use crate::w16_2_full_lap::spec::{EDIT, WORLD};

const REACH: [f64; 2] = [0.15, 0.15];

/// A press at the first position, a drag over the others, and the release.
fn stroke(model: &mut FullLap, places: &[[f64; 2]]) {
    let handle = model
        .grab("map", places[0], REACH)
        .expect("a tool is in the hand");
    for at in places {
        model.drag(handle, *at);
    }
    model.release();
}

fn editing(tool: f64) -> FullLap {
    at(&[("edit", tool)])
}

fn flat(model: &FullLap) -> Sketch {
    Sketch::from_text(&model.values().to_text("flat")).expect("the widget's own text")
}

fn apartment() -> Sketch {
    Sketch::from_course(&Course::apartment())
}

#[test]
fn a_drawn_wall_is_shown_at_once_and_the_lap_follows() {
    let mut model = editing(2.0);
    let before = results(&model);
    stroke(&mut model, &[[4.98, 3.81], [5.0, 4.2], [5.01, 4.12]]);
    // On the grid of 5 cm, before any lap.
    let drawn = flat(&model).walls_cm;
    assert_eq!(drawn.len(), 19);
    assert_eq!(drawn[18], [[500, 380], [500, 410]]);
    assert_eq!(model.values().get(&WORLD), None);
    assert_eq!(model.piece(), Some(PlanElement::Wall(18)));
    let walls = |model: &FullLap| match &model.scene().panels[0].layers[0] {
        Layer::Walls(walls) => walls.len(),
        layer => panic!("{layer:?}"),
    };
    assert_eq!(walls(&model), 19);
    assert_eq!(results(&model), before, "the lap is still the old one");
    model.finish_work();
    assert_ne!(results(&model), before);
    // The lap equals that of the command line with the file of this flat.
    let course = Course::from_json(flat(&model).to_json().as_bytes()).unwrap();
    let config = LapConfig::default().elsewhere(&course);
    let config = config.with_information(LapConfig::default().slam.chapter.information_frame);
    let record = LapRunner::new().run(&config);
    assert_eq!(results(&model).graph, record.lap.summary);
    assert_eq!(model.tick(), record.ticks(), "shown to its end");
}

#[test]
fn strokes_from_one_corner_are_two_walls_with_separate_undo() {
    let mut model = editing(2.0);
    stroke(&mut model, &[[1.0, 1.0], [2.0, 1.0], [2.5, 1.0]]);
    stroke(&mut model, &[[1.0, 1.0], [1.0, 2.0]]);
    assert_eq!(flat(&model).walls_cm.len(), 20);
    press(&mut model, "take-back");
    assert_eq!(flat(&model).walls_cm.len(), 19);
    press(&mut model, "take-back");
    assert_eq!(model.values().number("world"), 0.0, "the Apartment itself");
    assert_eq!(model.values().to_text("flat"), "");
    press(&mut model, "take-back");
    assert_eq!(model.outcome().sentence, "nothing to undo");
    press(&mut model, "do-again");
    press(&mut model, "do-again");
    assert_eq!(flat(&model).walls_cm[19], [[100, 100], [100, 200]]);
}

#[test]
fn a_press_without_a_drag_draws_no_wall_and_explains_how_to() {
    let mut model = editing(2.0);
    stroke(&mut model, &[[1.0, 1.0], [1.01, 1.0]]);
    model.tap("map", [1.0, 1.0], REACH);
    assert_eq!(model.values().number("world"), 0.0);
    assert!(model.outcome().sentence.contains("drag from one end"));
}

#[test]
fn ends_walls_way_points_and_the_start_are_moved_by_the_pointer() {
    let mut model = editing(1.0);
    // The counter in room B, from (4, 1.4) to (6.2, 1.4).
    stroke(&mut model, &[[6.2, 1.4], [5.6, 1.4], [5.52, 1.38]]);
    assert_eq!(flat(&model).walls_cm[14], [[400, 140], [550, 140]]);
    stroke(&mut model, &[[5.0, 1.4], [5.1, 1.7]]);
    assert_eq!(flat(&model).walls_cm[14], [[410, 170], [560, 170]]);
    let [x, y] = PlanElement::Start.place(&apartment());
    stroke(&mut model, &[[x, y], [1.6, 4.4]]);
    assert_eq!(flat(&model).start_cm, [160, 440]);
    let tip = PlanElement::Heading.place(&flat(&model));
    stroke(&mut model, &[tip, [1.6, 5.0]]);
    assert_eq!(flat(&model).heading_deg, 90);
    let way = flat(&model).way_points_cm;
    let [x, y] = PlanElement::WayPoint(0).place(&flat(&model));
    stroke(&mut model, &[[x, y], [x - 1.0, y]]);
    assert_eq!(
        flat(&model).way_points_cm[0][0],
        (way[0][0] - 100 + 2) / 5 * 5
    );
    assert!(
        model.grab("map", [3.0, 7.0], REACH).is_none(),
        "nothing there"
    );
}

/// The tools of the game: each press or drag changes one kind of thing.
#[test]
fn pencil_eraser_robot_and_undo_each_do_only_their_own_thing() {
    let before = apartment();
    // Each over the end of a wall, over its middle, and beside everything.
    for from in [[6.2, 1.4], [5.0, 1.4], [3.0, 7.0]] {
        let to = [from[0] + 0.3, from[1] + 0.25];
        let drawn = |tool: &str| {
            let mut model = at(&[EDIT.to(tool)]);
            if let Some(handle) = model.grab("map", from, REACH) {
                model.drag(handle, from);
                model.drag(handle, to);
            }
            model.release();
            model
        };
        let mut pencil = drawn("wall");
        let after = flat(&pencil);
        assert_eq!(after.walls_cm[..18], before.walls_cm, "{from:?}");
        assert_eq!(after.walls_cm.len(), 19, "{from:?}");
        assert_eq!(after.way_points_cm, before.way_points_cm);
        assert_eq!(after.start_cm, before.start_cm);

        let mut robot = drawn("robot");
        let after = flat(&robot);
        assert_eq!(after.walls_cm, before.walls_cm, "{from:?}");
        assert_eq!(after.way_points_cm, before.way_points_cm);
        let to_cm = to.map(|m: f64| (20.0 * m).round() as i32 * 5);
        assert_eq!(after.start_cm, to_cm, "{from:?}");

        for model in [&mut pencil, &mut robot] {
            press(model, "take-back");
            assert_eq!(model.values().number("world"), 0.0, "{from:?}");
        }

        let mut eraser = drawn("remove");
        assert_eq!(
            eraser.values().number("world"),
            0.0,
            "a drag erases nothing"
        );
        eraser.tap("map", from, REACH);
        let walls = if from[1] < 2.0 { 17 } else { 18 };
        let after =
            Sketch::from_text(&eraser.values().to_text("flat")).unwrap_or_else(|_| apartment());
        assert_eq!(after.walls_cm.len(), walls, "{from:?}");
        assert_eq!(after.way_points_cm, before.way_points_cm);
        assert_eq!(after.start_cm, before.start_cm);
    }
}

#[test]
fn the_robot_tool_drags_a_way_point_and_turns_the_start() {
    let mut model = at(&[EDIT.to("robot")]);
    let [x, y] = PlanElement::WayPoint(0).place(&apartment());
    stroke(&mut model, &[[x, y], [x - 1.0, y]]);
    assert_ne!(flat(&model).way_points_cm[0], apartment().way_points_cm[0]);
    assert_eq!(flat(&model).start_cm, apartment().start_cm);
    let [x, y] = PlanElement::Start.place(&flat(&model));
    let tip = PlanElement::Heading.place(&flat(&model));
    stroke(&mut model, &[tip, [x, y + 1.0]]);
    assert_eq!(flat(&model).heading_deg, 90);
    assert_eq!(flat(&model).walls_cm, apartment().walls_cm);
}

#[test]
fn way_points_are_inserted_after_the_selected_one_and_removed() {
    let mut model = editing(3.0);
    let count = apartment().way_points_cm.len();
    stroke(&mut model, &[[3.0, 4.4], [3.52, 4.4]]);
    assert_eq!(flat(&model).way_points_cm.len(), count + 1);
    assert_eq!(flat(&model).way_points_cm[count], [350, 440], "at the end");
    set(&mut model, "piece-number", 1.0);
    stroke(&mut model, &[[5.0, 4.4], [6.0, 4.4]]);
    assert_eq!(
        flat(&model).way_points_cm[1],
        [600, 440],
        "behind the first"
    );
    set(&mut model, "edit", 4.0);
    model.tap("map", [6.0, 4.4], REACH);
    assert_eq!(flat(&model).way_points_cm.len(), count + 1);
    // A point is hit before a wall under the same pointer.
    model.tap("map", [0.0, 8.0], REACH);
    assert_eq!(flat(&model).walls_cm.len(), 17);
    model.tap("map", PlanElement::Start.place(&flat(&model)), REACH);
    assert!(model.outcome().sentence.contains("start somewhere"));
}

#[test]
fn the_turn_stays_at_its_way_point_while_others_come_and_go() {
    let mut model = editing(3.0);
    let turn = |model: &FullLap| {
        let flat = flat(model);
        flat.turn.map(|turn| flat.way_points_cm[turn])
    };
    let place = apartment().way_points_cm[0];
    for (id, value) in [("piece", 4.0), ("piece-number", 1.0)] {
        set(&mut model, id, value);
    }
    press(&mut model, "add-way-point");
    assert_eq!(turn(&model), Some(place));
    press(&mut model, "turn-here");
    assert_ne!(turn(&model), Some(place));
    press(&mut model, "turn-here");
    assert_eq!(turn(&model), None);
    press(&mut model, "take-back");
    press(&mut model, "remove");
    assert_eq!(turn(&model), None, "it went with its waypoint");
}

#[test]
fn buttons_select_move_and_remove_like_the_pointer() {
    let mut model = editing(1.0);
    press(&mut model, "west");
    assert!(model.outcome().sentence.starts_with("nothing is selected"));
    press(&mut model, "piece-on");
    assert_eq!(model.piece(), Some(PlanElement::Wall(0)));
    press(&mut model, "piece-back");
    assert_eq!(model.piece(), Some(PlanElement::Wall(17)));
    assert!(
        model
            .outcome()
            .sentence
            .starts_with("wall 18 of 18, from (9.6, 7.4) to (10.9, 7.4) m;"),
        "{}",
        model.outcome().sentence
    );
    for button in ["west", "west", "north", "east"] {
        press(&mut model, button);
    }
    assert_eq!(flat(&model).walls_cm[17], [[955, 745], [1085, 745]]);
    set(&mut model, "piece", 3.0);
    press(&mut model, "south");
    assert_eq!(flat(&model).walls_cm[17], [[955, 745], [1085, 740]]);
    press(&mut model, "remove");
    assert_eq!(flat(&model).walls_cm.len(), 17);
    press(&mut model, "add-wall");
    assert_eq!(model.piece(), Some(PlanElement::Wall(17)));
    set(&mut model, "piece", 6.0);
    press(&mut model, "east");
    assert_eq!(flat(&model).heading_deg, 5);
    press(&mut model, "south");
    press(&mut model, "south");
    assert_eq!(flat(&model).heading_deg, 355);
}

#[test]
fn a_flat_that_cannot_be_driven_shows_the_reason_and_no_other_lap() {
    let mut model = editing(2.0);
    stroke(&mut model, &[[5.0, 3.8], [5.0, 5.0]]);
    model.finish_work();
    let outcome = model.outcome();
    assert_eq!(outcome.verdict, "cannot be driven");
    assert_eq!(outcome.standing, Assessment::Bad);
    let sentence = outcome.sentence;
    assert!(
        sentence.contains("the straight line from the start to waypoint 1"),
        "{sentence}"
    );
    assert!(sentence.contains("wall 19"), "{sentence}");
    assert!(model.summary().contains("cannot be driven"));
    let map = |model: &FullLap| model.scene().panels[0].clone();
    let nodes = |model: &FullLap| {
        map(model).layers.iter().any(|layer| {
            matches!(
                layer,
                Layer::Points {
                    tone: Tone::Posterior,
                    ..
                }
            )
        })
    };
    assert!(!nodes(&model));
    // A link opens it with the same result.
    let mut linked = FullLap::default();
    linked
        .set_text("flat", &model.values().to_text("flat"))
        .unwrap();
    linked.finish_work();
    assert_eq!(linked.outcome().verdict, "cannot be driven");
    press(&mut model, "take-back");
    assert!(nodes(&model));
}

#[test]
fn during_a_stroke_the_axes_do_not_move() {
    let mut model = editing(2.0);
    let axes = |model: &FullLap| model.scene().panels[0].bounds();
    let before = axes(&model);
    let handle: Handle = model.grab("map", [11.0, 8.0], REACH).unwrap();
    for at in [[11.0, 8.0], [12.8, 8.0], [12.9, 9.9]] {
        model.drag(handle, at);
        assert_eq!(axes(&model), before);
    }
    model.release();
    assert!(axes(&model).max[0] > before.max[0]);
}

#[test]
fn a_link_contains_the_flat_and_a_damaged_one_changes_no_state() {
    let mut model = editing(2.0);
    stroke(&mut model, &[[1.0, 1.0], [2.0, 1.0]]);
    model.finish_work();
    let text = model.values().to_text("flat");
    let mut other = FullLap::default();
    // In the order of the list, as for a new widget: the world first.
    for (id, text) in [("world", "own"), ("flat", &text)] {
        other.set_text(id, text).unwrap();
    }
    other.finish_work();
    assert_eq!(results(&other), results(&model));
    let before = other.values().clone();
    let cut = &text[..text.len() - 3];
    let error = other.set_text("flat", cut).unwrap_err().to_string();
    assert_eq!(
        error,
        "`flat` is invalid: the flat is damaged or cut off: copy its whole link, or open the file that it was saved as"
    );
    assert!(other.set_text("flat", "100%").is_err());
    assert!(other.set_text("flat", &"A".repeat(40_000)).is_err());
    assert!(other.set("flat", 7.0).is_err());
    assert_eq!(other.values(), &before);
}

#[test]
fn world_and_flat_never_disagree() {
    let mut model = at(&[WORLD.to("own")]);
    assert_eq!(
        flat(&model),
        apartment(),
        "what was shown is what is drawn in"
    );
    model.set_text("flat", "").unwrap();
    assert_eq!(flat(&model), apartment());
    set(&mut model, "world", 2.0);
    assert_eq!(model.values().to_text("flat"), "");
    set(&mut model, "edit", 2.0);
    stroke(&mut model, &[[8.0, 0.4], [8.0, 0.0]]);
    assert_eq!(model.values().get(&WORLD), None);
    assert_eq!(
        flat(&model).walls_cm.len(),
        Sketch::from_course(&Course::twin_rooms()).walls_cm.len() + 1
    );
    press(&mut model, "defaults");
    assert_eq!(model.values().number("world"), 0.0);
    assert_eq!(model.values().to_text("flat"), "");
    assert!(picture(&model) == picture(&FullLap::default()));
    press(&mut model, "take-back");
    let world = model.values().get(&WORLD);
    assert_eq!(world, None, "also that can be taken back");
}

#[test]
fn a_file_is_saved_and_opened_and_an_invalid_one_is_explained() {
    let mut model = editing(2.0);
    stroke(&mut model, &[[1.0, 1.0], [2.0, 1.0]]);
    model.press("save-flat").unwrap();
    model.press("open-flat").unwrap();
    let orders = model.take_requests();
    let json = orders[0].strip_prefix("save-text flat.json\n").unwrap();
    assert_eq!(orders[1], "open-text .json");
    assert!(model.take_requests().is_empty());
    let give = |model: &mut FullLap, text: &str| {
        model.receive(&Delivery {
            kind: "text-file",
            text: "mine.json",
            bytes: text.as_bytes(),
            ..Delivery::default()
        });
        model.finish_work();
    };
    let mut other = FullLap::default();
    give(&mut other, json);
    assert_eq!(flat(&other), flat(&model));
    let before = other.values().clone();
    give(&mut other, &json.replace("[1, 1, 2, 1]", "[1, 1, 200, 1]"));
    let sentence = other.outcome().sentence;
    assert!(
        sentence.starts_with("mine.json cannot be driven: wall 19 is more than 100 m"),
        "{sentence}"
    );
    give(&mut other, "{");
    assert!(other.outcome().sentence.contains("has to be JSON"));
    assert_eq!(other.values(), &before);
}

#[test]
fn the_controls_of_the_flat_are_shown_only_during_editing() {
    let mut model = at(&[("more", 1.0)]);
    assert!(
        !model.disclosure().has_button("add-wall") && model.disclosure().has_button("edit-flat")
    );
    press(&mut model, "edit-flat");
    assert!(model.disclosure().has_button("add-wall") && model.disclosure().has_button("next"));
    set(&mut model, "more", 0.0);
    // Few tools, and the map alone.
    let disclosure = model.disclosure();
    assert!(disclosure.has_button("take-back") && disclosure.has_param("edit"));
    assert!(!disclosure.has_button("add-wall") && !disclosure.has_button("next"));
    let panels = shown_scene(&model).panels;
    assert_eq!(
        panels.iter().map(|shown| shown.id).collect::<Vec<_>>(),
        ["map"]
    );
    press(&mut model, "edit-flat");
    assert!(!model.disclosure().has_button("add-wall"));
    for (_, button) in model.keys() {
        assert!(SPEC.buttons.iter().any(|it| it.id == *button), "{button}");
    }
}

#[test]
fn the_button_that_edits_is_pressed_while_the_flat_is_edited() {
    let mut model = at(&[]);
    for is_pressed in [false, true, false] {
        assert_eq!(model.is_pressed("edit-flat"), is_pressed);
        press(&mut model, "edit-flat");
    }
}
