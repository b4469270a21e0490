//! The listings under their printed names give the results of the core.
//!
//! 1e-9: the two add the same terms in another order, and use other factorizations.

use std::sync::Arc;

use ch16_listings::*;
use ch16_slam2d::chapter::{InformationFrame, path_information};
use ch16_slam2d::cloud::{self, NearestMap};
use ch16_slam2d::icp::{self, IcpVariant as CoreVariant};
use ch16_slam2d::loops::{self, KeyframeView, LoopCandidate, LoopWorkspace};
use ch16_slam2d::matching::IcpMatcher;
use ch16_slam2d::slam::Keyframe;
use ch16_slam2d::{graph, prelude};
use nalgebra::{Matrix3, Point2, Vector2, Vector3};
use petgraph::graph::NodeIndex;
use pr_geom::Rng;

const SAME: f64 = 1e-9;

fn assert_same_pose(listing: SE2, core: prelude::SE2) {
    let apart = (listing.inverse() * SE2::from(core)).step_size();
    assert!(apart < SAME, "{listing:?} and {core:?} are {apart} apart");
}

/// A room of 5 m × 4 m with a pillar, as seen from `pose` with noise of 5 mm.
fn sweep(pose: &SE2, seed: u32) -> PointCloud {
    let mut rng = Rng::new(seed);
    let along = |k: i32, length: f64| length * f64::from(k) / 60.0;
    let walls = (0..60).flat_map(|k| {
        [
            Point2::new(along(k, 5.0), 0.0),
            Point2::new(5.0, along(k, 4.0)),
            Point2::new(along(k, 5.0), 4.0),
            Point2::new(0.0, along(k, 4.0)),
            Point2::new(3.2 + along(k, 0.4), 1.1),
            Point2::new(3.6, 1.1 + along(k, 0.5)),
        ]
    });
    let noisy = |p: Point2<f64>| {
        let noise = Vector2::new(rng.normal(0.0, 0.005), rng.normal(0.0, 0.005));
        pose.inverse().transform(&(p + noise))
    };
    PointCloud {
        points: walls.map(noisy).collect(),
        stamp: 0.0,
    }
}

fn core_cloud(listing: &PointCloud, normal_radius: f64) -> cloud::PointCloud {
    let mut cloud: cloud::PointCloud = listing.points.iter().copied().collect();
    cloud.estimate_normals(normal_radius);
    cloud
}

fn map_of(cloud: &PointCloud) -> VoxelMap {
    let mut map = VoxelMap::new(0.25, 8);
    map.insert(&cloud.points, &cloud.normals(0.3));
    map
}

fn origin() -> SE2 {
    SE2::new(Vector2::new(2.0, 1.9), 0.2)
}

#[test]
fn a_map_keeps_and_finds_the_same_points_with_the_same_normals() {
    let target = sweep(&origin(), 1);
    let map = map_of(&target);
    let core = cloud::VoxelMap::from_cloud(&core_cloud(&target, 0.3), 0.25, 8);
    assert_eq!(map.pts.len(), core.len());
    assert!(map.pts.len() < target.points.len(), "no cell is full");
    for (index, (point, normal)) in map.pts.iter().zip(&map.normals).enumerate() {
        assert_eq!(*point, core.point(index));
        match (normal, core.normal(index)) {
            (Some(a), Some(b)) => assert!((a - b).norm() < SAME, "{index}: {a} {b}"),
            (a, b) => assert_eq!(*a, b, "{index}"),
        }
    }
    let mut rng = Rng::new(2);
    let mut found = 0;
    for _ in 0..400 {
        let query = Point2::new(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0));
        for tau in [0.1, 0.25, 0.9] {
            let nearest = map.nearest(&query, tau);
            assert_eq!(nearest, core.nearest(&query, tau));
            found += usize::from(nearest.is_some());
        }
    }
    assert!((200..900).contains(&found), "{found} of 1200 have one");
}

#[test]
fn a_return_is_a_point_and_a_lost_beam_is_not() {
    let ranges = [1.0, 6.0, 2.0, 5.98];
    let bearings = [0.0, 0.1, core::f64::consts::FRAC_PI_2, 0.3];
    let cloud = PointCloud::from_ranges(&ranges, &bearings, 6.0, 0.5);
    assert_eq!(cloud.points.len(), 2);
    assert!((cloud.points[1] - Point2::new(0.0, 2.0)).norm() < 1e-12);
}

#[test]
fn both_increments_are_those_of_the_core() {
    let mut rng = Rng::new(3);
    for _ in 0..50 {
        let mut point = || Point2::new(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0));
        let pairs: Vec<Correspondence> = (0..12)
            .map(|k| Correspondence {
                src: point(),
                dst: point(),
                normal: (k % 4 != 0).then(|| point().coords.normalize()),
            })
            .collect();
        let (src, dst): (Vec<_>, Vec<_>) = pairs.iter().map(|c| (c.src, c.dst)).unzip();
        let normals: Vec<_> = pairs.iter().map(|c| c.normal).collect();
        assert_same_pose(svd_align(&src, &dst), icp::svd_align(&src, &dst));
        assert_same_pose(
            point_to_plane_step(&pairs),
            icp::point_to_plane_step(&src, &dst, &normals),
        );
    }
    assert_eq!(svd_align(&[], &[]), SE2::identity());
    assert_eq!(point_to_plane_step(&[]), SE2::identity());
}

/// Mirrored pairs: without the sign of the determinant the result would be a reflection.
#[test]
fn the_decomposition_gives_no_reflection() {
    let src = [[2.0, 0.1], [-2.0, -0.1], [0.3, 1.0], [-0.3, -1.0]].map(Point2::from);
    let mirrored = src.map(|p| Point2::new(p.x, -p.y));
    let found = svd_align(&src, &mirrored);
    assert_same_pose(found, icp::svd_align(&src, &mirrored));
    let turned = found
        .rotate(&Vector2::x())
        .perp(&found.rotate(&Vector2::y()));
    assert!((turned - 1.0).abs() < 1e-12);
}

#[test]
fn a_registration_has_the_same_steps_and_information() {
    let target = sweep(&origin(), 4);
    let moved = origin() * SE2::new(Vector2::new(0.15, -0.1), 0.1);
    let source = sweep(&moved, 5);
    let map = map_of(&target);
    let core_map = cloud::VoxelMap::from_cloud(&core_cloud(&target, 0.3), 0.25, 8);
    let core_source = core_cloud(&source, 0.3);
    for (variant, core_variant) in [
        (IcpVariant::PointToPoint, CoreVariant::PointToPoint),
        (IcpVariant::PointToPlane, CoreVariant::PointToPlane),
    ] {
        for trim in [0.0, 0.25] {
            let cfg = IcpConfig {
                variant,
                trim,
                ..IcpConfig::default()
            };
            let core_cfg = icp::IcpConfig {
                variant: core_variant,
                trim,
                ..icp::IcpConfig::default()
            };
            let found = icp(&source, &map, SE2::identity(), &cfg);
            let core = icp::icp(&core_source, &core_map, prelude::SE2::identity(), &core_cfg);
            assert_eq!(found.trace.len(), core.trace.len(), "{variant:?} {trim}");
            assert!(found.trace.len() > 4, "it had nothing to do");
            for (pose, step) in found.trace.iter().zip(&core.trace) {
                assert_same_pose(*pose, step.pose);
            }
            assert_eq!(found.inliers, core.inliers);
            assert!((found.rmse - core.rmse_m).abs() < SAME);
            assert!(
                found.converged && core.stop.converged(),
                "{variant:?} {trim}"
            );

            if trim == 0.0 {
                let pairs = associate(&source, &map, &found.pose, cfg.tau);
                let known = icp_information(&pairs, 0.05, 12.0);
                let core_known = icp::icp_information(&core.pairs, 0.05, 12.0);
                assert!((known - core_known).amax() < SAME * core_known.amax());
                let apart = regularize(known, 1.0, 2500.0) - icp::regularize(known, 1.0, 2500.0);
                assert!(apart.amax() < SAME);
            }
        }
    }
}

/// Registers a room on itself, moved, of which every point but each `every`th is gone, and the normals of all but
/// `normals` points; returns the verdicts of listing and core, and how far off the listing is, m.
fn claims(
    variant: IcpVariant,
    trim: f64,
    every: usize,
    normals: usize,
    points: impl Fn(Point2<f64>) -> Point2<f64>,
) -> (bool, bool, f64) {
    let target = sweep(&origin(), 4);
    let target = PointCloud {
        points: target
            .points
            .into_iter()
            .step_by(every)
            .map(points)
            .collect(),
        stamp: 0.0,
    };
    let moved = SE2::new(Vector2::new(0.15, 0.1), 0.03);
    let source = target.transformed(&moved.inverse());
    let mut map = VoxelMap::new(0.25, 1000);
    let known = target.normals(0.3).into_iter().enumerate();
    let known: Vec<_> = known.map(|(k, n)| n.filter(|_| k < normals)).collect();
    map.insert(&target.points, &known);
    let mut core_map = core_cloud(&target, 0.3);
    if normals == 0 {
        core_map = target.points.iter().copied().collect();
    }
    let core_map = cloud::VoxelMap::from_cloud(&core_map, 0.25, 1000);
    let cfg = IcpConfig {
        variant,
        trim,
        max_iters: 200,
        ..IcpConfig::default()
    };
    let core_cfg = icp::IcpConfig {
        variant: match variant {
            IcpVariant::PointToPoint => CoreVariant::PointToPoint,
            IcpVariant::PointToPlane => CoreVariant::PointToPlane,
        },
        trim,
        max_iterations: 200,
        ..icp::IcpConfig::default()
    };
    let found = icp(&source, &map, SE2::identity(), &cfg);
    let core_source = core_cloud(&source, 0.3);
    let core = icp::icp(&core_source, &core_map, prelude::SE2::identity(), &core_cfg);
    let off_m = (found.pose.translation() - moved.translation()).norm();
    (found.converged, core.stop.converged(), off_m)
}

/// Point to plane without normals takes steps of zero, and is at rest on its guess.
#[test]
fn what_no_pair_measures_has_not_converged_as_in_the_core() {
    let variants = [IcpVariant::PointToPoint, IcpVariant::PointToPlane];
    let as_it_is = |p| p;
    let mut right = 0;
    for variant in variants {
        for every in [1, 2, 4, 8, 16, 32, 64, 128] {
            let (listing, core, off_m) = claims(variant, 0.0, every, usize::MAX, as_it_is);
            assert_eq!(listing, core, "{variant:?}, every {every}th point");
            right += usize::from(listing && off_m < 0.01);
            if variant == IcpVariant::PointToPlane {
                assert!(!listing || off_m < 0.05, "every {every}th point: {off_m} m");
            }
        }
        for (trim, is_left) in [(0.5, true), (0.99, false), (1.0, false)] {
            let (listing, core, _) = claims(variant, trim, 1, usize::MAX, as_it_is);
            assert_eq!(
                (listing, core),
                (is_left, is_left),
                "{variant:?}, trim {trim}"
            );
        }
        let one_place = |_| Point2::new(0.3, -0.2);
        let (listing, core, _) = claims(variant, 0.0, 1, usize::MAX, one_place);
        assert!(!listing && !core, "{variant:?}: coincident points");
    }
    assert!(right >= 4, "{right}");
    // 15 normals are fewer than twice `min_pairs`.
    for normals in [0, 15] {
        let (listing, ..) = claims(IcpVariant::PointToPlane, 0.0, 1, normals, as_it_is);
        assert!(!listing, "{normals} normals");
    }
    let (listing, core, off_m) = claims(IcpVariant::PointToPlane, 0.0, 1, 0, as_it_is);
    assert!(!listing && !core && off_m > 0.1, "the guess");
    // Along two walls nothing is measured.
    let corridor = |p: Point2<f64>| Point2::new(p.x, if p.y > 0.0 { 1.0 } else { -1.0 });
    let (listing, core, _) = claims(IcpVariant::PointToPlane, 0.0, 1, usize::MAX, corridor);
    assert!(!listing && !core, "a corridor");
}

/// A ring of poses with noise on every edge, and chords.
fn rings(nodes: usize) -> (PoseGraph, graph::PoseGraph) {
    let mut rng = Rng::new(6);
    let step = SE2::new(Vector2::new(0.5, 0.02), 0.2);
    let mut noisy = |motion: SE2| {
        let noise = Vector3::from([0.05, 0.05, 0.03].map(|sigma| rng.normal(0.0, sigma)));
        motion * SE2::exp(&noise)
    };
    let mut listing = PoseGraph::new();
    listing.add_fixed_node(SE2::identity());
    let mut core = graph::PoseGraph::new();
    core.add_fixed_node(prelude::SE2::identity());
    let mut truth = vec![SE2::identity()];
    for k in 1..nodes {
        truth.push(truth[k - 1] * step);
        let guess = noisy(truth[k]);
        listing.add_node(guess);
        core.add_node(guess.into());
    }
    let chain = (1..nodes).map(|k| (k - 1, k, EdgeKind::Odometry));
    let chords = (0..nodes / 3).map(|k| (2 * k, nodes - 1 - k / 2, EdgeKind::Loop));
    for (i, j, kind) in chain.chain(chords) {
        let z = noisy(truth[i].inverse() * truth[j]);
        let omega = Matrix3::new(400.0, 30.0, 5.0, 30.0, 200.0, -8.0, 5.0, -8.0, 900.0);
        listing.add_edge(NodeIndex::new(i), NodeIndex::new(j), z, omega, kind);
        core.add_edge(i, j, z.into(), omega, kind);
    }
    (listing, core)
}

#[test]
fn a_graph_takes_the_same_steps_to_the_same_poses() {
    let (mut listing, mut core) = rings(40);
    for huber in [f64::INFINITY, 2.0] {
        assert!((listing.chi2() - core.chi2()).abs() < SAME * core.chi2());
        for _ in 0..4 {
            let (a, b) = (listing.optimize_once(huber), core.optimize_once(huber));
            assert!((a - b).abs() < SAME, "{a} {b}");
            for node in listing.graph.node_indices() {
                assert_same_pose(listing.pose(node), core.pose(node.index()));
            }
        }
    }
    assert_eq!(listing.pose(listing.fixed), SE2::identity());
}

#[test]
fn a_loop_is_proposed_and_tested_alike() {
    let [near, far] = [1.0, 8.0].map(verdicts_after);
    assert!(near.iter().all(|accepted| *accepted), "{near:?}");
    assert!(far.contains(&false), "{far:?}");
}

/// Two laps of the room, a hand's breadth apart, in a graph with this drift; returns whether each
/// candidate is accepted.
fn verdicts_after(drift: f64) -> Vec<bool> {
    let nodes = 30;
    let place = |k: usize, off: f64| {
        let angle = core::f64::consts::TAU * (k as f64) / 24.0;
        let on_circle = Vector2::new(2.0 + 0.9 * angle.cos(), 2.0 + off + 0.9 * angle.sin());
        SE2::new(
            on_circle,
            angle - core::f64::consts::TAU * (k as f64 / 24.0).round(),
        )
    };
    let mut graph = PoseGraph::new();
    graph.add_fixed_node(place(0, 0.0));
    let mut sweeps = Vec::new();
    for k in 0..nodes {
        let truth = place(k, if k < 24 { 0.0 } else { 0.05 });
        let way = drift * k as f64;
        let drift = SE2::new(Vector2::new(0.002, -0.003) * way, 0.0015 * way);
        if k > 0 {
            graph.add_node(drift * truth);
        }
        sweeps.push(sweep(&truth, 100 + k as u32));
    }
    let cfg = LoopConfig::default();
    let core_cfg = loops::LoopConfig::default();
    let poses: Vec<prelude::SE2> = graph
        .graph
        .node_weights()
        .map(|&pose| pose.into())
        .collect();
    let keyframes: Vec<Keyframe> = (0..nodes)
        .map(|node| Keyframe {
            node,
            frame: node,
            stamp_s: 0.0,
            scan: Arc::new(core_cloud(&sweeps[node], cfg.normal_radius)),
        })
        .collect();
    let view = KeyframeView {
        poses: &poses,
        keyframes: &keyframes,
    };
    let (mut verdicts, mut straight) = (Vec::new(), 0);
    for node in 24..nodes {
        let found = detect_loop_candidates(&graph, NodeIndex::new(node), &cfg);
        let core_found = loops::detect_loop_candidates(&poses, node, &core_cfg);
        let numbers: Vec<usize> = found.iter().map(|old| old.index()).collect();
        let core_numbers: Vec<usize> = core_found.iter().map(|old| old.node).collect();
        assert_eq!(numbers, core_numbers, "node {node}");
        for (&old, candidate) in found.iter().zip(core_found) {
            let LoopCandidate { node: number, .. } = candidate;
            let listing = verify_loop(&graph, &sweeps, NodeIndex::new(node), old, &cfg);
            let matcher = IcpMatcher::with_variant(CoreVariant::PointToPoint, &core_cfg.submap);
            let core = loops::verify_loop(
                view,
                node,
                candidate,
                Ok(path_information(node - number, &core_cfg)),
                InformationFrame::Chapter,
                &core_cfg,
                &mut LoopWorkspace::new(Box::new(matcher)),
            );
            assert_same_pose(listing.edge.z, core.registered);
            assert_eq!(listing.inliers, core.inliers);
            assert!((listing.rmse - core.rmse_m).abs() < SAME);
            assert!((listing.chi2 - core.gate.chi2).abs() < SAME * (1.0 + core.gate.chi2));
            assert_eq!(listing.accepted, core.accepted(), "{node} to {number}");
            if poses[number].theta() == 0.0 {
                // The chapter rotates its information by the candidate's heading in the world.
                let apart = listing.edge.omega - core.information;
                assert!(apart.amax() < SAME * core.information.amax());
                straight += 1;
            }
            verdicts.push(listing.accepted);
        }
    }
    assert!(straight > 0, "no information was compared");
    verdicts
}
