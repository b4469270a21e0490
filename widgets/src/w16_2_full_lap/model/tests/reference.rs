//! Against the reference laps of an independent implementation, and the claims about them.

use serde_json::Value;

use super::*;

/// The nine reference laps, by an independent implementation of the same system.
fn reference_laps() -> Vec<Value> {
    let text = include_str!("../../../../../tests/reference/lap.json");
    serde_json::from_str(text).expect("the reference is a list of laps")
}

fn number(value: &Value, key: &str) -> f64 {
    value[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no number `{key}`"))
}

#[test]
fn every_reference_lap_follows_from_its_settings() {
    let mut model = FullLap::default();
    for lap in reference_laps() {
        set(&mut model, "seed", number(&lap, "seed"));
        set(&mut model, "noise", number(&lap, "noise"));
        let loops = lap["loops"].as_bool().unwrap();
        set(&mut model, "loops", f64::from(u8::from(loops)));
        let last = model.last();
        set(&mut model, "t", last);

        // 1e-6: a whole lap; sums in another order differ in the last bits and ICP amplifies them.
        let close = |ours: f64, key: &str| {
            let theirs = number(&lap, key);
            assert!(
                (ours - theirs).abs() < 1e-6,
                "{key}: {ours} for {theirs}, {lap:.0}"
            );
        };
        let results = results(&model);
        close(results.graph.odometry_end_error_m, "odometry_end_error");
        close(results.graph.odometry_rms_m, "odometry_rms");
        close(results.graph.keyframe_end_error_m, "keyframe_end_error");
        close(results.graph.keyframe_rms_m, "keyframe_rms");
        close(
            results.graph.map_disagreement_m.unwrap(),
            "map_disagreement",
        );
        assert_eq!(fact(&model, "keyframes"), number(&lap, "keyframes"));

        let events = lap["events"].as_array().unwrap();
        let attempts = model.runs.graph.attempts();
        assert_eq!(attempts.len(), events.len());
        for (attempt, event) in attempts.iter().zip(events) {
            let loop_ = &attempt.verification;
            assert_eq!(loop_.from_node as f64, number(event, "from"));
            assert_eq!(loop_.candidate.node as f64, number(event, "to"));
            assert!((loop_.gate.chi2 - number(event, "chi2")).abs() < 1e-6);
            assert!((loop_.rmse_m - number(event, "rmse")).abs() < 1e-6);
            assert_eq!(loop_.inliers as f64, number(event, "inliers"));
            assert_eq!(attempt.accepted(), event["accepted"].as_bool().unwrap());
            if let Some(effect) = attempt.effect {
                assert!((effect.max_shift_m - number(event, "max_shift")).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn at_every_tick_the_poses_are_those_of_the_reference() {
    let mut model = FullLap::default();
    for lap in reference_laps() {
        set(&mut model, "seed", number(&lap, "seed"));
        set(&mut model, "noise", number(&lap, "noise"));
        let loops = lap["loops"].as_bool().unwrap();
        set(&mut model, "loops", f64::from(u8::from(loops)));
        for (index, reference) in lap["per_tick"].as_array().unwrap().iter().enumerate() {
            let tick = index + 1;
            let shown = [
                ("truth", model.runs.truth(tick)),
                ("dead_reckoning", model.runs.dead_reckoning(tick)),
                ("estimate", model.runs.graph.estimate(tick)),
            ];
            for (key, pose) in shown {
                for (i, ours) in pose.to_array().into_iter().enumerate() {
                    let theirs = reference[key][i].as_f64().unwrap();
                    assert!(
                        (ours - theirs).abs() < 1e-6,
                        "{key} at {tick}: {ours}, {theirs}"
                    );
                }
            }
        }
        let last = model.runs.graph.poses_at(model.runs.ticks());
        for (node, pose) in last.iter().enumerate() {
            let theirs = lap["keyframe_poses"][node][0].as_f64().unwrap();
            assert!((pose.x() - theirs).abs() < 1e-6, "node {node}");
        }
    }
}

#[test]
fn the_canonical_table_is_the_chapters() {
    // The chapter's results table.
    let expected = [
        ["newest keyframe", "2.4110", "0.7334", "0.2389"],
        ["rms", "1.1826", "0.6444", "0.5857"],
        ["last nine keyframes", "", "0.54–0.75", "0.17–0.34"],
        ["largest", "", "0.85", "0.89"],
        ["map disagreement", "", "0.2377", "0.0817"],
    ];
    let mut model = at(&[("t", 129.0)]);
    assert_eq!(table(&model, "canonical"), expected);
    assert_eq!(table(&model, "run"), expected);
    set(&mut model, "seed", 3.0);
    assert_eq!(table(&model, "canonical"), expected);
    assert_ne!(table(&model, "run"), expected);
}

#[test]
fn the_notes_about_the_canonical_run_are_right() {
    let model = FullLap::default();
    let ResultsTable {
        front_end, graph, ..
    } = results(&model);
    let third = graph.map_disagreement_m.unwrap() / front_end.map_disagreement_m.unwrap();
    assert!((0.30..0.37).contains(&third), "about a third: {third}");
    let change = graph.keyframe_rms_m / front_end.keyframe_rms_m;
    assert!((0.9..1.0).contains(&change), "hardly changes: {change}");
    assert!(
        graph.keyframe_max_m > front_end.keyframe_max_m,
        "grows a little"
    );
    assert!(
        graph.keyframe_max_m < 1.1 * front_end.keyframe_max_m,
        "a little"
    );
    // "Almost a metre too short": the worst node is at the far end and before the truth.
    let nodes = model.runs.graph.poses_at(model.runs.ticks());
    let truth = |node: usize| model.runs.truth(model.runs.graph.keyframe_tick(node));
    let error = |node: &usize| {
        (nodes[*node].x() - truth(*node).x()).hypot(nodes[*node].y() - truth(*node).y())
    };
    let worst = (0..nodes.len())
        .max_by(|a, b| error(a).total_cmp(&error(b)))
        .unwrap();
    assert!(truth(worst).x() > 10.0);
    let short = truth(worst).x() - nodes[worst].x();
    assert!((0.8..1.0).contains(&short), "{short}");
    let limits = model.runs.loop_config();
    assert_eq!((limits.max_rmse_m, limits.min_inliers), (0.16, 25));
}
