//! The trace over all orthogonal matrices, without its picture.

use ch16_lab::procrustes::{Pairs, Shape};
use pr_geom::Point2;
use widget_kit::model::{Activity, Assessment, Handle, Model, Motion};
use widget_kit::scene::Layer;
use widgets::w16_11_procrustes::model::{ProcrustesTrace, panel};
use widgets::w16_11_procrustes::spec::{SPEC, WHOLE_TURN_DEG};

use crate::support::fact;

fn with(values: &[(&str, f64)]) -> ProcrustesTrace {
    let mut trace = ProcrustesTrace::default();
    trace.reveal();
    for (id, value) in values {
        trace.set(id, *value).unwrap();
    }
    trace
}

fn title(trace: &ProcrustesTrace, id: &str) -> String {
    let panels = trace.scene().panels;
    let panel = panels.into_iter().find(|panel| panel.id == id);
    panel.expect(id).title
}

#[test]
fn four_corners_are_rotated_and_the_trace_peaks_at_the_alignment() {
    let mut trace = with(&[("shape", 0.0)]);
    assert_eq!(trace.outcome().verdict, "a turn fits best");
    let bound = fact(&trace, "bound_m2");
    assert!((fact(&trace, "turn_trace_m2") - bound).abs() < 1e-12);
    assert!(fact(&trace, "mirror_trace_m2") < bound);
    // The true rotation is 40°; 2° are five deviations of the noise over a metre.
    let top = fact(&trace, "aligned_deg").round();
    assert!((top - 40.0).abs() <= 2.0);
    trace.set("turn", top).unwrap();
    assert!(fact(&trace, "trace_m2") > 0.9999 * bound);
    trace.set("turn", top + 180.0).unwrap();
    assert!(fact(&trace, "trace_m2") < -0.9999 * bound);
}

#[test]
fn two_points_fit_a_rotation_and_a_reflection_equally() {
    let trace = with(&[("shape", 1.0)]);
    assert_eq!(trace.outcome().verdict, "turn and mirror image tie");
    assert!((fact(&trace, "turn_cost_m2") - fact(&trace, "mirror_cost_m2")).abs() < 1e-12);
}

/// The outcome while the second target point comes ever closer to the first.
#[test]
fn coincident_points_measure_no_heading() {
    let seed = with(&[]).values().number("seed") as u32;
    let [first, second] = Pairs::seen(Shape::Two, seed).target[..] else {
        panic!("two points")
    };
    for apart_m in [1.0, 0.01, 0.0] {
        let off = [
            ("x2", first.x - second.x + apart_m),
            ("y2", first.y - second.y),
        ];
        let outcome = with(&[("shape", 1.0), off[0], off[1]]).outcome();
        let is_admitted = outcome.sentence.contains("No pair measures the heading");
        assert_eq!(
            is_admitted,
            apart_m == 0.0,
            "{apart_m} m: {}",
            outcome.sentence
        );
        assert_eq!(outcome.standing == Assessment::Bad, is_admitted);
    }
}

#[test]
fn a_sensor_upside_down_is_matched_by_a_reflection_and_not_by_the_alignment() {
    let trace = with(&[("shape", 3.0)]);
    assert_eq!(trace.outcome().verdict, "a mirror image fits best");
    assert!(fact(&trace, "mirror_cost_m2") < 0.01 * fact(&trace, "turn_cost_m2"));
    assert_eq!(title(&trace, panel::MAP_TURN), "By svd_align: det +1");
    assert_eq!(title(&trace, panel::MAP_UNCHECKED), "Unchecked: det −1");
}

#[test]
fn the_two_maps_are_equal_if_a_rotation_fits_best_and_mirrored_otherwise() {
    let walls = |trace: &ProcrustesTrace, id: &str| {
        let panels = trace.scene().panels;
        let panel = panels.into_iter().find(|panel| panel.id == id).unwrap();
        let Some(Layer::Segments { segments, .. }) = panel.layers.into_iter().next() else {
            panic!("walls come first");
        };
        segments
    };
    let both = |trace: &ProcrustesTrace| {
        [panel::MAP_TURN, panel::MAP_UNCHECKED].map(|id| walls(trace, id))
    };
    let [turned, unchecked] = both(&with(&[("shape", 0.0)]));
    assert_eq!(turned, unchecked);
    // The first two walls span a parallelogram whose sign is the handedness.
    let sign = |walls: &[[[f64; 2]; 2]]| {
        let along = |k: usize| [0, 1].map(|i| walls[k][1][i] - walls[k][0][i]);
        let (a, b) = (along(0), along(2));
        (a[0] * b[1] - a[1] * b[0]).signum()
    };
    let [turned, mirrored] = both(&with(&[("shape", 3.0)]));
    assert_eq!(sign(&turned), -sign(&mirrored));
}

#[test]
fn a_point_of_the_target_is_dragged_and_the_answer_follows() {
    let mut trace = with(&[("shape", 0.0)]);
    let seen = Pairs::seen(Shape::Corners, 1).target;
    let at = |p: Point2<f64>| [p.x, p.y];
    let before = fact(&trace, "aligned_deg");
    let handle = trace
        .grab(panel::POINTS, [seen[1].x + 0.02, seen[1].y], [0.1, 0.1])
        .unwrap();
    trace.drag(handle, [seen[1].x + 0.52, seen[1].y - 0.3]);
    assert_eq!(trace.values().number("x2"), 0.5);
    assert_eq!(trace.values().number("y2"), -0.3);
    assert!((fact(&trace, "aligned_deg") - before).abs() > 1.0);
    // If the whole target is dragged into its mirror image, the reflection fits best.
    for (index, point) in seen.iter().enumerate() {
        let offset = [0.0; 2];
        let handle = Handle {
            index,
            offset,
            ..handle
        };
        trace.drag(handle, at(Point2::new(-point.x, point.y)));
    }
    assert_eq!(trace.outcome().verdict, "a mirror image fits best");
    trace.drag(handle, [f64::NAN, 0.0]);
    trace.drag(handle, [1e300, -1e300]);
    assert_eq!(trace.values().number("x2"), 3.0);
    assert!(
        trace
            .grab(panel::MAP_TURN, at(seen[0]), [0.1, 0.1])
            .is_none()
    );
    assert!(trace.grab(panel::POINTS, [9.0, 9.0], [0.1, 0.1]).is_none());
}

#[test]
fn the_angle_is_dragged_along_the_trace() {
    let mut trace = with(&[("turn", 100.0)]);
    let handle = trace.grab(panel::TRACE, [101.0, 0.0], [3.0, 1.0]).unwrap();
    trace.drag(handle, [220.6, 0.0]);
    assert_eq!(trace.values().number("turn"), 220.0);
    trace.drag(handle, [900.0, 0.0]);
    assert_eq!(trace.values().number("turn"), WHOLE_TURN_DEG);
}

#[test]
fn playing_goes_once_around_and_ends() {
    let mut trace = ProcrustesTrace::default();
    trace.press("play").unwrap();
    let mut frames = 0;
    while trace.advance(0.1) == Activity::Busy {
        frames += 1;
    }
    // 360° at 60° a second, ten frames a second.
    assert!((60..=61).contains(&frames), "{frames}");
    assert_eq!(trace.values().number("turn"), WHOLE_TURN_DEG);
    trace.set_motion(Motion::Reduced);
    trace.press("two-points").unwrap();
    assert_eq!(trace.advance(0.1), Activity::Idle);
}

#[test]
fn every_preset_does_what_its_button_claims() {
    let verdict = |id: &str| {
        let mut trace = ProcrustesTrace::default();
        trace.press(id).unwrap();
        trace.outcome().verdict
    };
    assert_eq!(verdict("corners"), "a turn fits best");
    assert_eq!(verdict("two-points"), "turn and mirror image tie");
    assert_eq!(verdict("bare-wall"), "a mirror image fits best");
    assert_eq!(verdict("upside-down"), "a mirror image fits best");
    assert_eq!(SPEC.presets.len(), 4, "a preset without a test");
}

#[test]
fn the_mirrored_flat_and_the_waves_are_drawn_once_the_reader_acts() {
    let mut trace = ProcrustesTrace::default();
    assert_eq!(trace.outcome().verdict, "a mirror image fits best");
    assert_eq!(title(&trace, panel::MAP_TURN), "By svd_align: det +1");
    assert!(title(&trace, panel::MAP_UNCHECKED).ends_with("det ?"));
    let waves = |trace: &ProcrustesTrace| {
        let panels = trace.scene().panels;
        let wave = panels.iter().find(|panel| panel.id == panel::TRACE);
        let layers = wave.expect("a wave").layers.iter();
        layers
            .filter(|layer| matches!(layer, Layer::Line { points, .. } if points.len() > 2))
            .count()
    };
    assert_eq!(waves(&trace), 0);
    trace.reveal();
    assert_eq!(waves(&trace), 2);
    assert!(title(&trace, panel::MAP_UNCHECKED).ends_with("det −1"));
}
