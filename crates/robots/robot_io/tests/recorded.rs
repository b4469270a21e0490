//! Recorded logs, mapped with the default parameters and evaluated.
//!
//! The recordings have no licence and are not part of the project. If the folder with the reference data is absent,
//! these tests report it and pass.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

use bench_support::skip::{NO_RECORDED_LOGS, skip};
use robot_io::evaluate::relation_errors;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::relations::read_relations;
use robot_io::run::LogRun;

pub fn open(name: &str) -> Option<BufReader<File>> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/logs");
    File::open(folder.join(name)).ok().map(BufReader::new)
}

/// Runs the estimator on the whole log; `None` without the data.
fn mapped(log: &'static str, has_odometry: bool) -> Option<LogRun> {
    open(log)?;
    let bytes = LogBytes::new(move || Ok(open(log).expect("it was there")));
    let mut reader = LogFormat::open(bytes, log, &LogOptions::default()).unwrap();
    let mut run = LogRun::default();
    while let Some(mut frame) = reader.next_frame().unwrap() {
        frame.odometry = frame.odometry.filter(|_| has_odometry);
        run.step(frame);
    }
    run.finish();
    Some(run)
}

/// Mean ‖t‖ over the reference relations, m.
fn intel_mean_m(run: &LogRun) -> f64 {
    let name = "intel.relations";
    let relations = open(name).expect("the relations lie beside the log");
    let relations = read_relations(relations, name).unwrap();
    let errors = relation_errors(&run.trajectory(), &relations);
    assert_eq!(errors.outside, 0);
    errors.report().trans.mean
}

#[test]
fn intel_is_mapped_to_eight_centimetres_with_its_loops() {
    let Some(run) = mapped("intel.clf", true) else {
        return skip("the errors on Intel", NO_RECORDED_LOGS);
    };
    let mean_m = intel_mean_m(&run);
    // A trajectory that follows the scans perfectly has an error of 0.06 to 0.08: README of the data.
    assert!(mean_m <= 0.08, "{mean_m}");
    let closed = run.loops().iter().filter(|tried| tried.accepted).count();
    // Three rounds through the same corridors and most of the rooms: 405 when this was written.
    assert!(closed >= 300, "{closed}");
}

#[test]
fn intel_without_odometry_is_mapped_to_eight_centimetres() {
    let Some(run) = mapped("intel.clf", false) else {
        return skip("the errors on Intel by scans alone", NO_RECORDED_LOGS);
    };
    let mean_m = intel_mean_m(&run);
    // The same bound as with odometry.
    assert!(mean_m <= 0.08, "{mean_m}");
}

#[test]
fn duke_closes_its_loop() {
    let Some(run) = mapped("duke-loop5.clf", true) else {
        return skip("the loop of Duke", NO_RECORDED_LOGS);
    };
    let closed: Vec<(usize, usize)> = run
        .loops()
        .iter()
        .filter(|tried| tried.accepted)
        .map(|tried| {
            (
                tried.verification.candidate.node,
                tried.verification.from_node,
            )
        })
        .collect();
    let slam = run.slam().unwrap();
    let poses = slam.graph().poses();
    let last = poses.len() - 1;
    let around = closed
        .iter()
        .filter(|(old, new)| *old < 20 && *new > last - 20);
    assert_eq!(around.count(), 1, "{closed:?}");
}
