//! Errors by place: what a loop mends in the middle of the way.

use ch16_lab::lap::{LapConfig, LapRunner, WAY_SHARES};
use ch16_slam2d::metrics::position_error_m;

#[test]
fn the_way_begins_at_the_start_and_half_of_it_is_the_turn() {
    let record = LapRunner::new().run(&LapConfig::default());
    let way = record.way_errors();
    assert_eq!(way.errors_m[0], 0.0);
    let last = record.lap.summary.keyframe_end_error_m;
    assert!((way.errors_m[WAY_SHARES] - last).abs() < 0.1 * last);
    // Down the corridor and back: the turn is half of the way, and the chapter's page says that
    // its error stays as it was.
    let turn = record.lap.turn_node.expect("the lap turns");
    let errors: Vec<f64> = record.lap.keyframe_errors_m(record.ticks()).collect();
    assert!((way.half_path_length_m() - errors[turn]).abs() < 0.1);
}

#[test]
fn a_loop_makes_the_graph_surer_of_half_of_the_way() {
    let record = LapRunner::new().run(&LapConfig::default());
    assert!(record.lap.summary.loops > 0);
    assert!(record.way_errors().half_way_sigma_m < record.front_end_way_errors().half_way_sigma_m);
    let fixed = record.lap.graph(record.ticks()).pose_covariances().unwrap()[0];
    assert_eq!(fixed.abs().max(), 0.0, "the first pose is held");
    assert_eq!(
        position_error_m(&record.lap.poses(0)[0], &record.config.drive.start),
        0.0
    );
}
