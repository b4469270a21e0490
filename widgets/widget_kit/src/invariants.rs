//! Invariants of every model: for the tests over all widgets, and for the fuzzer.

use crate::model::Model;
use crate::scene::{Layer, RasterCell, Scene};

/// Asserts that every value is in the range of its parameter.
///
/// # Panics
/// If one is not.
pub fn assert_values(model: &dyn Model) {
    for (param, value) in model.values().iter() {
        let checked = param.check(value).map(f64::to_bits);
        assert_eq!(checked, Ok(value.to_bits()), "{} at {value}", param.id);
    }
}

/// Asserts that texts, tables, timeline and picture are consistent, and that their numbers can be drawn.
///
/// # Panics
/// If they are not.
pub fn assert_reports(model: &dyn Model) {
    let outcome = model.outcome();
    assert!(!outcome.sentence.is_empty() && !outcome.verdict.is_empty());
    assert!(!outcome.sentence.contains("NaN"), "{}", outcome.sentence);
    let summary = model.summary();
    assert!(!summary.is_empty() && !summary.contains("NaN"), "{summary}");
    for table in model.tables() {
        for row in &table.rows {
            assert_eq!(row.len(), table.columns.len(), "{}", table.id);
        }
    }
    if let Some(timeline) = model.timeline() {
        assert!(timeline.last.is_finite() && timeline.last >= 0.0);
        for mark in &timeline.marks {
            assert!((0.0..=timeline.last).contains(&mark.at), "{}", mark.label);
        }
        assert!(model.values().find(timeline.param).is_some());
    }
    assert_drawable(&model.scene());
}

fn assert_drawable(scene: &Scene) {
    assert!(!scene.panels.is_empty());
    for panel in &scene.panels {
        for axis in [&panel.x, &panel.y] {
            let is_range = axis.min.is_finite() && axis.max.is_finite() && axis.min < axis.max;
            assert!(is_range, "{}: {axis:?}", panel.id);
        }
        for layer in &panel.layers {
            assert!(numbers_are_finite(layer), "{}: {layer:?}", panel.id);
        }
    }
}

/// Whether every number of a layer can be drawn. Values that are not finite may interrupt a line.
fn numbers_are_finite(layer: &Layer) -> bool {
    let finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
    match layer {
        Layer::Points { points, .. } => finite(points.as_flattened()),
        Layer::Line { .. } | Layer::Question(_) => true,
        Layer::Segments { segments, .. } => finite(segments.as_flattened().as_flattened()),
        Layer::Walls(walls) => finite(walls.as_flattened().as_flattened()),
        Layer::Seen { from, points, .. } => finite(from) && finite(points.as_flattened()),
        Layer::Threads { threads, reach } => {
            finite(threads.as_flattened().as_flattened()) && reach.is_finite()
        }
        Layer::Pose { pose, .. } => finite(pose),
        Layer::Handle { at, .. } | Layer::Text { at, .. } | Layer::Label { at, .. } => finite(at),
        Layer::Ellipse {
            center, half_axes, ..
        } => finite(center) && finite(half_axes.as_flattened()),
        Layer::Raster(raster) => {
            raster.cells.len() == raster.columns * raster.rows
                && raster.cells.iter().all(|cell| match cell {
                    RasterCell::Level(level) | RasterCell::Occupancy(level) => level.is_finite(),
                    RasterCell::Relief { level, light } => level.is_finite() && light.is_finite(),
                    RasterCell::Unknown | RasterCell::Class(_) => true,
                })
        }
    }
}
