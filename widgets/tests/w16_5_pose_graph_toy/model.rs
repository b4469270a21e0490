//! The toy without its picture; reference values from the chapter's worked example.

use kit::model::{Activity, Model, Standing};
use widgets::w16_5_pose_graph_toy::model::{PoseGraphToy, panel};
use widgets::w16_5_pose_graph_toy::spec::SPEC;

use crate::support::fact;

fn with(values: &[(&str, f64)]) -> PoseGraphToy {
    let mut toy = PoseGraphToy::default();
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
    let mut toy = PoseGraphToy::default();
    assert!((fact(&toy, "chi2") - 0.36).abs() < 1e-12);
    assert_eq!(springs(&toy), [0.0, 0.0, 0.36]);
    toy.press("step").unwrap();
    assert!((fact(&toy, "chi2") - 0.12).abs() < 1e-9);
    assert_eq!(springs(&toy), [0.04, 0.04, 0.04]);
    assert!((fact(&toy, "last_x_m") - 2.4).abs() < 1e-9);
    assert_eq!(toy.outcome().verdict, "at rest");
    assert_eq!(toy.timeline().unwrap().last, 1.0);
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
    assert!(free.outcome().sentence.contains("nothing is pinned"));
}

#[test]
fn a_dragged_pose_is_the_new_start_and_the_others_keep_theirs() {
    let mut toy = PoseGraphToy::default();
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
    let mut toy = PoseGraphToy::default();
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
        assert_eq!(toy.outcome().standing, Standing::Good, "{id}");
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
