//! Other estimators on the command line.

use serde_json::Value;

use crate::support::{assert_rejected, json};

#[test]
fn every_estimator_drives_the_lap_and_each_is_another_one() {
    let laps: Vec<_> = ["graph", "front-end", "ml", "ml-cycles"]
        .iter()
        .map(|name| json(&["lap", "--estimator", name, "--json"]))
        .collect();
    for (k, lap) in laps.iter().enumerate() {
        let end = lap["keyframe_end_error_m"].as_f64().unwrap();
        assert!(end < 0.7 * lap["odometry_end_error_m"].as_f64().unwrap());
        assert_eq!(lap["odometry_rms_m"], laps[0]["odometry_rms_m"]);
        assert!(
            laps[..k]
                .iter()
                .all(|other| other["digest"] != lap["digest"])
        );
    }
    assert_eq!(laps[0]["digest"], json(&["lap", "--json"])["digest"]);
    assert_eq!(
        laps[1]["digest"],
        json(&["lap", "--no-loops", "--json"])["digest"]
    );
    assert_eq!(laps[2]["events"].as_array().unwrap().len(), 0);
    let tests = laps[3]["events"].as_array().unwrap();
    assert!(
        tests
            .iter()
            .any(|test| test["verdict"] == "confirmed" || test["verdict"]["closed"].is_object())
    );
}

#[test]
fn a_sweep_has_the_columns_that_were_asked_for() {
    let columns = |estimators: &[&str]| {
        let mut args = vec!["sweep", "--seeds", "1..=2", "--noise", "1", "--json"];
        args.extend(estimators);
        let levels = json(&args);
        let entries = levels[0]["entries"].as_array().unwrap().clone();
        let mut columns: Vec<String> = entries
            .iter()
            .map(|entry| entry["column"].as_str().unwrap().to_owned())
            .collect();
        columns.dedup();
        columns
    };
    let three = ["odometry", "front_end", "with_loops"];
    assert_eq!(columns(&[]), three);
    assert_eq!(columns(&["--estimator", "ml"]), ["odometry", "ml"]);
    assert_eq!(
        columns(&["--estimator", "front-end"]),
        ["odometry", "front_end"]
    );
    let five = [&three[..], &["ml", "ml_cycles"]].concat();
    assert_eq!(columns(&["--estimator", "graph,ml,ml-cycles"]), five);
}

#[test]
fn arguments_without_effect_on_an_estimator_are_rejected() {
    assert_rejected(
        &["lap", "--estimator", "ml", "--matcher", "ndt"],
        "--matcher has no effect on the estimator ml",
    );
    assert_rejected(
        &[
            "sweep",
            "--estimator",
            "ml,ml-cycles",
            "--detector",
            "context",
        ],
        "--detector has no effect on ml, ml-cycles",
    );
    assert_rejected(&["lap", "--estimator", "kalman"], "kalman");
}

#[test]
fn the_estimator_for_logs_drives_another_lap_and_is_not_of_incremental_mapping() {
    let window = json(&["lap", "--json"]);
    let named = json(&["lap", "--front-end", "window", "--json"]);
    assert_eq!(window["digest"], named["digest"]);
    let local_map = json(&["lap", "--front-end", "local-map", "--json"]);
    assert_ne!(window["digest"], local_map["digest"]);
    let ends = ["keyframe_end_error_m", "odometry_end_error_m"]
        .map(|end| local_map[end].as_f64().unwrap());
    assert!(ends[0] < 0.7 * ends[1], "{ends:?}");
    let rejected = ["lap", "--estimator", "ml", "--front-end", "local-map"];
    assert_rejected(&rejected, "--front-end has no effect on the estimator ml");
}

#[test]
fn the_gate_with_the_graphs_own_covariance_lets_pass_what_the_path_gate_turns_away() {
    // A lap that drifts more than the path's gate allows for.
    let lap = |gate: &[&str]| {
        let asked = [&["lap", "--seed", "2", "--noise", "3", "--json"][..], gate].concat();
        json(&asked)
    };
    // Of the attempts, those accepted; a rejected one has a reason and no effect.
    let accepted = |lap: &Value| {
        let events = lap["events"].as_array().unwrap();
        assert!(!events.is_empty());
        let accepted = events.iter().filter(|event| {
            let is_accepted = event["accepted"].as_bool().unwrap();
            assert_eq!(event["effect"].is_object(), is_accepted);
            let reason = event["reason"].as_str().unwrap_or_default();
            assert_eq!(reason.is_empty(), is_accepted, "{event}");
            is_accepted
        });
        accepted.count()
    };
    let default = lap(&[]);
    let (path, exact) = (lap(&["--gate", "path"]), lap(&["--gate", "exact"]));
    assert_eq!(default["digest"], path["digest"]);
    assert_eq!((accepted(&path), accepted(&exact)), (0, 3));
    assert_rejected(&["lap", "--gate", "wide"], "wide");
    let rejected = ["lap", "--estimator", "ml", "--gate", "exact"];
    assert_rejected(&rejected, "--gate has no effect on the estimator ml");
}
