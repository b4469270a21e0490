//! Runs every example and checks its claim.

#[path = "../examples/align_two_clouds.rs"]
mod align_two_clouds;
#[path = "../examples/find_the_nearest.rs"]
mod find_the_nearest;
#[path = "../examples/optimize_a_graph.rs"]
mod optimize_a_graph;
#[path = "../examples/register_a_scan.rs"]
mod register_a_scan;
#[path = "../examples/run_slam_on_your_frames.rs"]
mod run_slam_on_your_frames;
#[path = "../examples/write_your_own_matcher.rs"]
mod write_your_own_matcher;

use ch16_slam2d::matching::IcpMatcher;
use ch16_slam2d::prelude::*;
use ch16_slam2d::scan::Frame;
use ch16_slam2d::slam::SlamConfig;

#[test]
fn the_robot_of_the_aligned_clouds_moved_straight() {
    // The room of the example moved by (−0.5, −0.2): the robot moved in the opposite direction.
    let expected = SE2::from_xy(0.5, 0.2);
    let motion = align_two_clouds::motion();
    assert!(expected.between(&motion).step_size() < 1e-12);
    align_two_clouds::main();
}

#[test]
fn nine_cells_hold_the_nearest_point_that_the_map_finds() {
    let tau_m = 0.3;
    // Points and queries all over 2 m × 2 m, on both sides of the origin, by two incommensurable
    // steps.
    let spread = |k: i32, step: f64| (f64::from(k) * step).fract() * 2.0 - 1.0;
    let at = |k: i32, steps: [f64; 2]| Point2::new(spread(k, steps[0]), spread(k, steps[1]));
    let points: Vec<_> = (1..80).map(|k| at(k, [0.618_034, 0.414_214])).collect();
    let cells = find_the_nearest::cells(&points, tau_m);
    let mut map = VoxelMap::new(tau_m, usize::MAX);
    map.insert(&points, &vec![None; points.len()]);
    let mut alone = 0;
    for k in 1..400 {
        let query = at(k, [0.732_051, 0.236_068]);
        let found = find_the_nearest::nearest(&cells, query, tau_m);
        let by_map = map.neighbor(query, tau_m);
        assert_eq!(found, by_map.map(|near| map.point(near.index)), "{query}");
        alone += usize::from(found.is_none());
    }
    assert!(alone < 200, "{alone} queries have no partner");
    let far = Point2::new(5.0, 5.0);
    assert_eq!(find_the_nearest::nearest(&cells, far, tau_m), None);
    find_the_nearest::main();
}

#[test]
fn along_walls_point_to_plane_ends_nearer_than_point_to_point() {
    let error = |variant| {
        let (found, information) = register_a_scan::register(variant);
        assert!(found.stop.converged(), "{variant:?}");
        assert!(information.cholesky().is_some(), "{variant:?}");
        register_a_scan::error(&found)
    };
    let to_point = error(IcpVariant::PointToPoint);
    let to_plane = error(IcpVariant::PointToPlane);
    // The points of map and scan are up to 2 cm apart along the walls: only their normals agree.
    assert!(to_point < 0.1, "{to_point}");
    assert!(to_plane < 0.1 * to_point, "{to_plane} of {to_point}");
    register_a_scan::main();
}

#[test]
fn the_loop_moves_the_end_of_the_graph_to_the_start() {
    let (mut graph, nodes) = optimize_a_graph::drive();
    let before_m = optimize_a_graph::gap_m(&graph, &nodes);
    assert!(graph.chi2() < 1e-12, "odometry alone contradicts nothing");
    optimize_a_graph::close_the_loop(&mut graph, &nodes);
    let after_m = optimize_a_graph::gap_m(&graph, &nodes);
    assert!(before_m > 0.2 && after_m < 0.1 * before_m);
    assert!(graph.chi2() > 1.0, "it is shared out, not gone");
    optimize_a_graph::main();
}

#[test]
fn the_path_of_the_frames_is_tracked_despite_odometry_drift() {
    let pipeline = run_slam_on_your_frames::run().unwrap();
    let start = run_slam_on_your_frames::truth(0);
    let off_m = |pose: SE2, step| {
        let truth: SE2 = start.between(&run_slam_on_your_frames::truth(step));
        (pose.translation() - truth.translation()).norm()
    };
    // The odometry alone has an error of 1.2 rad.
    let odometry_m = off_m(run_slam_on_your_frames::odometry(120), 120);
    assert!(odometry_m > 0.5, "{odometry_m}");
    for (step, (_, pose)) in pipeline.trajectory().enumerate() {
        let error_m = off_m(pose, step);
        assert!(error_m < 0.2 * odometry_m, "{error_m} of {odometry_m}");
    }
    run_slam_on_your_frames::main();
}

#[test]
fn a_matcher_with_many_headings_converges_where_icp_does_not() {
    let config = SlamConfig::default();
    let mut icp = IcpMatcher::with_variant(IcpVariant::PointToPoint, &config.chapter.local_map);
    let alone = write_your_own_matcher::off_rad(&mut icp);
    let mut many = write_your_own_matcher::ManyHeadings(icp);
    let around = write_your_own_matcher::off_rad(&mut many);
    assert!(alone.abs() > 0.3, "{alone}");
    // Points are 5 cm apart, about 1.5 m away: half a point is 0.017 rad, at which ICP converges.
    assert!(around.abs() < 0.02, "{around}");
    // It works in the estimator, too.
    let mut slam = write_your_own_matcher::slam(config, many);
    for step in 0..10 {
        let log = run_slam_on_your_frames::frame(step);
        let before = step.checked_sub(1).map(run_slam_on_your_frames::odometry);
        let frame = Frame {
            stamp_s: log.stamp_s,
            odometry: before.zip(log.odometry).map(|(from, to)| from.between(&to)),
            scan: log.scan,
        };
        slam.step(&frame).unwrap();
    }
    let expected = run_slam_on_your_frames::truth(0).between(&run_slam_on_your_frames::truth(9));
    let found = slam.front_end().estimate();
    assert!(expected.between(&found).step_size() < 0.1, "{found:?}");
    write_your_own_matcher::main();
}

#[test]
fn every_example_is_short_and_run_here() {
    let root = env!("CARGO_MANIFEST_DIR");
    let this = std::fs::read_to_string(format!("{root}/tests/examples.rs")).unwrap();
    for entry in std::fs::read_dir(format!("{root}/examples")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy();
        assert!(text.lines().count() < 60, "{name} is too long");
        assert!(
            this.contains(&format!("{name}::main()")),
            "{name} is not run"
        );
    }
}
