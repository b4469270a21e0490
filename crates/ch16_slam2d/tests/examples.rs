//! Every example runs, and what it shows is so.

#[path = "../examples/align_two_clouds.rs"]
mod align_two_clouds;
#[path = "../examples/optimize_a_graph.rs"]
mod optimize_a_graph;
#[path = "../examples/register_a_scan.rs"]
mod register_a_scan;

use ch16_slam2d::prelude::*;

#[test]
fn the_robot_of_the_aligned_clouds_moved_straight() {
    // The room of the example moved by (−0.5, −0.2): the robot moved the other way.
    let expected = SE2::translation(0.5, 0.2);
    let motion = align_two_clouds::motion();
    assert!(expected.between(&motion).step_size() < 1e-12);
    align_two_clouds::main();
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
fn the_loop_of_the_graph_brings_the_end_to_the_start() {
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
