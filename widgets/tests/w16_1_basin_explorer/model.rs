//! The model of the basin explorer, without a picture.
//!
//! Reference values: the reference system's basin runs (`tests/reference/basin.json`). The core is tested
//! against all of them; a few here show that the widget calls the core correctly.

use crate::support::{fact, panel_of};
use crate::w16_1_basin_explorer::common::{class_at, fill, with};
use widget_kit::model::{Activity, Model};
use widget_kit::scene::{Layer, RasterCell};
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};

#[test]
fn the_verdicts_are_those_of_the_reference_runs() {
    // heading, Δx, Δy, variant → error (m), error (°), rmse (m), pairs; basin.json, τ 0.7.
    for (start, verdict, expected) in [
        (
            [25.0, 0.55, 0.45, 0.0],
            "right minimum",
            [0.007, -0.243, 0.033, 155.0],
        ),
        (
            [60.0, 0.0, 0.0, 0.0],
            "quarter turn",
            [0.881, 83.329, 0.166, 144.0],
        ),
        (
            [65.0, 0.0, 0.0, 0.0],
            "quarter turn",
            [0.940, 89.096, 0.133, 144.0],
        ),
        (
            [45.0, 0.0, 0.0, 0.0],
            "another false minimum",
            [0.317_96, 41.125, 0.356, 146.0],
        ),
        (
            [45.0, 0.0, 0.0, 1.0],
            "right minimum",
            [0.001, 0.105, 0.024, 155.0],
        ),
        (
            [45.0, 0.55, 0.45, 1.0],
            "quarter turn",
            [0.953, 90.054, 0.089, 144.0],
        ),
    ] {
        let [heading, dx, dy, variant] = start;
        let model = with(&[
            ("heading", heading),
            ("dx", dx),
            ("dy", dy),
            ("variant", variant),
        ]);
        assert_eq!(model.outcome().verdict, verdict, "{start:?}");
        for (id, expected) in ["error_m", "error_deg", "rmse_m", "pairs"]
            .iter()
            .zip(expected)
        {
            // The reference figures above are rounded to three digits.
            assert!(
                (fact(&model, id) - expected).abs() < 6e-4,
                "{start:?}: {id}"
            );
        }
    }
}

#[test]
fn the_chapters_seed_is_the_default_one() {
    let default = BasinExplorer::default();
    let typed = with(&[("seed", 8.0), ("seed", f64::from(0x1C9))]);
    assert_eq!(default.outcome(), typed.outcome());
    assert_ne!(default.outcome(), with(&[("seed", 8.0)]).outcome());
}

#[test]
fn a_grabbed_source_follows_the_pointer_and_becomes_the_start() {
    let mut model = with(&[("iteration", 30.0)]);
    // At the end of the default run the source is on the target: its sensor is near the truth.
    let at = [0.5, -0.35];
    let handle = model
        .grab(panel::SWEEPS, at, [0.05, 0.05])
        .expect("the source's sensor");
    model.drag(handle, [at[0] + 0.4, at[1] - 0.2]);
    let values = model.values();
    assert_eq!(
        values.number("iteration"),
        0.0,
        "the guess shows while it is dragged"
    );
    // Offsets are rounded to the centimetre, and the run had ended 7 mm from the truth.
    assert!(
        (values.number("dx") - 0.4).abs() < 0.016,
        "{}",
        values.number("dx")
    );
    assert!(
        (values.number("dy") + 0.2).abs() < 0.016,
        "{}",
        values.number("dy")
    );
    assert!(values.number("heading").abs() < 0.3);
}

#[test]
fn the_handle_turns_the_source_about_its_sensor() {
    let mut model = with(&[
        ("dx", 0.0),
        ("dy", 0.0),
        ("heading", 0.0),
        ("iteration", 0.0),
    ]);
    // The handle stands 1 m ahead of the sensor at (0.5, −0.35), which looks along 0.35 rad.
    let ahead = [0.5 + 0.35_f64.cos(), -0.35 + 0.35_f64.sin()];
    let handle = model
        .grab(panel::SWEEPS, ahead, [0.05, 0.05])
        .expect("the handle");
    model.drag(handle, [0.5 - ahead[1] - 0.35, -0.35 + ahead[0] - 0.5]);
    assert!((model.values().number("heading") - 90.0).abs() < 0.1);
    assert_eq!(
        (model.values().number("dx"), model.values().number("dy")),
        (0.0, 0.0)
    );
}

#[test]
fn drags_far_outside_stay_within_the_ranges() {
    let mut model = with(&[("iteration", 0.0)]);
    for (panel, at) in [
        (panel::SWEEPS, [1e6, -1e6]),
        (panel::POINT, [-1e6, 1e6]),
        (panel::PLANE, [1e6, -1e6]),
    ] {
        let spot = [0.5 + 0.55, -0.35 + 0.45];
        let Some(handle) = model.grab(panel, spot, [3.0, 3.0]) else {
            panic!("nothing to grab on {panel}");
        };
        model.drag(handle, at);
        for (spec, value) in model.values().iter() {
            assert_eq!(spec.check(value), Ok(value), "{} after {at:?}", spec.id);
        }
    }
}

#[test]
fn a_press_on_a_basin_map_starts_there_with_that_variant() {
    let mut model = BasinExplorer::default();
    let handle = model
        .grab(panel::PLANE, [90.0, -1.0], [1.0, 1.0])
        .expect("every spot is a start");
    model.drag(handle, [90.0, -1.0]);
    let values = model.values();
    assert_eq!(
        (values.number("heading"), values.number("dx")),
        (90.0, -1.0)
    );
    assert_eq!(values.number("dy"), 0.45, "the other offset stays");
    assert_eq!(values.number("variant"), 1.0);
    model.set("axis", 1.0).unwrap();
    let handle = model
        .grab(panel::POINT, [10.0, 0.3], [1.0, 1.0])
        .expect("every spot is a start");
    model.drag(handle, [10.0, 0.3]);
    assert_eq!(
        (model.values().number("dx"), model.values().number("dy")),
        (-1.0, 0.3)
    );
    assert_eq!(model.values().number("variant"), 0.0);
}

#[test]
fn a_basin_map_agrees_with_a_run_from_that_spot() {
    let mut model = with(&[("dy", 0.0)]);
    fill(&mut model);
    for (heading, dx) in [
        (-177.0, 0.0),
        (-90.0, 0.3),
        (0.0, 0.0),
        (48.0, 0.0),
        (63.0, -0.6),
    ] {
        for (variant, id) in [(0.0, panel::POINT), (1.0, panel::PLANE)] {
            let run = with(&[
                ("dy", 0.0),
                ("heading", heading),
                ("dx", dx),
                ("variant", variant),
            ]);
            let class = match run.outcome().verdict.as_str() {
                "right minimum" => 0,
                "quarter turn" => 1,
                "half turn" => 2,
                "stopped before it converged" => 6,
                _ => 3,
            };
            let shown = class_at(&model, id, [heading, dx]);
            assert_eq!(
                shown,
                RasterCell::Class(class),
                "{id} at {heading}°, {dx} m"
            );
        }
    }
}

#[test]
fn basin_maps_fill_in_small_pieces_and_only_start_over_when_they_must() {
    let mut model = BasinExplorer::default();
    let pieces = fill(&mut model);
    assert!(pieces > 2000, "pieces must be small: {pieces}");
    for (id, value) in [
        ("heading", 10.0),
        ("dx", 0.1),
        ("variant", 1.0),
        ("iteration", 3.0),
    ] {
        model.set(id, value).unwrap();
        assert_eq!(model.work(), Activity::Idle, "{id}");
    }
    for (id, value) in [
        ("tau", 1.0),
        ("dy", 0.2),
        ("trim", 0.2),
        ("huber", 0.1),
        ("seed", 5.0),
        ("axis", 1.0),
    ] {
        let middle = |model: &BasinExplorer| class_at(model, panel::PLANE, [0.0, 0.0]);
        assert_ne!(middle(&model), RasterCell::Unknown);
        model.set(id, value).unwrap();
        assert_eq!(middle(&model), RasterCell::Unknown, "{id}");
        // The coarsest pass covers everything in 2 × 16 × 6 registrations.
        for _ in 0..64 {
            assert_eq!(model.work(), Activity::Busy);
        }
    }
}

#[test]
fn a_picture_is_uploaded_again_only_when_it_changed() {
    let mut model = BasinExplorer::default();
    let revision = |model: &BasinExplorer| {
        let panel = panel_of(model, panel::POINT);
        panel.layers.iter().find_map(|layer| match layer {
            Layer::Raster(raster) => Some(raster.revision),
            _ => None,
        })
    };
    fill(&mut model);
    let filled = revision(&model);
    model.set("heading", 99.0).unwrap();
    model.press("step").unwrap();
    assert_eq!(revision(&model), filled);
    model.set("tau", 0.5).unwrap();
    assert_ne!(revision(&model), filled);
}

#[test]
fn dragging_a_slider_keeps_the_position_on_the_timeline() {
    let mut model = with(&[("iteration", 4.0)]);
    model.set("heading", 50.0).unwrap();
    assert_eq!(model.values().number("iteration"), 4.0);
    // A position beyond the last iteration means the end, regardless of the length of the run.
    let model = with(&[("variant", 1.0), ("iteration", 30.0)]);
    let timeline = model.timeline().unwrap();
    assert!(timeline.last < model.values().number("iteration"));
    assert!(
        model
            .summary()
            .contains(&format!("iteration {0} of {0}", timeline.last))
    );
}

#[test]
fn tables_hold_every_iteration_and_every_start() {
    let mut model = BasinExplorer::default();
    fill(&mut model);
    let tables = model.tables();
    let rows = |id: &str| {
        tables
            .iter()
            .find(|table| table.id == id)
            .unwrap()
            .rows
            .len()
    };
    assert_eq!(
        rows("iterations"),
        model.timeline().unwrap().last as usize + 1
    );
    assert_eq!(rows("basins"), 121 * 41);
    for table in &tables {
        for row in &table.rows {
            assert_eq!(row.len(), table.columns.len(), "{}", table.id);
        }
    }
}

/// The share of the points of the sweeps and of the run's end that lie outside of the axes.
fn cut_off(model: &BasinExplorer) -> f64 {
    let sweeps = panel_of(model, panel::SWEEPS);
    let is_inside = |at: &&[f64; 2]| {
        (sweeps.x.min..=sweeps.x.max).contains(&at[0])
            && (sweeps.y.min..=sweeps.y.max).contains(&at[1])
    };
    let points = sweeps.layers.iter().filter_map(|layer| match layer {
        Layer::Points { points, .. } => Some(points),
        _ => None,
    });
    let points: Vec<_> = points.flatten().collect();
    let outside = points.iter().filter(|at| !is_inside(at)).count();
    outside as f64 / points.len() as f64
}

/// A picture shows nine tenths of each sweep: the room fills it, and what is seen through its door may be cut off. Points
/// without a pair count twice.
const CUT_OFF: f64 = 0.15;

#[test]
fn the_room_is_in_view_at_every_heading_and_after_every_drag() {
    for heading in [-180.0, -75.0, 25.0, 45.0, 75.0, 180.0] {
        for offset in [-1.5, 0.0, 1.5] {
            let model = with(&[("heading", heading), ("dx", offset), ("dy", -offset)]);
            let cut = cut_off(&model);
            assert!(cut <= CUT_OFF, "{heading}° at {offset} m: {cut}");
        }
    }
    let axes = |model: &BasinExplorer| {
        let sweeps = panel_of(model, panel::SWEEPS);
        (sweeps.x, sweeps.y)
    };
    let first = axes(&with(&[]));
    for heading in (-180..=180).step_by(15) {
        let turned = with(&[("heading", f64::from(heading))]);
        assert_eq!(axes(&turned), first, "the axes stay at {heading}°");
    }
    let mut model = with(&[]);
    let sensor = [1.05, 0.1];
    let held = model.grab(panel::SWEEPS, sensor, [0.2, 0.2]).unwrap();
    model.drag(held, [1.2, 0.3]);
    let during = axes(&model);
    model.release();
    assert_eq!(axes(&model), during, "a sweep stays where it is let go");
    let held = model.grab(panel::SWEEPS, [1.2, 0.3], [0.2, 0.2]).unwrap();
    model.drag(held, [2.0, -1.0]);
    assert_eq!(
        axes(&model),
        during,
        "the axes stay while the source is dragged"
    );
    model.release();
    assert!(cut_off(&model) <= CUT_OFF);
}
