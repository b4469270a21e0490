//! Against the laps of the library, and the claims about the chapter's.

use ch16_lab::lap::{LapConfig, LapRunner};

use super::*;

/// `tests/pinned/lap.rs` compares the library's laps with those of an independent implementation.
#[test]
fn a_lap_is_the_librarys_with_the_same_settings() {
    let mut model = FullLap::default();
    for (seed, noise, loops) in [(0xC0_FFEE, 1.0, true), (6, 2.0, true), (3, 1.0, false)] {
        set(&mut model, "seed", f64::from(seed));
        set(&mut model, "noise", noise);
        set(&mut model, "loops", f64::from(u8::from(loops)));
        let config = LapConfig::with_seed_and_noise(seed, noise);
        let config = if loops {
            config
        } else {
            config.without_loops()
        };
        let record = LapRunner::new().run(&config);
        assert_eq!(model.runs.graph.lap(), &record.lap, "seed {seed}");
        assert_eq!(model.runs.front_end.lap(), &record.front_end, "seed {seed}");
        for (index, driven) in record.drive.ticks().iter().enumerate() {
            assert_eq!(model.runs.truth(index + 1), driven.truth);
            assert_eq!(model.runs.dead_reckoning(index + 1), driven.dead_reckoning);
        }
        let last = model.last();
        set(&mut model, "t", last);
        assert_eq!(fact(&model, "keyframes"), record.lap.keyframes.len() as f64);
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
