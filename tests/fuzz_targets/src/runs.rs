//! Guarantees of every run of the estimator, for any input.

use pr_geom::SE2;
use robot_io::log::LogFrame;
use robot_io::run::LogRun;
use robot_io::session::Session;

use crate::sentences::{NAME, assert_sentence};

/// Processes some frames and ends: every pose is finite. Returns the saved session, if there is one.
pub fn drive(run: &mut LogRun, frames: impl IntoIterator<Item = LogFrame>) -> Option<Vec<u8>> {
    for frame in frames {
        if let Some(report) = run.step(frame) {
            assert_finite(&report.estimate);
        }
    }
    run.finish();
    for stamped in run.trajectory().poses() {
        assert_finite(&stamped.pose);
    }
    let quality = run.quality();
    let mut covariances = quality.keyframes.iter().map(|node| node.covariance);
    let is_finite = |row: [[f64; 3]; 3]| row.as_flattened().iter().all(|v| v.is_finite());
    assert!(covariances.all(is_finite), "{quality:?}");
    quality.doubts.iter().for_each(|said| assert_sentence(said));
    run.sentences(NAME)
        .iter()
        .for_each(|said| assert_sentence(said));
    run.session().map(|session| session.to_bytes())
}

/// A loaded session saves to the same bytes.
pub fn assert_loads(saved: &[u8]) {
    let loaded = Session::of_bytes(saved, NAME).expect("what a run saves can be loaded");
    assert!(loaded.to_bytes() == saved, "{loaded:?}");
}

/// Every number of a pose is finite.
pub fn assert_finite(pose: &SE2) {
    let is_finite = pose.to_array().iter().all(|value| value.is_finite());
    assert!(is_finite, "{pose:?}");
}
