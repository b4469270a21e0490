//! The basin maps enter after the reader's first starts, and begin with them.

use widget_kit::model::{Activity, Model};
use widget_kit::scene::{Layer, Mark, RasterCell, Tone};
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};

use crate::support::{drawn, panel_of};
use crate::w16_1_basin_explorer::common::{class_at, fill, with};

/// Advances until the start has stood still for long enough.
fn stand_still(model: &mut BasinExplorer) {
    while model.advance(0.1).is_busy() {}
}

fn shows_maps(model: &BasinExplorer) -> bool {
    model.disclosure().has_panel(panel::POINT)
}

/// The classes of the reader's starts on a map, in their order.
fn tried(model: &BasinExplorer, id: &str) -> Vec<u8> {
    let layers = panel_of(model, id).layers;
    let classes = layers.iter().filter_map(|layer| match layer {
        Layer::Points {
            mark: Mark::Dot,
            tone: Tone::Class(class),
            ..
        } => Some(*class),
        _ => None,
    });
    classes.collect()
}

#[test]
fn the_maps_enter_with_the_second_start_and_nothing_is_filled_before() {
    let mut model = BasinExplorer::default();
    stand_still(&mut model);
    assert!(!shows_maps(&model) && model.work() == Activity::Idle);
    model.set("heading", 60.0).unwrap();
    stand_still(&mut model);
    assert!(!shows_maps(&model), "one start");
    // The same start again is no other one.
    model.set("heading", 0.0).unwrap();
    model.set("heading", 60.0).unwrap();
    stand_still(&mut model);
    assert!(!shows_maps(&model), "one start, twice");
    model.set("dx", 0.2).unwrap();
    stand_still(&mut model);
    assert!(shows_maps(&model));
    assert_eq!(model.work(), Activity::Busy);
}

#[test]
fn a_drag_is_one_start_however_long_it_takes() {
    let mut model = BasinExplorer::default();
    let handle = model.grab(panel::SWEEPS, [1.05, 0.1], [0.2, 0.2]).unwrap();
    for k in 0..5 {
        model.drag(handle, [1.0 - 0.1 * f64::from(k), 0.1]);
        assert_eq!(model.advance(10.0), Activity::Idle);
    }
    model.release();
    stand_still(&mut model);
    assert!(!shows_maps(&model));
    model.drag(handle, [0.9, -0.2]);
    model.release();
    stand_still(&mut model);
    assert!(shows_maps(&model));
}

#[test]
fn the_readers_starts_come_first_in_the_colours_of_their_ends() {
    let mut model = with(&[("dx", 0.0), ("dy", 0.0)]);
    for heading in [25.0, 45.0, 75.0, 180.0] {
        model.set("heading", heading).unwrap();
        stand_still(&mut model);
    }
    for _ in 0..4 {
        assert_eq!(model.work(), Activity::Busy);
    }
    // Right, another false minimum, quarter turn, half turn; point-to-plane comes home from 45°.
    assert_eq!(tried(&model, panel::POINT), [0, 3, 1, 2]);
    assert_eq!(tried(&model, panel::PLANE), [0, 0, 1, 2]);
    // The picture of a complete map depends on no history.
    while model.work().is_busy() {}
    assert!(tried(&model, panel::POINT).is_empty());
    // With another τ they are computed again, here after the turns: without pairs the run is over at once.
    model.set("tau", 0.1).unwrap();
    while tried(&model, panel::POINT).is_empty() {
        assert_eq!(model.work(), Activity::Busy);
    }
    assert_eq!(tried(&model, panel::POINT)[0], 3, "hardly a pair in reach");
}

#[test]
fn a_state_about_the_maps_shows_them_at_once() {
    for (id, value) in [
        ("paths", 1.0),
        ("axis", 1.0),
        ("edge", 1.0),
        ("edge", 2.0),
        ("more", 1.0),
    ] {
        assert!(shows_maps(&with(&[(id, value)])), "{id}={value}");
    }
    assert!(!shows_maps(&with(&[("heading", 60.0), ("variant", 1.0)])));
}

/// Heights before and after the maps enter, at the widths of the page's columns.
#[test]
fn the_maps_enter_beside_the_picture_without_a_jump() {
    let height = |width: f32, starts: &[f64]| {
        let harness = drawn("w16.1", width, |shell| {
            for heading in starts {
                let model = shell.model_mut();
                model.set("heading", *heading).unwrap();
                while model.advance(0.1).is_busy() {}
            }
        });
        let shell = harness.state();
        (shell.content_height(), shell.scene_rect())
    };
    for width in [580.0, 640.0, 700.0, 760.0, 860.0] {
        let (before, after) = (height(width, &[60.0]), height(width, &[45.0, 60.0]));
        let jump = (after.0 - before.0).abs();
        assert!(jump <= 20.0, "{width}: {before:?} and {after:?}");
    }
}

/// Each turn is registered for the arc and for the map apart.
#[test]
fn after_the_run_an_arc_shows_the_turns_that_end_right() {
    let arc = |model: &BasinExplorer| {
        let layers = panel_of(model, panel::SWEEPS).layers;
        let arc = layers.into_iter().find_map(|layer| match layer {
            Layer::Segments {
                segments,
                tone: Tone::Class(0),
                ..
            } => Some(segments.len()),
            _ => None,
        });
        arc.unwrap_or(0)
    };
    let mut model = with(&[("dx", 0.0), ("dy", 0.0)]);
    fill(&mut model);
    assert_eq!(arc(&model), 0, "before the run");
    model.set("iteration", 200.0).unwrap();
    fill(&mut model);
    let columns = (-60..=60).map(|column| [3.0 * f64::from(column), 0.0]);
    let right = columns.filter(|at| class_at(&model, panel::POINT, *at) == RasterCell::Class(0));
    let right = right.count();
    assert!((10..100).contains(&right), "{right}");
    assert_eq!(arc(&model), right);
    // `ch16 basin --heading-deg=-39:33:3 --dx 0 --dy 0` ends right from −36° to 30°.
    let layers = panel_of(&model, panel::SWEEPS).layers;
    let is_named = |layer: &Layer| matches!(layer, Layer::Label { text, .. } if text == "home from −36° to 30°");
    assert!(layers.iter().any(is_named));
    model.set("dx", 0.3).unwrap();
    assert_eq!(arc(&model), 0, "of another guess");
}
