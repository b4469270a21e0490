//! The widget's claims are right: its verdicts, its presets, its notes.

use crate::support::{fact, panel_of};
use crate::w16_1_basin_explorer::common::{class_at, fill, with};
use widget_kit::model::{Activity, Assessment, Model};
use widget_kit::scene::{Layer, Mark, RasterCell, Tone};
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};
use widgets::w16_1_basin_explorer::spec::SPEC;

#[test]
fn success_requires_position_and_heading_and_the_sentence_reports_the_wrong_one() {
    // basin.json: heading 35°, no offset: 0.116 m, but 25.3° off, stopped at 30 iterations.
    let model = with(&[("heading", 35.0), ("dx", 0.0), ("dy", 0.0)]);
    assert!(fact(&model, "error_m") < 0.12);
    let outcome = model.outcome();
    assert_eq!(outcome.standing, Assessment::Bad);
    assert_eq!(outcome.verdict, "stopped before it converged");
    assert_eq!(fact(&model, "converged"), 0.0);
    let sentence = outcome.sentence;
    assert!(sentence.contains("stopped at the limit of 30 iterations"));
    // Half of its error remains, and only the fit shows it.
    assert!(
        sentence.contains("25.3° from the truth. Its rmse is 0.344 m"),
        "{sentence}"
    );
    // With hardly a pair in reach it converges where it stands: that is a wrong heading.
    let short = [("heading", 25.0), ("dx", 0.0), ("dy", 0.0), ("tau", 0.1)];
    let short = with(&short);
    assert_eq!(short.outcome().verdict, "right place, wrong heading");
    assert_eq!(fact(&short, "converged"), 1.0);
    // Within 3° it counts as right: from 32° it ends 2.0° off, from 33° 6.8°.
    for (from, standing) in [(32.0, Assessment::Good), (33.0, Assessment::Bad)] {
        let model = with(&[("heading", from), ("dx", 0.0), ("dy", 0.0)]);
        assert_eq!(model.outcome().standing, standing, "{from}°");
    }
}

#[test]
fn it_opens_before_anything_is_solved() {
    let model = BasinExplorer::default();
    assert_eq!(model.values().number("iteration"), 0.0);
    assert!(!shows_the_end(&model));
}

/// The page prints these edges: the last whole degrees from which a start converges to the truth.
#[test]
fn verdict_and_basin_map_agree_at_the_edges_of_the_right_basin() {
    let mut map = with(&[("dy", 0.0)]);
    fill(&mut map);
    for (variant, id, [from, to]) in [
        (0.0, panel::POINT, [-37.0, 32.0]),
        (1.0, panel::PLANE, [-47.0, 47.0]),
    ] {
        let verdict = |heading: f64| {
            let start = [("heading", heading), ("dx", 0.0), ("dy", 0.0)];
            let mut model = with(&start);
            model.set("variant", variant).expect("a variant");
            model.outcome().verdict
        };
        for inside in [from, to] {
            assert_eq!(verdict(inside), "right minimum", "{id} from {inside}°");
            assert_ne!(verdict(inside + inside.signum()), "right minimum");
        }
        // The map has a column every 3°; none of the edges is among them.
        let columns = (-60..=60).step_by(3).map(f64::from);
        for heading in columns {
            let right = class_at(&map, id, [heading, 0.0]) == RasterCell::Class(0);
            assert_eq!(
                verdict(heading) == "right minimum",
                right,
                "{id}, {heading}°"
            );
            assert!(right || heading < from || heading > to, "{id}, {heading}°");
        }
    }
}

#[test]
fn every_preset_does_what_its_button_claims() {
    for (id, verdict, standing) in [
        ("near", "right minimum", Assessment::Good),
        ("quarter-turn", "quarter turn", Assessment::Bad),
        ("between", "another false minimum", Assessment::Bad),
        ("between-plane", "right minimum", Assessment::Good),
        ("half-turn", "half turn", Assessment::Bad),
        ("fence", "one post off", Assessment::Bad),
        ("short-sighted", "another false minimum", Assessment::Bad),
    ] {
        let mut model = BasinExplorer::default();
        model.press(id).expect("a preset of the widget");
        assert_eq!(
            model.values().number("iteration"),
            0.0,
            "{id} starts at the guess"
        );
        let outcome = model.outcome();
        assert_eq!(
            (outcome.verdict.as_str(), outcome.standing),
            (verdict, standing),
            "{id}"
        );
        while model.advance(0.1) == Activity::Busy {}
        let timeline = model.timeline().expect("the widget has one");
        assert_eq!(
            model.values().number("iteration"),
            timeline.last,
            "{id} plays to the end"
        );
    }
    // `mark-edge` does not play and has its own tests.
    assert_eq!(SPEC.presets.len(), 8, "a preset without a test");
}

#[test]
fn the_claims_to_notice_are_right() {
    let rmse = |heading: f64, variant: f64| {
        let model = with(&[
            ("heading", heading),
            ("dx", 0.0),
            ("dy", 0.0),
            ("variant", variant),
        ]);
        (fact(&model, "rmse_m"), fact(&model, "iterations"))
    };
    assert_eq!(format!("{:.2}", rmse(65.0, 0.0).0), "0.13");
    assert_eq!(format!("{:.2}", rmse(25.0, 0.0).0), "0.03");
    assert!(
        rmse(25.0, 1.0).1 < rmse(25.0, 0.0).1,
        "point-to-plane needs fewer iterations"
    );
    let half_turn = rmse(180.0, 0.0).0;
    assert!(
        half_turn < 0.1,
        "the half turn fits better than the quarter turn: {half_turn}"
    );
}

/// Whether the map shows the final cloud of the run.
fn shows_the_end(model: &BasinExplorer) -> bool {
    let sweeps = panel_of(model, panel::SWEEPS);
    sweeps.layers.iter().any(|layer| {
        matches!(
            layer,
            Layer::Points {
                mark: Mark::Circle,
                tone: Tone::Posterior,
                points,
                ..
            } if points.len() == 155
        )
    })
}

#[test]
fn moving_the_start_shows_its_result_and_playing_hides_it_again() {
    for (id, value) in [("heading", 60.0), ("dx", -0.3), ("dy", 0.2)] {
        let mut model = BasinExplorer::default();
        model.set(id, value).unwrap();
        assert!(shows_the_end(&model), "{id}");
        model.press("play").unwrap();
        assert!(!shows_the_end(&model), "{id}");
    }
    let mut model = BasinExplorer::default();
    let sensor = [0.5 + 0.55, -0.35 + 0.45];
    let held = model.grab(panel::SWEEPS, sensor, [0.05, 0.05]).unwrap();
    model.drag(held, [0.2, 0.1]);
    assert!(shows_the_end(&model));
    model.press("near").unwrap();
    assert!(!shows_the_end(&model), "a preset hides the end again");
}

#[test]
fn the_points_without_a_pair_are_marked() {
    let marked = |model: &BasinExplorer| {
        let sweeps = panel_of(model, panel::SWEEPS);
        sweeps.layers.iter().find_map(|layer| match layer {
            Layer::Points {
                mark: Mark::Circle,
                tone: Tone::Series(0),
                points,
                ..
            } => Some(points.len()),
            _ => None,
        })
    };
    // "Eleven lonely points" at the half turn of point-to-plane, none at the truth.
    let start = [
        ("dx", 0.0),
        ("dy", 0.0),
        ("variant", 1.0),
        ("iteration", 30.0),
    ];
    let mut model = with(&start);
    model.set("heading", 180.0).unwrap();
    assert_eq!(marked(&model), Some(11));
    model.set("heading", 0.0).unwrap();
    assert_eq!(marked(&model), Some(0));
}

#[test]
fn paths_from_other_starts_are_drawn_once_switched_on() {
    let lines = |model: &BasinExplorer| {
        let map = panel_of(model, panel::POINT);
        let is_way = |layer: &&Layer| {
            matches!(
                layer,
                Layer::Line {
                    tone: Tone::Ink,
                    ..
                }
            )
        };
        map.layers.iter().filter(is_way).count()
    };
    let mut model = with(&[("dy", 0.0)]);
    fill(&mut model);
    assert_eq!(lines(&model), 0);
    model.set("paths", 1.0).unwrap();
    fill(&mut model);
    // Every 20° in three rows.
    assert_eq!(lines(&model), 18 * 3);
    model.set("paths", 0.0).unwrap();
    assert_eq!(lines(&model), 0);
}

#[test]
fn the_mark_of_a_start_is_whole_at_both_ends_of_the_headings() {
    let model = with(&[("heading", 180.0), ("dx", 1.5)]);
    let map = panel_of(&model, panel::POINT);
    let handle = map.layers.iter().find_map(|layer| match layer {
        Layer::Handle { at, .. } => Some(*at),
        _ => None,
    });
    let at = handle.expect("the start is marked");
    // A ring of 10 pixels on a map of at least 250 by 150.
    for (axis, at, px) in [(&map.x, at[0], 250.0), (&map.y, at[1], 150.0)] {
        let room = (axis.max - at).min(at - axis.min) / (axis.max - axis.min);
        assert!(room * px >= 5.0, "{room} of {}", axis.label);
    }
}

/// The rows of the table of iterations, as numbers.
fn iterations(model: &BasinExplorer) -> Vec<Vec<f64>> {
    let tables = model.tables();
    let table = tables.iter().find(|table| table.id == "iterations");
    let rows = &table.expect("a table of the widget").rows;
    rows.iter()
        .map(|row| row.iter().map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

#[test]
fn a_short_tau_leaves_most_points_without_a_pair() {
    let mut model = BasinExplorer::default();
    model.press("short-sighted").unwrap();
    let rows = iterations(&model);
    // Columns: iteration, pairs, rmse, error, x, y; of 155 points.
    for row in &rows {
        assert!(row[1] < 155.0 / 2.0, "{row:?}");
    }
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    let moved_m = (last[4] - first[4]).hypot(last[5] - first[5]);
    // It starts 0.72 m from the truth and goes 6 cm.
    assert!(moved_m < 0.1 * first[3], "{moved_m} of {} m", first[3]);
}
