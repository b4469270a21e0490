//! The toy without its picture; reference values from the chapter's worked example.

use widget_kit::model::{Activity, Assessment, Model};
use widget_kit::scene::{Layer, Tone};
use widgets::w16_5_pose_graph_toy::model::{PoseGraphToy, panel};
use widgets::w16_5_pose_graph_toy::spec::SPEC;

use crate::support::fact;

/// The chapter's three poses, with these values.
fn with(values: &[(&str, f64)]) -> PoseGraphToy {
    let mut toy = PoseGraphToy::default();
    toy.set("graph", 0.0).unwrap();
    for (id, value) in values {
        toy.set(id, *value).unwrap();
    }
    toy
}

fn springs(toy: &PoseGraphToy) -> Vec<f64> {
    let tables = toy.tables();
    let table = tables.iter().find(|table| table.id == "springs").unwrap();
    let chi2 = table.rows.iter().map(|row| row[5].parse().unwrap());
    chi2.collect()
}

#[test]
fn one_step_takes_the_chapters_three_poses_from_0_36_to_0_12() {
    let mut toy = with(&[]);
    assert!((fact(&toy, "chi2") - 0.36).abs() < 1e-12);
    assert_eq!(springs(&toy), [0.0, 0.0, 0.36]);
    toy.press("step").unwrap();
    assert!((fact(&toy, "chi2") - 0.12).abs() < 1e-9);
    assert_eq!(springs(&toy), [0.04, 0.04, 0.04]);
    assert!((fact(&toy, "last_x_m") - 2.4).abs() < 1e-9);
    assert_eq!(toy.outcome().verdict, "at rest");
    assert_eq!(toy.timeline().unwrap().last, 1.0);
    let sentence = toy.outcome().sentence;
    assert!(
        sentence.ends_with("every spring has the same share, 0.040"),
        "{sentence}"
    );
}

#[test]
fn a_loop_that_disagrees_by_twice_as_much_costs_four_times_as_much() {
    // χ² is 0.36 at the chapter's gap of 0.6 m.
    for (gap_m, chi2) in [(0.0, 0.0), (0.3, 0.09), (1.2, 1.44)] {
        assert!((fact(&with(&[("gap", gap_m)]), "chi2") - chi2).abs() < 1e-12);
    }
}

#[test]
fn a_stiff_loop_gives_way_less() {
    let left = |stiffness: f64| {
        let toy = with(&[("stiffness", stiffness), ("steps", 20.0)]);
        2.6 - fact(&toy, "last_x_m")
    };
    // Two springs of stiffness 1 in a row are one of 1/2: the loop's share is 0.6/(1 + 2 s).
    for stiffness in [0.1, 1.0, 10.0] {
        let expected = 0.6 / (1.0 + 2.0 * stiffness);
        assert!((left(stiffness) - expected).abs() < 1e-6, "{stiffness}");
    }
}

#[test]
fn without_a_fixed_pose_the_graph_has_the_same_cost_elsewhere() {
    let pinned = with(&[("x3", 1.0), ("steps", 20.0)]);
    let free = with(&[("x3", 1.0), ("pinned", 0.0), ("steps", 20.0)]);
    for toy in [&pinned, &free] {
        assert!((fact(toy, "chi2") - 0.12).abs() < 1e-6);
    }
    assert!((fact(&free, "last_x_m") - fact(&pinned, "last_x_m")).abs() > 0.1);
    assert!(free.outcome().sentence.contains("no pose is pinned"));
}

#[test]
fn a_dragged_pose_is_the_new_start_and_the_others_keep_theirs() {
    let mut toy = with(&[]);
    toy.press("step").unwrap();
    let handle = toy.grab(panel::GRAPH, [2.4, 0.0], [0.1, 0.1]).unwrap();
    toy.drag(handle, [2.4, 1.0]);
    assert_eq!(toy.values().number("steps"), 0.0);
    // Shown at 1.2 and 2.4; by odometry they are at 1 and 2.
    for (id, value) in [("x2", 0.2), ("x3", 0.4), ("y3", 1.0), ("y2", 0.0)] {
        assert!((toy.values().number(id) - value).abs() < 1e-9, "{id}");
    }
    assert!(fact(&toy, "chi2") > 1.0);
    let tip = toy.grab(panel::GRAPH, [2.7, 1.0], [0.05, 0.05]).unwrap();
    toy.drag(tip, [2.4, 2.0]);
    assert!((toy.values().number("turn3") - 90.0).abs() < 0.1);
}

#[test]
fn a_drag_to_nan_moves_no_pose_and_a_far_one_is_limited() {
    let mut toy = with(&[]);
    let handle = toy.grab(panel::GRAPH, [1.0, 0.0], [0.1, 0.1]).unwrap();
    let before = toy.values().clone();
    toy.drag(handle, [f64::NAN, 0.0]);
    toy.drag(handle, [f64::INFINITY, 0.0]);
    assert_eq!(&before, toy.values());
    toy.drag(handle, [1e300, -1e300]);
    assert_eq!(toy.values().number("x2"), 3.0);
    assert_eq!(toy.values().number("y2"), -3.0);
}

#[test]
fn every_preset_does_what_its_button_claims() {
    for (id, rest) in [
        ("three-poses", "0.12"),
        ("unpinned", "0.12"),
        ("stiff", ""),
        ("square", ""),
        ("tangled", ""),
    ] {
        let mut toy = PoseGraphToy::default();
        toy.press(id).unwrap();
        while toy.advance(0.2) == Activity::Busy {}
        assert_eq!(toy.outcome().standing, Assessment::Good, "{id}");
        let preset = SPEC.presets.iter().find(|preset| preset.id == id).unwrap();
        if !rest.is_empty() {
            assert_eq!(format!("{:.2}", fact(&toy, "chi2")), rest, "{id}");
            assert!(preset.help.contains(rest), "{id}");
        }
        assert!(fact(&toy, "chi2") < fact(&toy, "chi2_start"), "{id}");
    }
    assert_eq!(SPEC.presets.len(), 5, "a preset without a test");
    let mut tangled = PoseGraphToy::default();
    tangled.press("tangled").unwrap();
    assert!(
        fact(&tangled, "steps_to_rest") > 2.0,
        "headings bend the problem"
    );
}

#[test]
fn it_opens_with_a_ring_whose_ends_do_not_meet_and_the_springs_close_it() {
    let mut toy = PoseGraphToy::default();
    let apart = |toy: &PoseGraphToy| fact(toy, "last_x_m").hypot(fact(toy, "last_y_m"));
    assert!((apart(&toy) - 0.6).abs() < 1e-9, "{}", apart(&toy));
    assert_eq!(springs(&toy), [0.0, 0.0, 0.0, 0.0, 0.0, 0.36]);
    toy.set("steps", 20.0).unwrap();
    assert!(apart(&toy) < 0.15, "{}", apart(&toy));
}

/// Positions of the draggable poses on screen, m.
fn seen(toy: &PoseGraphToy) -> Vec<[f64; 2]> {
    let scene = toy.scene();
    let handles = scene.panels[0]
        .layers
        .iter()
        .filter_map(|layer| match layer {
            Layer::Handle {
                at,
                tone: Tone::Posterior,
                ..
            } => Some(*at),
            _ => None,
        });
    handles.collect()
}

#[test]
fn a_released_pose_springs_back_a_step_a_beat() {
    let mut toy = with(&[]);
    let handle = toy.grab(panel::GRAPH, [2.0, 0.0], [0.1, 0.1]).unwrap();
    toy.drag(handle, [2.0, 1.0]);
    let axes = |toy: &PoseGraphToy| {
        let graph = &toy.scene().panels[0];
        (graph.x.clone(), graph.y.clone())
    };
    let held = axes(&toy);
    toy.drag(handle, [2.0, 2.5]);
    assert_eq!(axes(&toy), held, "the axes stay while a pose is dragged");
    let pulled = seen(&toy)[2];
    assert_eq!(pulled, [2.0, 2.5]);
    toy.release();
    toy.advance(0.2);
    assert_eq!(toy.values().number("steps"), 0.0, "within the first beat");
    let moving = seen(&toy)[2];
    assert!(moving[1] < pulled[1] && moving[1] > 0.5, "{moving:?}");
    while toy.advance(0.2) == Activity::Busy {}
    assert_eq!(toy.outcome().verdict, "at rest");
    assert!(fact(&toy, "last_y_m").abs() < 0.1);
}

#[test]
fn a_pose_that_does_not_exist_has_no_control() {
    let mut toy = with(&[("more", 1.0)]);
    assert!(toy.disclosure().has_param("turn3") && !toy.disclosure().has_param("x4"));
    toy.set("graph", 2.0).unwrap();
    assert!(toy.disclosure().has_param("turn6"));
}
