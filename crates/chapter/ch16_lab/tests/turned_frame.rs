//! The map's frame is arbitrary: rotating it must not change any edge of the graph.

use ch16_lab::lap::{Drive, DriveConfig};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::graph::{EdgeKind, PoseEdge};
use ch16_slam2d::slam::{Slam, SlamConfig};
use pr_geom::{Matrix3, SE2};

/// The edges of the canonical lap in a map that starts at `start`, with maps that keep all points.
///
/// The cells of a map are parallel to its axes, so a limit on the points of a cell would depend on the
/// rotation.
fn edges(drive: &Drive, start: SE2, information_frame: InformationFrame) -> Vec<PoseEdge> {
    let mut config = SlamConfig {
        start,
        ..SlamConfig::chapter()
    };
    config.chapter.information_frame = information_frame;
    config.chapter.local_map.max_per_cell = usize::MAX;
    config.chapter.loops.submap.max_per_cell = usize::MAX;
    let mut slam = Slam::new(config);
    for tick in 0..=drive.ticks().len() {
        slam.step_prepared(&drive.prepared(tick)).unwrap();
    }
    slam.graph().edges().map(|view| view.edge).collect()
}

/// Largest difference of two matrices, as a share of the largest entry.
fn off(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).abs().max() / a.abs().max()
}

#[test]
fn turning_everything_changes_no_edge_and_the_chapters_loops_do_change() {
    let drive = Drive::simulate(&DriveConfig::default());
    let straight = SE2::new(1.35, 4.42, 0.0);
    let exact = edges(&drive, straight, InformationFrame::Exact);
    let chapter = edges(&drive, straight, InformationFrame::Chapter);
    let loops = |edges: &[PoseEdge]| {
        let kinds = edges.iter().map(|edge| edge.kind);
        kinds.filter(|kind| *kind == EdgeKind::Loop).count()
    };
    assert!(loops(&exact) > 0 && loops(&chapter) > 0);
    for turn in [0.4, core::f64::consts::FRAC_PI_2, -2.9] {
        let turned = SE2::new(-3.0, 7.0, turn);
        let again = edges(&drive, turned, InformationFrame::Exact);
        assert_eq!(exact.len(), again.len());
        for (k, (here, there)) in exact.iter().zip(&again).enumerate() {
            assert_eq!(here.kind, there.kind);
            let moved = here.measurement.between(&there.measurement).step_size();
            // 1e-9: roundings of 1e-16, propagated through 129 registrations.
            assert!(moved < 1e-9, "edge {k} moved by {moved}");
            let changed = off(&here.information, &there.information);
            assert!(
                changed < 1e-9,
                "information of edge {k} changed by {changed}"
            );
        }
        let again = edges(&drive, turned, InformationFrame::Chapter);
        let first_loop = |edges: &[PoseEdge]| {
            let mut edges = edges.iter().copied();
            edges.find(|edge| edge.kind == EdgeKind::Loop).unwrap()
        };
        let (here, there) = (first_loop(&chapter), first_loop(&again));
        assert!(here.measurement.between(&there.measurement).step_size() < 1e-9);
        assert!(off(&here.information, &there.information) > 0.01, "{turn}");
    }
}
