use nalgebra::Vector3;

use super::*;

fn information(x: f64, y: f64, theta: f64) -> Matrix3<f64> {
    let turned = SE2::new(0.2, -0.1, 0.4).adjoint();
    turned.transpose() * Matrix3::from_diagonal(&Vector3::new(x, y, theta)) * turned
}

/// Five nodes: a chain 0 1 2 3 with a loop from 0 to 2, and a leaf node 4 at node 2.
fn graph() -> PoseGraph {
    let mut graph = PoseGraph::with_jacobians(pr_optim::JacobianModel::Exact);
    graph.add_fixed_node(SE2::new(1.0, -2.0, 0.3));
    let steps = [
        (
            0,
            1,
            SE2::new(1.0, 0.1, 0.5),
            information(400.0, 900.0, 2500.0),
        ),
        (
            1,
            2,
            SE2::new(0.9, -0.2, -0.8),
            information(300.0, 500.0, 1600.0),
        ),
        (
            2,
            3,
            SE2::new(0.8, 0.3, 1.2),
            information(700.0, 200.0, 900.0),
        ),
        (
            4,
            2,
            SE2::new(0.5, 0.5, -0.3),
            information(800.0, 300.0, 3600.0),
        ),
    ];
    for _ in 0..4 {
        graph.add_node(SE2::identity());
    }
    for (from, to, z, omega) in steps {
        if to == 2 && from == 4 {
            let at = graph.pose(2) * z.inverse();
            graph.set_pose(4, at);
        } else {
            let at = graph.pose(from) * z;
            graph.set_pose(to, at);
        }
        graph.add_edge(from, to, z, omega, EdgeKind::Odometry);
    }
    let around = graph.pose(0).between(&graph.pose(2)) * SE2::new(0.01, -0.02, 0.01);
    let omega = information(250.0, 350.0, 900.0);
    graph.add_edge(0, 2, around, omega, EdgeKind::Loop);
    graph.optimize(20, 1e-12);
    graph
}

#[test]
fn a_pending_loop_still_corrects_the_graph_after_marginalization() {
    let mut corrected = graph();
    corrected.marginalize(1).unwrap();
    assert_eq!(corrected.optimized_edges(), corrected.edge_count());
    let mut waiting = graph();
    let seen = waiting.pose(0).between(&waiting.pose(3)) * SE2::new(0.0, 0.02, 0.0);
    let omega = information(250.0, 350.0, 900.0);
    waiting.add_edge(0, 3, seen, omega, EdgeKind::Loop);
    waiting.marginalize(1).unwrap();
    assert_eq!(waiting.optimized_edges(), 0);
}

#[test]
fn marginalizing_a_chain_node_keeps_the_covariance_of_its_neighbours() {
    let mut whole = graph();
    let expected = whole.relative_covariance(0, 3).unwrap();
    let mut graph = graph();
    let done = graph.marginalize(1).unwrap();
    assert_eq!((done.neighbours, done.divergence), (2, 0.0));
    assert_eq!((graph.node_count(), graph.edge_count()), (4, 3));
    let found = graph.relative_covariance(0, 2).unwrap();
    // 2 %: the correction by the loop is second order in the covariances.
    assert!(
        (found - expected).norm() < 0.02 * expected.norm(),
        "{found} {expected}"
    );
    graph.optimize(20, 1e-12);
    let moved = whole.pose(3).between(&graph.pose(2)).log();
    assert!(moved.norm() < 1e-3, "{moved}");
}

#[test]
fn marginalizing_a_leaf_adds_no_edge() {
    let mut graph = graph();
    let poses = graph.poses()[..4].to_vec();
    let done = graph.marginalize(4).unwrap();
    assert_eq!((done.neighbours, done.divergence), (1, 0.0));
    graph.optimize(20, 1e-12);
    for (a, b) in poses.iter().zip(graph.poses()) {
        assert!(a.between(b).log().norm() < 1e-9);
    }
}

#[test]
fn the_tree_of_a_star_keeps_its_relative_poses_and_minimizes_the_divergence() {
    // Equal spokes from the middle: each relative pose has 2 Σ. The dense covariance of n of them has an
    // ln det that is 3 ln(n + 1) more than that of n Σ, so the divergence is 1.5 (n ln 2 − ln(n + 1)).
    for leaves in 2..6_usize {
        let spokes: Vec<Spoke> = (0..leaves)
            .map(|node| Spoke {
                node,
                pose: SE2::identity(),
                covariance: Matrix3::identity() * 0.01,
            })
            .collect();
        let (tree, divergence) = nearest_tree(&spokes).unwrap();
        let others = (leaves - 1) as f64;
        let expected = 1.5 * (others * 2_f64.ln() - (others + 1.0).ln());
        assert!(
            (divergence - expected).abs() < 1e-9,
            "{leaves}: {divergence}"
        );
        assert_eq!(tree.len(), leaves - 1);
    }
    // A well-measured spoke is the hub of the tree, whatever its position in the list.
    let spoke = |node: usize, variance: f64| Spoke {
        node,
        pose: SE2::new(node as f64, 0.5, 0.3 * node as f64),
        covariance: Matrix3::identity() * variance,
    };
    let spokes = [spoke(0, 0.1), spoke(1, 0.2), spoke(2, 1e-6), spoke(3, 0.3)];
    let (tree, divergence) = nearest_tree(&spokes).unwrap();
    assert!(tree.iter().all(|edge| edge.from == 2 || edge.to == 2));
    assert!(divergence < 1e-3, "{divergence}");
}

#[test]
fn marginalizing_a_node_with_loops_keeps_the_map() {
    let whole = graph();
    let mut graph = graph();
    let done = graph.marginalize(2).unwrap();
    assert_eq!(done.neighbours, 4);
    assert!(done.divergence > 0.0 && done.divergence < 3.0, "{done:?}");
    // Four of five edges go, and three are added.
    assert_eq!(graph.edge_count(), 4);
    graph.optimize(20, 1e-12);
    for (old, new) in [(1, 1), (3, 2), (4, 3)] {
        let moved = whole.pose(old).between(&graph.pose(new)).log();
        // 0.01: the loop had an error of 2 cm, and the tree distributes it differently.
        assert!(moved.norm() < 0.01, "{moved}");
    }
}

#[test]
fn a_fixed_node_is_not_marginalized() {
    let mut graph = graph();
    assert_eq!(graph.marginalize(0), Err(MarginalizeError::Fixed(0)));
    assert_eq!(graph.node_count(), 5);
}
