//! Errors along the path: what a loop improves in the middle.

use ch16_lab::lap::{LapConfig, LapRunner, PATH_SHARES};
use ch16_slam2d::metrics::position_error_m;

#[test]
fn the_path_begins_at_the_start_and_the_turn_is_halfway() {
    let record = LapRunner::new().run(&LapConfig::default());
    let path = record.path_errors();
    assert_eq!(path.errors_m[0], 0.0);
    let last = record.lap.summary.keyframe_end_error_m;
    assert!((path.errors_m[PATH_SHARES] - last).abs() < 0.1 * last);
    // Down the corridor and back: the turn is halfway, and the chapter's page says that its error does not
    // change.
    let turn = record.lap.turn_node.expect("the lap turns");
    let errors: Vec<f64> = record.lap.keyframe_errors_m(record.ticks()).collect();
    assert!((path.half_path_length_m() - errors[turn]).abs() < 0.1);
}

#[test]
fn a_loop_reduces_the_deviation_halfway() {
    let record = LapRunner::new().run(&LapConfig::default());
    assert!(record.lap.graph_summary.loops > 0);
    assert!(
        record.path_errors().half_way_sigma_m < record.front_end_path_errors().half_way_sigma_m
    );
    let fixed = record.lap.graph(record.ticks()).pose_covariances().unwrap()[0];
    assert_eq!(fixed.abs().max(), 0.0, "the first pose is held");
    assert_eq!(
        position_error_m(&record.lap.poses(0)[0], &record.config.drive.start),
        0.0
    );
}
