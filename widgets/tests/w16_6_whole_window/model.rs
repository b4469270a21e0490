//! The whole window without its picture; reference values from the room of the chapter's basins.

use widget_kit::model::{Activity, Assessment, Model};
use widget_kit::scene::{Layer, RasterCell, Tone};
use widgets::w16_6_whole_window::model::{WholeWindow, panel};
use widgets::w16_6_whole_window::spec::SPEC;

use crate::support::{fact, panel_of};

fn with(values: &[(&str, f64)]) -> WholeWindow {
    let mut window = WholeWindow::default();
    for (id, value) in values {
        window.set(id, *value).unwrap();
    }
    window.finish_work();
    window
}

#[test]
fn it_finds_the_truth_where_icp_ends_in_the_quarter_turn() {
    let window = with(&[]);
    assert_eq!(window.outcome().standing, Assessment::Good);
    assert!(fact(&window, "error_m") < 0.12);
    // 0.943 m and 89.5°: the chapter's quarter turn.
    assert!((fact(&window, "icp_error_m") - 0.943).abs() < 5e-4);
    assert!((fact(&window, "icp_error_deg") - 89.5).abs() < 0.05);
    assert!(fact(&window, "fewer") > 100.0);
    // The half turn is the runner-up, the quarter turn is far behind.
    let (half, quarter) = (
        fact(&window, "half_behind"),
        fact(&window, "quarter_behind"),
    );
    assert!((half - fact(&window, "margin")).abs() < 0.01);
    assert!(quarter > 3.0 * half && half > 0.05);
}

#[test]
fn it_finds_the_truth_from_every_heading() {
    for heading in [-180.0, -135.0, -60.0, 0.0, 45.0, 120.0, 180.0] {
        let window = with(&[("heading", heading)]);
        assert_eq!(window.outcome().standing, Assessment::Good, "{heading}");
    }
}

#[test]
fn the_search_goes_on_in_pieces_and_its_end_does_not_depend_on_them() {
    let mut pieces = WholeWindow::default();
    assert_eq!(pieces.outcome().verdict, "searching");
    let mut count = 0;
    while pieces.outcome().verdict == "searching" {
        assert_eq!(pieces.work(), Activity::Busy);
        count += 1;
    }
    assert!(count > 20, "{count} pieces");
    pieces.finish_work();
    let whole = with(&[]);
    assert!(!pieces.finish_work());
    assert_eq!(pieces.outcome(), whole.outcome());
}

#[test]
fn the_surface_fills_in_and_ends() {
    let mut window = with(&[("cell", 0.2), ("window", 0.5)]);
    let mut pieces = 0;
    while window.work().is_busy() {
        pieces += 1;
    }
    assert!(pieces > 10);
    let ink = panel_of(&window, panel::PLACES).layers;
    let ink = ink.iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.cells.clone()),
        _ => None,
    });
    let fits = |cell: &&RasterCell| matches!(cell, RasterCell::Occupancy(share) if *share > 0.0);
    let ink = ink.expect("the positions have a raster");
    assert_eq!(ink.iter().filter(fits).count(), ink.len());
    assert_eq!(window.work(), Activity::Idle);
}

#[test]
fn playing_goes_through_the_search_and_the_steps_of_icp() {
    let mut window = with(&[("cell", 0.2)]);
    window.press("play").unwrap();
    let (mut places, mut frames) = (Vec::new(), 0);
    while window.advance(1.0 / 30.0) == Activity::Busy {
        places.push(window.values().number("progress"));
        frames += 1;
    }
    let last = window.timeline().unwrap().last;
    assert_eq!(places.last(), Some(&last));
    assert!(places.windows(2).all(|pair| pair[0] <= pair[1]));
    // Twelve seconds and a few steps of ICP, at thirty frames a second.
    assert!((330..600).contains(&frames), "{frames}");

    let error = fact(&window, "error_m");
    assert!(error < 0.12);
}

#[test]
fn a_dragged_start_is_searched_again_at_its_new_pose() {
    let mut window = with(&[("progress", 500.0)]);
    // The truth is at (0.5, −0.35) m, and so is the start.
    let handle = window
        .grab(panel::PLACES, [0.5, -0.35], [0.05, 0.05])
        .unwrap();
    window.drag(handle, [1.0, -0.15]);
    assert_eq!(window.values().number("progress"), 0.0);
    assert!((window.values().number("dx") - 0.5).abs() < 1e-9);
    assert!((window.values().number("dy") - 0.2).abs() < 1e-9);
    assert_eq!(window.outcome().verdict, "searching");
    window.drag(handle, [f64::NAN, 0.0]);
    assert!((window.values().number("dx") - 0.5).abs() < 1e-9);
    window.drag(handle, [1e300, -1e300]);
    assert_eq!(window.values().number("dx"), 1.5);
    assert!(window.grab("nothing", [0.5, -0.35], [0.1, 0.1]).is_none());
}

#[test]
fn every_preset_does_what_its_button_claims() {
    for (id, verdict, standing) in [
        (
            "quarter-turn",
            "the search finds the truth",
            Assessment::Good,
        ),
        (
            "upside-down",
            "the search finds the truth",
            Assessment::Good,
        ),
        ("wide", "the search finds the truth", Assessment::Good),
        ("without-home", "no place fits", Assessment::Bad),
        ("coarse", "the search finds the truth", Assessment::Good),
    ] {
        let mut window = WholeWindow::default();
        window.press(id).unwrap();
        window.finish_work();
        assert_eq!(window.outcome().verdict, verdict, "{id}");
        assert_eq!(window.outcome().standing, standing, "{id}");
    }
    assert_eq!(SPEC.presets.len(), 5, "a preset without a test");
    let near = with(&[]);
    let wide = with(&[("window", 3.0)]);
    let ratio = |id: &str| fact(&wide, id) / fact(&near, id);
    assert!((3.9..4.0).contains(&ratio("window")), "{}", ratio("window"));
    assert!(ratio("scored") < 2.0, "{}", ratio("scored"));
    assert!(fact(&wide, "fewer") > 200.0);
    let coarse = with(&[("cell", 0.2)]);
    let (half, quarter) = (
        fact(&coarse, "half_behind"),
        fact(&coarse, "quarter_behind"),
    );
    assert!((half - quarter).abs() < 0.02, "{half} and {quarter}");
}

/// Number of bars in that tone over the headings.
fn bars(window: &WholeWindow, of: Tone) -> usize {
    let layers = panel_of(window, panel::BOUNDS).layers;
    let found = layers.iter().filter_map(|layer| match layer {
        Layer::Segments { segments, tone, .. } if *tone == of => Some(segments.len()),
        _ => None,
    });
    found.sum()
}

#[test]
fn dropped_boxes_turn_black_and_stay_and_the_poses_looked_at_are_counted() {
    let mut seen = Vec::new();
    for progress in [0.0, 300.0, 600.0] {
        let window = with(&[("progress", progress)]);
        seen.push(bars(&window, Tone::Ink));
    }
    assert!(
        seen[0] == 0 && seen[0] < seen[1] && seen[1] < seen[2],
        "{seen:?}"
    );
    let end = with(&[("progress", 200_000.0)]);
    let title = panel_of(&end, panel::BOUNDS).title;
    assert_eq!(title, "1,652,124 poses, 1,116 scored");
}

/// The number of poses of ICP's path on the positions.
fn icp_path(window: &WholeWindow) -> Option<usize> {
    let layers = panel_of(window, panel::PLACES).layers;
    layers.iter().find_map(|layer| match layer {
        Layer::Line {
            points,
            tone: Tone::Series(2),
            ..
        } => Some(points.len()),
        _ => None,
    })
}

#[test]
fn icp_races_the_search_and_stops_in_a_false_minimum_first() {
    let mut window = with(&[]);
    assert_eq!(icp_path(&window), None, "nothing tells where it ends");
    window.press("step").unwrap();
    assert_eq!(icp_path(&window), Some(2));
    let whole = icp_path(&with(&[("progress", 200_000.0)]));
    let marks = window.timeline().unwrap().marks;
    let stop = marks
        .iter()
        .find(|mark| mark.label.contains("ICP alone"))
        .unwrap();
    assert_eq!(
        (stop.label.as_str(), stop.standing),
        ("ICP alone stops a quarter turn off", Assessment::Bad)
    );
    for (at, is_over) in [(stop.at - 50.0, false), (stop.at, true)] {
        window.set("progress", at).unwrap();
        assert_eq!(icp_path(&window) == whole, is_over, "at {at}");
    }
}

/// The one counter over the plan: the work so far, and that of trying all.
#[test]
fn the_counter_over_the_window_grows_to_the_work_of_the_search() {
    let title = |window: &WholeWindow| panel_of(window, panel::SWEEPS).title;
    let count = |window: &WholeWindow| {
        let title = title(window);
        let (scores, all) = title.split_once(" scores for ").expect("a counter");
        let all = all.strip_suffix(" poses").unwrap();
        [scores, all].map(|number| number.replace(',', "").parse::<f64>().unwrap())
    };
    let mut window = with(&[]);
    let [before, all] = count(&window);
    window.set("progress", 200_000.0).unwrap();
    window.finish_work();
    let [after, same] = count(&window);
    assert!(
        before < after && after < 0.01 * all,
        "{before} {after} {all}"
    );
    assert_eq!(all, same);
    let facts = window.outcome().facts;
    let fact = |id: &str| facts.iter().find(|fact| fact.id == id).unwrap().value;
    assert_eq!([after, all], [fact("scored"), fact("window")]);
}

/// The line of true scores on the bounds, and the bar above it.
type ScoresAndBound = (Vec<[f64; 2]>, [[f64; 2]; 2]);

fn looked_into(window: &WholeWindow) -> Option<ScoresAndBound> {
    let layers = panel_of(window, panel::BOUNDS).layers;
    let line = layers.iter().find_map(|layer| match layer {
        Layer::Line {
            points,
            tone: Tone::Series(3),
            ..
        } => Some(points.clone()),
        _ => None,
    });
    let bar = layers.iter().find_map(|layer| match layer {
        Layer::Segments {
            segments,
            tone: Tone::Series(3),
            ..
        } => Some(segments[0]),
        _ => None,
    });
    line.zip(bar)
}

#[test]
fn the_curve_belongs_to_the_box_under_the_pointer_or_to_the_one_taken_up() {
    let mut window = with(&[("progress", 300.0)]);
    let taken = looked_into(&window).expect("the box taken up");
    // Over the headings: the bar next to the pointer, at the right heading and almost full score.
    window.hover(panel::BOUNDS, Some([0.0, 0.95]));
    let (line, bar) = looked_into(&window).unwrap();
    assert_ne!((line.clone(), bar), taken);
    assert!(bar[0][0] <= 0.0 && bar[1][0] >= 0.0, "{bar:?}");
    for [heading, score] in &line {
        assert!(*score <= bar[0][1], "{score} is above the bound {bar:?}");
        // 1e-6: the ends of a bar are computed from its middle.
        assert!((bar[0][0] - 1e-6..=bar[1][0] + 1e-6).contains(heading));
    }
    // From above: a box that holds the spot.
    window.hover(panel::PLACES, Some([0.5, -0.35]));
    assert!(looked_into(&window).is_some());
    window.hover(panel::PLACES, None);
    assert_eq!(looked_into(&window), Some(taken));
    // A touch has no hover.
    window.tap(panel::BOUNDS, [0.0, 0.95], [1.0, 0.1]);
    assert_eq!(looked_into(&window), Some((line, bar)));
    window.set("heading", 20.0).unwrap();
    assert_eq!(looked_into(&window), None, "another search has other boxes");
}

#[test]
fn what_was_thrown_away_leaves_its_outline() {
    let outlines = |progress: f64| {
        let layers = panel_of(&with(&[("progress", progress)]), panel::SWEEPS).layers;
        let lines = layers.into_iter().filter_map(|layer| match layer {
            Layer::Line {
                points,
                tone: Tone::Ink,
                ..
            } => Some(points.len()),
            _ => None,
        });
        lines.sum::<usize>()
    };
    assert_eq!(outlines(0.0), 0);
    assert!(outlines(200_000.0) > outlines(200.0));
    let end = panel_of(&with(&[("progress", 200_000.0)]), panel::SWEEPS).layers;
    let is_looked_at = |layer: &Layer| {
        matches!(
            layer,
            Layer::Line {
                tone: Tone::Series(3),
                ..
            }
        )
    };
    assert!(
        !end.iter().any(is_looked_at),
        "the last box taken is none of these"
    );
}
