//! 4. The graph, with a dense matrix.

use ch16_listings::{EdgeKind, PoseGraph, SE2};
use ch16_slam2d::graph;
use exercises::{optimize, optimize_once};
use nalgebra::{Matrix3, Vector2, Vector3};
use petgraph::graph::NodeIndex;
use pr_geom::Rng;

use crate::canonical::assert_same_pose;

fn at(x: f64) -> SE2 {
    SE2::new(Vector2::new(x, 0.0), 0.0)
}

/// The chapter's worked example: χ² falls from 0.36 to 0.12, and each edge takes a third of the error.
#[test]
fn a_loop_error_spreads_evenly_around_the_cycle() {
    let mut chain = PoseGraph::new();
    let first = chain.add_fixed_node(at(0.0));
    let (second, third) = (chain.add_node(at(1.0)), chain.add_node(at(2.0)));
    for (i, j, x) in [
        (first, second, 1.0),
        (second, third, 1.0),
        (first, third, 2.6),
    ] {
        chain.add_edge(i, j, at(x), Matrix3::identity(), EdgeKind::Odometry);
    }
    assert!((chain.chi2() - 0.36).abs() < 1e-12);
    let steps = optimize(&mut chain, 10, 1e-6, f64::INFINITY);
    assert_eq!(
        steps, 2,
        "it is linear: one step, and one to confirm convergence"
    );
    // 1e-8: 1e-9 is added to the diagonal.
    assert!((chain.chi2() - 0.12).abs() < 1e-8, "{}", chain.chi2());
    assert_same_pose(chain.pose(second), at(1.2), 1e-8);
    assert_same_pose(chain.pose(third), at(2.4), 1e-8);
}

/// A ring of poses with noise on every edge and chords across it, held at `fixed`; twice.
fn rings(nodes: usize, fixed: usize) -> (PoseGraph, graph::PoseGraph) {
    let mut rng = Rng::new(6);
    let mut noisy = |motion: SE2| {
        let noise = Vector3::from([0.05, 0.05, 0.03].map(|sigma| rng.normal(0.0, sigma)));
        motion * SE2::exp(&noise)
    };
    let step = SE2::new(Vector2::new(0.5, 0.02), 0.2);
    let truth: Vec<SE2> = (0..nodes)
        .scan(SE2::identity(), |pose, _| {
            let here = *pose;
            *pose = *pose * step;
            Some(here)
        })
        .collect();
    let guesses: Vec<SE2> = truth.iter().map(|pose| noisy(*pose)).collect();
    let mut ours = PoseGraph::new();
    let mut core = graph::PoseGraph::new();
    for (k, guess) in guesses.iter().enumerate() {
        if k == fixed {
            ours.add_fixed_node(*guess);
            core.add_fixed_node((*guess).into());
        } else {
            ours.add_node(*guess);
            core.add_node((*guess).into());
        }
    }
    let chain = (1..nodes).map(|k| (k - 1, k));
    let chords = (0..nodes / 3).map(|k| (2 * k, nodes - 1 - k / 2));
    for (i, j) in chain.chain(chords) {
        let z = noisy(truth[i].inverse() * truth[j]);
        let omega = Matrix3::new(400.0, 30.0, 5.0, 30.0, 200.0, -8.0, 5.0, -8.0, 900.0);
        let (from, to) = (NodeIndex::new(i), NodeIndex::new(j));
        ours.add_edge(from, to, z, omega, EdgeKind::Odometry);
        core.add_edge(i, j, z.into(), omega, EdgeKind::Odometry);
    }
    (ours, core)
}

#[test]
fn every_step_is_that_of_the_core_with_and_without_a_kernel() {
    for huber in [f64::INFINITY, 2.0] {
        let (mut ours, mut core) = rings(24, 0);
        for _ in 0..4 {
            let (a, b) = (optimize_once(&mut ours, huber), core.optimize_once(huber));
            // 1e-9: dense and sparse factorizations round differently.
            assert!(
                (a - b).abs() < 1e-9,
                "the largest correction is {a}, not {b}"
            );
            for node in ours.graph.node_indices() {
                assert_same_pose(ours.pose(node), core.pose(node.index()).into(), 1e-9);
            }
        }
    }
}

#[test]
fn the_held_node_stays_whichever_it_is() {
    let (mut ours, mut core) = rings(12, 5);
    let before = ours.pose(ours.fixed);
    optimize(&mut ours, 10, 1e-9, f64::INFINITY);
    core.optimize(10, 1e-9);
    assert_eq!(ours.pose(ours.fixed), before);
    assert_same_pose(ours.pose(NodeIndex::new(0)), core.pose(0).into(), 1e-8);
}

#[test]
fn a_pose_without_an_edge_stays_by_the_ridge() {
    let (mut ours, _) = rings(6, 0);
    let loose = ours.add_node(at(9.0));
    let largest = optimize_once(&mut ours, f64::INFINITY);
    assert!(
        largest.is_finite(),
        "1e-9 on the diagonal keeps the matrix positive definite"
    );
    assert_same_pose(ours.pose(loose), at(9.0), 1e-9);
}

#[test]
fn the_kernel_counts_in_every_step_and_no_more_are_made_than_allowed() {
    let [mut ours, mut steps] = [(); 2].map(|()| rings(12, 0).0);
    assert_eq!(optimize(&mut ours, 3, 1e-15, 0.5), 3);
    for _ in 0..3 {
        optimize_once(&mut steps, 0.5);
    }
    let poses = |graph: &PoseGraph| graph.graph.node_weights().copied().collect::<Vec<SE2>>();
    assert_eq!(poses(&ours), poses(&steps), "three steps with the kernel");
}

#[test]
fn a_matrix_that_is_not_positive_definite_moves_nothing() {
    let (mut ours, _) = rings(6, 0);
    ours.add_edge(
        NodeIndex::new(0),
        NodeIndex::new(3),
        at(1.0),
        -1e4 * Matrix3::identity(),
        EdgeKind::Odometry,
    );
    let before: Vec<SE2> = ours.graph.node_weights().copied().collect();
    assert!(optimize_once(&mut ours, f64::INFINITY).is_nan());
    let after: Vec<SE2> = ours.graph.node_weights().copied().collect();
    assert_eq!(before, after);
    assert_eq!(optimize(&mut ours, 10, 1e-9, f64::INFINITY), 1);
}
