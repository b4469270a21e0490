//! What the widget says holds: its verdicts, its presets' promises, its words to notice.

use crate::common::{class_at, fact, fill, with};
use kit::model::{Activity, Model, Standing};
use kit::scene::Cell;
use w16_1_basin_explorer::model::{BasinExplorer, panel};
use w16_1_basin_explorer::spec::SPEC;

#[test]
fn the_verdict_counts_the_place_alone_and_says_where_the_heading_is_not_home() {
    // basin.json: heading 35°, no offset: 0.116 m, but 25.3° off, stopped at 30 iterations.
    let model = with(&[("heading", 35.0), ("dx", 0.0), ("dy", 0.0)]);
    assert!(fact(&model, "error_m") < 0.12);
    assert_eq!(model.outcome().standing, Standing::Good);
    assert_eq!(fact(&model, "converged"), 0.0);
    let sentence = model.outcome().sentence;
    assert!(sentence.contains("stopped at the limit of 30 iterations"));
    assert!(sentence.ends_with("the heading is not home."), "{sentence}");
    let home = BasinExplorer::new().outcome().sentence;
    assert!(!home.contains("heading"), "{home}");
}

/// The page prints these edges: the last whole degrees from which a start comes home.
#[test]
fn verdict_and_basin_map_agree_at_the_edges_of_the_right_basin() {
    let mut map = with(&[("dy", 0.0)]);
    fill(&mut map);
    for (variant, id, [from, to]) in [
        (0.0, panel::POINT, [-39.0, 33.0]),
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
        // The map has a column every 3°; −39° and 33° are among them, ±47° are not.
        let columns = (-60..=60).step_by(3).map(f64::from);
        for heading in columns {
            let right = class_at(&map, id, [heading, 0.0]) == Cell::Class(0);
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
fn every_preset_does_what_its_button_says() {
    for (id, verdict, standing) in [
        ("near", "right minimum", Standing::Good),
        ("quarter-turn", "quarter turn", Standing::Bad),
        ("between", "another false minimum", Standing::Bad),
        ("between-plane", "right minimum", Standing::Good),
        ("half-turn", "half turn", Standing::Bad),
        ("short-sighted", "another false minimum", Standing::Bad),
    ] {
        let mut model = BasinExplorer::new();
        model.press(id).expect("a preset of the widget");
        assert_eq!(
            model.values().get("iteration"),
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
            model.values().get("iteration"),
            timeline.last,
            "{id} plays to the end"
        );
    }
    assert_eq!(SPEC.presets.len(), 6, "a preset without a test");
}

#[test]
fn the_words_to_notice_hold() {
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
        "point to plane needs fewer iterations"
    );
    let half_turn = rmse(180.0, 0.0).0;
    assert!(
        half_turn < 0.1,
        "the half turn fits better than the quarter turn: {half_turn}"
    );
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
fn a_short_sighted_tau_leaves_most_points_without_a_pair() {
    let mut model = BasinExplorer::new();
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
