//! The control room without a display, against the library's laps.

use ch16_lab::lap::{LapConfig, LapRunner};
use widget_kit::model::{Activity, Assessment, Model as _, Motion, TimelineMark};
use widget_kit::scene::{Layer, Mark, Panel, Tone};
use widgets::w16_4_control_room::model::ControlRoom;
use widgets::w16_4_control_room::spec::SPEC;

use crate::support::fact;

fn set(room: &mut ControlRoom, id: &str, value: f64) {
    room.set(id, value).unwrap();
    room.finish_work();
}

fn press(room: &mut ControlRoom, id: &str) {
    room.press(id).unwrap();
    room.finish_work();
}

fn revision(room: &ControlRoom) -> u64 {
    let scene = room.scene();
    let grid = scene.panels[0].layers.iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.revision),
        _ => None,
    });
    grid.expect("the map has a grid")
}

#[test]
fn the_end_of_a_run_has_the_grid_the_loops_and_the_errors_of_the_librarys_lap() {
    let mut room = ControlRoom::default();
    for (seed, noise, loops) in [(0xC0_FFEE, 1.0, true), (6, 2.0, true), (3, 1.0, false)] {
        let config = LapConfig::with_seed_and_noise(seed, noise);
        let config = if loops {
            config
        } else {
            config.without_loops()
        };
        let run = LapRunner::new().run(&config);
        set(&mut room, "seed", f64::from(seed));
        set(&mut room, "noise", noise);
        set(&mut room, "loops", f64::from(u8::from(loops)));
        set(&mut room, "t", run.ticks() as f64);
        let (grid, summary) = (run.occupancy_grid(run.ticks()), run.lap.summary);
        for (id, expected) in [
            ("keyframes", summary.keyframes as f64),
            ("occupied_cells", grid.occupied_cells() as f64),
            ("free_cells", grid.free_cells() as f64),
            ("odometry_error_m", summary.odometry_end_error_m),
            ("map_disagreement_m", summary.map_disagreement_m.unwrap()),
        ] {
            assert_eq!(fact(&room, id), expected, "{id}");
        }
        let marks = room.timeline().unwrap().marks;
        let is_judged = |mark: &TimelineMark| mark.standing != Assessment::Neutral;
        let judged: Vec<bool> = marks.iter().map(is_judged).collect();
        let attempts = run.lap.loop_attempts();
        assert_eq!(
            judged,
            attempts
                .map(|attempt| attempt.accepted())
                .collect::<Vec<_>>()
        );
    }
}

#[test]
fn the_grid_is_drawn_again_when_a_loop_moves_its_keyframes() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 91.0);
    let before = fact(&room, "occupied_cells");
    assert_eq!(fact(&room, "loops"), 0.0);
    press(&mut room, "step");
    assert_eq!(fact(&room, "loops"), 1.0);
    assert_ne!(fact(&room, "occupied_cells"), before);
    assert!(
        room.outcome().sentence.starts_with(
            "loop 29 to 7 accepted, chi-squared 4.24 below 7.815, history moved 0.24 m"
        ),
        "{}",
        room.outcome().sentence
    );
}

#[test]
fn a_tick_without_a_keyframe_uploads_no_new_texture() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 0.0);
    let first = revision(&room);
    press(&mut room, "step");
    assert_eq!(revision(&room), first);
    set(&mut room, "t", 20.0);
    assert_ne!(revision(&room), first);
}

#[test]
fn scrubbing_back_shows_what_playing_showed() {
    let mut played = ControlRoom::default();
    played.set("t", 0.0).unwrap();
    played.press("play").unwrap();
    while played.values().number("t") < 96.0 {
        assert_eq!(played.advance(0.125), Activity::Busy);
    }
    played.press("play").unwrap();
    assert_eq!(played.advance(0.125), Activity::Idle);
    let mut scrubbed = ControlRoom::default();
    scrubbed.set("t", 129.0).unwrap();
    scrubbed.set("t", played.values().number("t")).unwrap();
    assert_eq!(played.outcome(), scrubbed.outcome());
    assert_eq!(played.summary(), scrubbed.summary());
}

#[test]
fn the_line_at_the_moment_shown_can_be_dragged_in_every_plot_over_time() {
    let mut room = ControlRoom::default();
    room.set("t", 60.0).unwrap();
    for panel in &room.scene().panels {
        let grabbed = room.grab(panel.id, [61.0, 0.1], [3.0, 0.1]);
        assert_eq!(grabbed.is_some(), panel.x.label == "tick", "{}", panel.id);
    }
    // Grabbed one tick off the line: it does not jump by that tick.
    let line = room.grab("tau", [61.0, 0.1], [3.0, 0.1]).unwrap();
    for (to, tick) in [(71.0, 70.0), (-40.0, 0.0), (500.0, 129.0)] {
        room.drag(line, [to, 0.0]);
        assert_eq!(room.values().number("t"), tick);
    }
}

#[test]
fn the_start_shows_the_first_sweep_where_nothing_is_off_yet() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 0.0);
    assert_eq!(fact(&room, "estimate_error_m"), 0.0);
    assert_eq!(fact(&room, "odometry_error_m"), 0.0);
    assert!(fact(&room, "pairs").is_nan(), "nothing was registered");
    let scene = room.scene();
    let sweep = scene.panels[1].layers.iter().any(|layer| {
        matches!(layer, Layer::Points { points, tone: Tone::Measurement, .. } if points.len() > 50)
    });
    assert!(sweep);
}

#[test]
fn changing_the_run_keeps_the_moment() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 87.0);
    let before = room.outcome();
    set(&mut room, "noise", 4.0);
    assert_eq!(room.values().number("t"), 87.0);
    assert_ne!(room.outcome(), before);
    press(&mut room, "defaults");
    set(&mut room, "t", 87.0);
    assert_eq!(room.outcome(), before);
}

#[test]
fn a_setting_runs_in_pieces_of_a_tick_and_the_old_run_stays_until_the_new_one_is_finished() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 92.0);
    let before = room.outcome();
    for noise in [2.0, 3.0, 4.0] {
        room.set("noise", noise).unwrap();
    }
    let mut pieces = 0;
    while room.work().is_busy() {
        pieces += 1;
        if pieces < 129 {
            assert_eq!(room.outcome(), before, "piece {pieces}");
        }
    }
    // One lap and its front end alone, of 129 ticks each, and two ends: of three values only one is run.
    assert!((129..=260).contains(&pieces), "{pieces} pieces");
    let mut at_once = ControlRoom::default();
    set(&mut at_once, "t", 92.0);
    set(&mut at_once, "noise", 4.0);
    assert_eq!(room.outcome(), at_once.outcome());
    assert_ne!(room.outcome(), before);
}

#[test]
fn the_next_event_belongs_to_the_requested_run() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 60.0);
    room.set("seed", 6.0).unwrap();
    room.press("next-event").unwrap();
    assert_eq!(room.values().number("t"), 60.0);
    room.finish_work();
    let mut at_once = ControlRoom::default();
    set(&mut at_once, "t", 60.0);
    set(&mut at_once, "seed", 6.0);
    press(&mut at_once, "next-event");
    assert_eq!(room.values().number("t"), at_once.values().number("t"));
}

#[test]
fn the_transport_steps_resets_and_restores() {
    let mut room = ControlRoom::default();
    set(&mut room, "noise", 2.0);
    for (button, tick) in [("step", 92.0), ("reset", 0.0), ("defaults", 91.0)] {
        press(&mut room, button);
        assert_eq!(room.values().number("t"), tick, "{button}");
    }
    // At the default tick the map has no disagreement yet: NaN, which does not equal itself.
    let mut fresh = ControlRoom::default();
    for widget in [&mut room, &mut fresh] {
        widget.set("t", 87.0).unwrap();
    }
    assert_eq!(room.outcome(), fresh.outcome());
    let rejected = room.press("plya").unwrap_err().to_string();
    assert!(rejected.contains("next-event"), "{rejected}");
}

#[test]
fn every_lap_ends_where_the_timeline_does() {
    let mut room = ControlRoom::default();
    let spec = SPEC.params.iter().find(|spec| spec.id == "t").unwrap();
    let (_, last) = spec.range();
    for (seed, noise) in [(0.0, 0.25), (6.0, 2.0), (4_294_967_295.0, 4.0)] {
        set(&mut room, "seed", seed);
        set(&mut room, "noise", noise);
        assert_eq!(room.timeline().unwrap().last, last, "seed {seed}");
        set(&mut room, "t", last);
        assert_eq!(room.outcome().verdict, "run finished");
    }
}

/// The marks of the parts in their order.
fn marks(room: &ControlRoom) -> Vec<(Tone, Mark)> {
    let layers = parts(room).layers.into_iter();
    let marks = layers.filter_map(|layer| match layer {
        Layer::Points { tone, mark, .. } => Some((tone, mark)),
        _ => None,
    });
    marks.collect()
}

/// The parts whose mark is filled.
fn at_work(room: &ControlRoom) -> Vec<usize> {
    let marks = marks(room).into_iter().enumerate();
    let filled = marks.filter(|(_, (_, mark))| *mark == Mark::Dot);
    filled.map(|(part, _)| part).collect()
}

#[test]
fn a_part_is_filled_in_the_ticks_in_which_it_works() {
    let mut room = ControlRoom::default();
    for (tick, working) in [
        (0.0, vec![]),
        (91.0, vec![0, 1]),
        (92.0, (0..8).collect::<Vec<_>>()),
    ] {
        set(&mut room, "t", tick);
        assert_eq!(at_work(&room), working, "tick {tick}");
    }
    // Seed 6: at tick 90 a candidate passes the gate and fails the fit.
    set(&mut room, "seed", 6.0);
    set(&mut room, "t", 90.0);
    assert_eq!(at_work(&room), [0, 1, 2, 3, 5]);
    assert_eq!(marks(&room)[4].0, Tone::Series(3));
}

#[test]
fn each_part_counts_the_ticks_in_which_it_worked() {
    let mut room = ControlRoom::default();
    // After the run, with three loops in the lap, the back end rests.
    set(&mut room, "t", 129.0);
    assert_eq!(at_work(&room), [0, 1]);
    let counts = parts(&room)
        .layers
        .into_iter()
        .filter_map(|layer| match layer {
            Layer::Text { text, .. } if text.starts_with('×') => Some(text),
            _ => None,
        });
    assert_eq!(
        counts.collect::<Vec<_>>(),
        ["×129", "×129", "×40", "×3", "×3", "×3", "×3", "×3"]
    );
}

fn parts(room: &ControlRoom) -> Panel {
    let panels = room.scene().panels;
    panels
        .into_iter()
        .find(|panel| panel.id == "parts")
        .expect("the parts")
}

/// Every part, and words of its data in the tick of the first loop.
const SENTENCES: [(&str, &str); 8] = [
    ("predict", "Predict: robot at ("),
    ("register", " pairs within τ = "),
    ("keyframe", "Keyframe: node 29 and an edge to node 28."),
    ("candidate", "Candidate: node 29 to node 7, "),
    ("fit", "Fit: "),
    ("gate", "Gate: chi-squared 4.24 below 7.815."),
    ("optimize", "nodes moved by up to 0.24 m."),
    (
        "repaint",
        "Repaint: the grid from the sweeps of 30 keyframes.",
    ),
];

#[test]
fn a_press_on_a_part_shows_its_data_at_this_tick() {
    let mut pressed = ControlRoom::default();
    set(&mut pressed, "t", 92.0);
    for (part, (name, expected)) in SENTENCES.into_iter().enumerate() {
        let spot = [part as f64 + 0.7, 0.1];
        let handle = pressed.grab("parts", spot, [0.1, 0.1]).expect(name);
        pressed.drag(handle, spot);
        assert_eq!(pressed.values().number("t"), 92.0, "{name}");
        assert_eq!(pressed.values().number("lane"), part as f64, "{name}");
        let sentence = pressed.outcome().sentence;
        assert!(sentence.starts_with("loop 29 to 7 accepted"), "{sentence}");
        assert!(sentence.contains(expected), "{name}: {sentence}");
        // By keyboard: the part and the tick are controls.
        let mut chosen = ControlRoom::default();
        set(&mut chosen, "lane", part as f64);
        set(&mut chosen, "t", 92.0);
        assert_eq!(chosen.outcome(), pressed.outcome());
        assert!(
            parts(&chosen) == parts(&pressed),
            "{name}: with the same line under its name"
        );
        let tables = chosen.shown_tables();
        let tick = tables.iter().find(|table| table.id == "control-room-tick");
        let row = &tick.expect("the tick's table").rows[part];
        assert_eq!(row[0], name);
        assert!(sentence.contains(&row[1]), "{row:?}");
    }
    assert!(pressed.grab("parts", [8.5, 0.5], [0.1, 0.1]).is_none());
    // A part that does not work in the tick says so.
    set(&mut pressed, "t", 91.0);
    let sentence = pressed.outcome().sentence;
    assert!(sentence.ends_with("Repaint: nothing to do."), "{sentence}");
}

/// The cells of the grid.
fn cells(room: &ControlRoom) -> Vec<widget_kit::scene::RasterCell> {
    let layers = &room.scene().panels[0].layers;
    let rasters = layers.iter().filter_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.cells.to_vec()),
        _ => None,
    });
    rasters.flatten().collect()
}

/// A playback that has just reached the first loop.
fn at_the_first_loop() -> ControlRoom {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 91.0);
    press(&mut room, "play");
    while room.values().number("t") < 92.0 {
        room.advance(0.02);
    }
    room
}

#[test]
fn a_loop_passes_the_parts_one_by_one_while_the_grid_is_drawn_again() {
    let mut still = ControlRoom::default();
    set(&mut still, "t", 92.0);
    let mut room = at_the_first_loop();
    assert_eq!(fact(&room, "occupied_cells"), 0.0, "the grid is emptied");
    assert_eq!(at_work(&room), [0, 1, 2]);
    let mut frames = Vec::new();
    while cells(&room) != cells(&still) || parts(&room) != parts(&still) {
        assert_eq!(room.values().number("t"), 92.0, "the run waits");
        assert_eq!(room.advance(0.02), Activity::Busy);
        let seen = fact(&room, "occupied_cells") + fact(&room, "free_cells");
        frames.push((at_work(&room).len(), seen));
        assert!(frames.len() < 100, "it never ends");
    }
    assert!(frames.len() > 50, "{} frames", frames.len());
    // Candidate, fit, gate, optimize and repaint begin one after the other.
    let mut working: Vec<usize> = frames.iter().map(|(working, _)| *working).collect();
    working.dedup();
    assert_eq!(working, [4, 5, 6, 7, 8]);
    assert!(
        frames.is_sorted_by_key(|(_, seen)| *seen),
        "cells come back"
    );
    while room.values().number("t") == 92.0 {
        assert_eq!(room.advance(0.02), Activity::Busy);
    }
}

#[test]
fn what_interrupts_a_loop_shows_the_whole_grid() {
    let mut still = ControlRoom::default();
    set(&mut still, "t", 92.0);
    let mut room = at_the_first_loop();
    press(&mut room, "step");
    press(&mut room, "play");
    set(&mut room, "t", 92.0);
    assert!(cells(&room) == cells(&still));
    let mut room = at_the_first_loop();
    room.set_motion(Motion::Reduced);
    set(&mut still, "t", 129.0);
    assert_eq!(fact(&room, "sure_cells"), fact(&still, "sure_cells"));
    assert_eq!(room.advance(0.02), Activity::Idle);
}

#[test]
fn the_next_event_chooses_its_part() {
    let mut room = ControlRoom::default();
    set(&mut room, "t", 91.0);
    press(&mut room, "next-event");
    assert_eq!(room.values().number("t"), 92.0);
    let sentence = room.outcome().sentence;
    assert!(sentence.contains("Keyframe: node 29"), "{sentence}");
}

#[test]
fn plots_do_not_show_the_future() {
    let mut room = ControlRoom::default();
    let lines = |room: &ControlRoom| {
        let panels = room.scene().panels.into_iter();
        let plots = panels.filter(|panel| ["tau", "errors"].contains(&panel.id));
        let layers = plots.flat_map(|panel| panel.layers);
        let points = layers.filter_map(|layer| match layer {
            Layer::Line { points, .. } | Layer::Points { points, .. } => Some(points),
            _ => None,
        });
        points.collect::<Vec<_>>()
    };
    let axes = |room: &ControlRoom| {
        let panels = room.scene().panels.into_iter();
        let plots = panels.filter(|panel| panel.x.label == "tick");
        plots.map(|panel| (panel.x, panel.y)).collect::<Vec<_>>()
    };
    let whole = axes(&room);
    for tick in [0.0, 40.0, 92.0, 129.0] {
        set(&mut room, "t", tick);
        let shown = lines(&room);
        assert!(shown.iter().flatten().all(|[x, _]| *x <= tick), "at {tick}");
        let reached = shown.iter().filter(|line| line.len() as f64 == tick + 1.0);
        assert!(
            tick == 0.0 || reached.count() >= 3,
            "τ and both errors up to {tick}"
        );
        assert_eq!(axes(&room), whole, "nothing jumps while it plays");
    }
}

#[test]
fn the_legend_of_the_grid_has_the_colour_of_its_occupied_cells() {
    use widget_kit::palette::{Theme, cell, contrast, tone};
    use widget_kit::scene::RasterCell;
    let room = ControlRoom::default();
    let scene = room.scene();
    let legend = &scene.panels[0].legend;
    let entry = legend.iter().find(|entry| entry.label == "occupied");
    let entry = entry.expect("occupied cells have an entry");
    assert_eq!((entry.mark, entry.stroke), (None, None), "an area");
    for theme in [Theme::Light, Theme::Dark] {
        let full = cell(theme, RasterCell::Occupancy(1.0));
        assert_eq!(tone(theme, entry.tone), full);
    }
    // Occupied is ink and free is paper, in both themes.
    for theme in [Theme::Light, Theme::Dark] {
        let [full, free] = [1.0, 0.0].map(|share| cell(theme, RasterCell::Occupancy(share)));
        assert!(contrast(full, free) > 10.0);
        assert_eq!(full, tone(theme, Tone::Ink));
    }
}
