//! Buttons, playback and the animation of a loop.

use super::*;

#[test]
fn before_at_and_after_stay_with_their_loop_and_next_goes_round() {
    let mut model = at(&[("t", 129.0)]);
    for (button, tick) in [
        ("before", 118),
        ("at", 119),
        ("after", 120),
        ("next", 92),
        ("after", 93),
        ("before", 91),
        ("at", 92),
        ("next", 107),
        ("next", 119),
        ("next", 92),
    ] {
        press(&mut model, button);
        assert_eq!(model.tick(), tick, "after {button}");
    }
    let mut model = at(&[("t", 0.0)]);
    press(&mut model, "at");
    assert_eq!(model.tick(), 92);
    let mut model = at(&[("loops", 0.0), ("t", 5.0)]);
    for button in ["before", "at", "after", "next"] {
        press(&mut model, button);
        assert_eq!(model.tick(), 5, "there is no loop to go to");
    }
}

#[test]
fn at_a_loop_the_nodes_move_from_the_old_poses_to_the_new_ones() {
    let mut model = at(&[("wipe", 0.0)]);
    let settled = shown_nodes(&model);
    press(&mut model, "at");
    let old = shown_nodes(&model);
    let moved = |to: &[[f64; 2]]| {
        let distances = old
            .iter()
            .zip(to)
            .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        distances.fold(0.0, f64::max)
    };
    // lap.json, first event: max_shift 0.2389.
    assert!((moved(&settled) - fact(&model, "shift_m")).abs() < 1e-12);
    assert!((moved(&settled) - 0.2389).abs() < 5e-5);
    let mut last = 0.0;
    while model.advance(0.05) == Activity::Busy {
        let now = moved(&shown_nodes(&model));
        assert!(now >= last - 1e-12);
        last = now;
    }
    assert_eq!(shown_nodes(&model), settled);
}

#[test]
fn with_reduced_motion_a_loop_jumps() {
    let mut model = FullLap::default();
    let settled = shown_nodes(&model);
    model.set_motion(Motion::Reduced);
    press(&mut model, "at");
    assert_eq!(shown_nodes(&model), settled);
    assert_eq!(model.advance(0.1), Activity::Idle);
    // Requested during an animation, it ends the animation.
    model.set_motion(Motion::Full);
    press(&mut model, "at");
    assert_ne!(shown_nodes(&model), settled);
    model.set_motion(Motion::Reduced);
    assert_eq!(shown_nodes(&model), settled);
}

#[test]
fn playing_shows_every_loop_and_ends_at_the_end() {
    for speed in 0..=4 {
        let mut model = at(&[("speed", f64::from(speed)), ("t", 129.0)]);
        press(&mut model, "play");
        assert_eq!(model.tick(), 0, "at the end, play starts over");
        let mut seen = vec![0];
        while model.advance(0.25) == Activity::Busy {
            if seen.last() != Some(&model.tick()) {
                seen.push(model.tick());
            }
        }
        assert_eq!(model.tick(), 129);
        for tick in [92, 107, 119] {
            assert!(
                seen.contains(&tick),
                "speed {speed} skipped the loop at {tick}"
            );
        }
        assert!(!model.timeline().unwrap().playing);
    }
}

#[test]
fn a_loop_just_before_the_end_does_not_stop_the_playback() {
    // At four times the speed a slow frame covers 8 ticks: the end and the loop are in one frame.
    let mut model = at(&[("speed", 4.0)]);
    let late = (0..60).find_map(|seed| {
        set(&mut model, "seed", f64::from(seed));
        let last = model.runs.graph.attempts().last()?;
        (123..129).contains(&last.tick).then_some(last.tick)
    });
    let tick = late.expect("some seed has its last loop in the last ticks");
    set(&mut model, "t", tick as f64 - 1.0);
    press(&mut model, "play");
    model.advance(0.25);
    assert_eq!(model.tick(), tick);
    while model.advance(0.25) == Activity::Busy {}
    assert_eq!(model.tick(), 129);
}

#[test]
fn transport_buttons_step_reset_and_restore() {
    let mut model = at(&[("noise", 2.0), ("t", 50.0)]);
    press(&mut model, "step");
    assert_eq!(model.tick(), 51);
    press(&mut model, "reset");
    assert_eq!(model.tick(), 0);
    assert_eq!(model.values().number("noise"), 2.0);
    press(&mut model, "defaults");
    assert_eq!(model.values(), &Values::defaults(SPEC.params));
    assert!(picture(&model) == picture(&FullLap::default()));
    let mut model = at(&[("t", 129.0)]);
    press(&mut model, "step");
    assert_eq!(model.tick(), 129, "the lap has an end");
}

#[test]
fn the_line_at_the_moment_shown_can_be_dragged_in_every_plot_over_time() {
    let mut model = at(&[("t", 50.0)]);
    let scene = model.scene();
    for panel in &scene.panels {
        let grabbed = model.grab(panel.id, [51.0, 0.1], [3.0, 0.1]);
        let over_time = panel.x.label == "tick";
        assert_eq!(grabbed.is_some(), over_time, "{}", panel.id);
        assert!(model.grab(panel.id, [54.0, 0.1], [3.0, 0.1]).is_none());
    }
    let line = model.grab("errors", [51.0, 0.1], [3.0, 0.1]).unwrap();
    // Grabbed one tick off the line: it does not jump by that tick.
    for (to, tick) in [(61.0, 60), (-40.0, 0), (500.0, 129)] {
        model.drag(line, [to, 0.0]);
        assert_eq!(model.tick(), tick);
    }
}

/// The last tick of any line, in the plots over time.
fn drawn_until(model: &FullLap) -> f64 {
    let scene = model.scene();
    let plots = scene.panels.iter().filter(|panel| panel.x.label == "tick");
    let layers = plots.flat_map(|panel| &panel.layers);
    let times = layers.flat_map(|layer| match layer {
        // The gate is a level, not an event.
        Layer::Line { points, stroke, .. } if *stroke == Stroke::Solid => points.clone(),
        Layer::Points { points, .. } => points.clone(),
        _ => Vec::new(),
    });
    times.map(|point| point[0]).fold(0.0, f64::max)
}

#[test]
fn the_future_is_drawn_only_on_request() {
    for tick in [0.0, 50.0, 91.0, 100.0] {
        let mut model = at(&[("t", tick)]);
        assert_eq!(drawn_until(&model), tick);
        set(&mut model, "future", 1.0);
        assert_eq!(drawn_until(&model), 129.0);
    }
    // One tick before the first loop, it is shown nowhere.
    let mut model = at(&[("t", 91.0)]);
    for (future, loops) in [(0.0, 0), (1.0, 3)] {
        set(&mut model, "future", future);
        assert_eq!(model.timeline().unwrap().marks.len(), loops);
        for id in ["loops", "loop-attempts"] {
            assert_eq!(table(&model, id).len(), loops, "{id}");
        }
        let rows = if future == 0.0 { 92 } else { 130 };
        assert_eq!(table(&model, "errors-over-time").len(), rows);
        let title = |model: &FullLap| model.scene().panels[1].title.clone();
        assert_eq!(
            title(&model).starts_with("Close-up of loop 29 to 7"),
            future == 1.0
        );
    }
    let seen = table(&model, "run");
    set(&mut model, "future", 0.0);
    assert_ne!(table(&model, "run"), seen, "results so far");
    set(&mut model, "t", 129.0);
    assert_eq!(table(&model, "run"), seen, "results at the end");
    // Between two loops the close-up shows the previous one.
    let closeup = |tick| {
        let scene = at(&[("t", tick)]).scene();
        scene.panels[1].title.clone()
    };
    assert_eq!(closeup(50.0), "No loop tried so far");
    for tick in [92.0, 106.0] {
        assert!(closeup(tick).starts_with("Close-up of loop 29 to 7"));
    }
}

/// The marks of loops on a panel: solid and green, hollow and grey.
fn loops_on(model: &FullLap, panel: usize) -> [usize; 2] {
    let scene = model.scene();
    let layers = &scene.panels[panel].layers;
    [
        (Mark::Dot, Tone::Measurement),
        (Mark::Circle, Tone::Series(3)),
    ]
    .map(|look| {
        let marks = layers.iter().map(|layer| match layer {
            // The points of the map are smaller.
            Layer::Points {
                points,
                mark,
                tone,
                radius_px,
            } if (*mark, *tone) == look && *radius_px > 4.0 => points.len(),
            _ => 0,
        });
        marks.sum()
    })
}

#[test]
fn accepted_loops_are_solid_and_rejected_ones_hollow_on_the_map_and_in_the_plot() {
    // Seed 6: one loop rejected at tick 90, others accepted.
    let model = at(&[("seed", 6.0), ("t", 129.0)]);
    let attempts = model.runs.graph.attempts();
    let accepted = attempts.iter().filter(|a| a.accepted()).count();
    let expected = [accepted, attempts.len() - accepted];
    assert!(expected[0] > 0 && expected[1] > 0);
    let map = 0;
    let gate = model.scene().panels.len() - 2;
    for panel in [map, gate] {
        assert_eq!(loops_on(&model, panel), expected, "panel {panel}");
    }
}

#[test]
fn the_outward_and_the_return_path_have_two_shades() {
    let points = |tick: f64, tone: Tone| {
        let scene = at(&[("t", tick)]).scene();
        let layers = scene.panels[0].layers.iter();
        let counts = layers.map(|layer| match layer {
            Layer::Points {
                points,
                tone: of,
                radius_px,
                ..
            } if *of == tone && *radius_px < 3.0 => points.len(),
            _ => 0,
        });
        counts.sum::<usize>()
    };
    assert_eq!(points(20.0, Tone::Revisit), 0);
    assert!(points(20.0, Tone::Outbound) > 500);
    assert!(points(129.0, Tone::Revisit) > 500);
}

#[test]
fn left_of_the_line_the_map_is_that_before_the_loop_and_right_of_it_that_after() {
    let mut model = at(&[("t", 92.0), ("wipe", 0.0)]);
    let after = shown_nodes(&model);
    set(&mut model, "wipe", 1.0);
    assert!(shown_nodes(&model).is_empty(), "all of it is before");
    let map = &model.scene().panels[0];
    let before = map.layers.iter().find_map(|layer| match layer {
        Layer::Points {
            points,
            tone: Tone::Prior,
            ..
        } => Some(points.clone()),
        _ => None,
    });
    let before = before.expect("the old nodes");
    assert_eq!(before.len(), after.len());
    assert_ne!(before, after);
    // A drag moves the line by the pointer's way, over the whole width and not beyond.
    set(&mut model, "wipe", 0.5);
    let (low, high) = (map.x.min, map.x.max);
    let middle = 0.5 * (low + high);
    let held = model.grab("map", [middle + 0.05, 8.0], [0.18; 2]);
    let held = held.expect("the line is held anywhere along it");
    model.drag(held, [low + 0.25 * (high - low) + 0.05, 2.0]);
    assert_eq!(model.values().number("wipe"), 0.25);
    assert!(
        model.summary().contains("A line at 25%"),
        "{}",
        model.summary()
    );
    let line = low + 0.25 * (high - low);
    assert!(shown_nodes(&model).iter().all(|at| at[0] >= line));
    model.drag(held, [high + 9.0, 2.0]);
    assert_eq!(model.values().number("wipe"), 1.0);
    // Without a closed loop there is no line.
    set(&mut model, "t", 60.0);
    assert!(model.grab("map", [high, 8.0], [0.18; 2]).is_none());
}
