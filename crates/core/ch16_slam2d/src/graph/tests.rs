use super::*;

/// Three poses on a line; the loop measures the last at 2.6, odometry at 2.0.
fn chapter_example() -> PoseGraph {
    let mut graph = PoseGraph::new();
    let a = graph.add_fixed_node(SE2::identity());
    let b = graph.add_node(SE2::from_xy(1.0, 0.0));
    let c = graph.add_node(SE2::from_xy(2.0, 0.0));
    let information = Matrix3::identity();
    let step = SE2::from_xy(1.0, 0.0);
    graph.add_edge(a, b, step, information, EdgeKind::Odometry);
    graph.add_edge(b, c, step, information, EdgeKind::Odometry);
    graph.add_edge(a, c, SE2::from_xy(2.6, 0.0), information, EdgeKind::Loop);
    graph
}

#[test]
fn chapter_three_poses_share_the_disagreement_equally() {
    let mut graph = chapter_example();
    // Before: (2.6 − 2.0)² = 0.36. After: three edges of 0.2 each, 3 · 0.04 = 0.12.
    assert!((graph.chi2() - 0.36).abs() < 1e-12);
    let report = graph.optimize(10, 1e-9);
    assert!(report.stop.is_converged(), "{}", report.stop);
    // 1e-9: the ridge of 1e-9 on a diagonal of 1 shifts each step by that share.
    assert!((graph.pose(1).x() - 1.2).abs() < 1e-9);
    assert!((graph.pose(2).x() - 2.4).abs() < 1e-9);
    assert!((graph.chi2() - 0.12).abs() < 1e-12);
}

#[test]
fn one_iteration_reports_the_largest_step() {
    let mut graph = chapter_example();
    // The last node goes from 2.0 to 2.4. 1e-8: the ridge of 1e-9.
    assert!((graph.optimize_once(f64::INFINITY) - 0.4).abs() < 1e-8);
    assert!(graph.optimize_once(f64::INFINITY) < 1e-8);
}

#[test]
fn chi2_is_the_sum_over_the_edges() {
    let graph = chapter_example();
    let sum: f64 = graph.edges().map(|view| graph.edge_chi2(view.id)).sum();
    assert_eq!(sum, graph.chi2());
    let loops: Vec<_> = graph
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Loop)
        .map(|view| (view.from.index(), view.to.index()))
        .collect();
    assert_eq!(loops, [(0, 2)]);
}

#[test]
fn cached_chi2_has_the_bits_of_a_new_sum() {
    let mut graph = chapter_example();
    let mut compared = 0;
    let mut compare = |graph: &PoseGraph| {
        let sum = graph.edges().map(|view| graph.edge_chi2(view.id)).sum();
        assert_eq!(f64::to_bits(sum), graph.chi2().to_bits(), "{compared}");
        compared += 1;
    };
    graph.optimize_robust(10, 1e-9, 0.1);
    compare(&graph);
    let node = graph.add_node(SE2::new(2.9, 0.1, 0.2));
    let step = SE2::from_xy(1.0, 0.0);
    graph.add_edge(2, node, step, Matrix3::identity(), EdgeKind::Odometry);
    compare(&graph);
    compare(&graph.clone());
    graph.add_edge(0, node, step, Matrix3::identity(), EdgeKind::Loop);
    compare(&graph);
    graph.pop_edge();
    compare(&graph);
    graph.set_pose(1, SE2::new(1.1, 0.2, -0.1));
    compare(&graph);
    graph.optimize_once(f64::INFINITY);
    compare(&graph);
    graph.optimize(10, 1e-9);
    compare(&graph);
    // An indefinite measurement: the solver fails.
    graph.add_edge(0, node, step, -Matrix3::identity() * 9.0, EdgeKind::Loop);
    graph.optimize(10, 1e-9);
    compare(&graph);
}

#[test]
fn huber_reduces_the_influence_of_a_false_loop() {
    let mut plain = chapter_example();
    let mut robust = chapter_example();
    plain.optimize(50, 1e-9);
    robust.optimize_robust(50, 1e-9, 0.05);
    let shift = |graph: &PoseGraph| graph.pose(2).x() - 2.0;
    assert!(shift(&robust) < 0.5 * shift(&plain));
    assert!(shift(&robust) > 0.0);
}

#[test]
fn fixed_node_keeps_its_bits() {
    let start = SE2::new(0.1, 0.2, 0.3);
    let mut graph = PoseGraph::new();
    let a = graph.add_fixed_node(start);
    let b = graph.add_node(SE2::identity());
    let measurement = SE2::new(1.0, 0.0, 0.5);
    graph.add_edge(a, b, measurement, Matrix3::identity(), EdgeKind::Odometry);
    graph.optimize(20, 1e-12);
    assert_eq!(graph.pose(a), start);
    assert!(graph.pose(b).boxminus(&(start * measurement)).norm() < 1e-8);
}

#[test]
fn a_closed_loop_makes_the_relative_pose_more_certain() {
    let mut graph = PoseGraph::new();
    let information = Matrix3::from_diagonal(&nalgebra::Vector3::new(100.0, 50.0, 400.0));
    let step = SE2::from_xy(1.0, 0.0);
    let mut nodes = vec![graph.add_fixed_node(SE2::identity())];
    for k in 1..5 {
        nodes.push(graph.add_node(SE2::from_xy(f64::from(k), 0.0)));
        graph.add_edge(
            nodes[k as usize - 1],
            nodes[k as usize],
            step,
            information,
            EdgeKind::Odometry,
        );
    }
    let open = graph.relative_covariance(nodes[1], nodes[4]).unwrap();
    // Along the line x adds up over three edges, and so does θ. 1e-7: the solver's ridge.
    assert!((open[(0, 0)] - 3.0 / 100.0).abs() < 1e-7);
    assert!((open[(2, 2)] - 3.0 / 400.0).abs() < 1e-7);
    // y has the three edges' own share and the heading noise of the first two over 2 m and 1 m.
    assert!((open[(1, 1)] - (3.0 / 50.0 + 5.0 / 400.0)).abs() < 1e-7);
    graph.add_edge(
        nodes[1],
        nodes[4],
        SE2::from_xy(3.0, 0.0),
        information,
        EdgeKind::Loop,
    );
    let closed = graph.relative_covariance(nodes[1], nodes[4]).unwrap();
    // Three edges in a row beside one: 1/(1/3 + 1) of its variance along the line.
    assert!((closed[(0, 0)] - 0.75 / 100.0).abs() < 1e-7);
    let at_edges = graph.edge_covariances().unwrap();
    assert_eq!(at_edges.len(), 5);
    // 1e-12: the same factor, another order of operations.
    assert!((at_edges[4] - closed).amax() < 1e-12);
    let covariances = graph.pose_covariances().unwrap();
    assert_eq!(covariances[0], Matrix3::zeros());
    assert!((covariances[1][(0, 0)] - 1.0 / 100.0).abs() < 1e-7);
}

/// A bent path with a loop, of which one node is fixed.
fn bent_path(fixed: usize) -> PoseGraph {
    let poses: Vec<SE2> = (0..6)
        .map(|k| SE2::new(f64::from(k), 0.2 * f64::from(k * k), 0.5 * f64::from(k)))
        .collect();
    let mut graph = PoseGraph::new();
    let nodes: Vec<NodeId> = poses
        .iter()
        .enumerate()
        .map(|(node, pose)| match node == fixed {
            true => graph.add_fixed_node(*pose),
            false => graph.add_node(*pose),
        })
        .collect();
    let information = Matrix3::from_diagonal(&nalgebra::Vector3::new(900.0, 1600.0, 2500.0));
    for (from, to) in [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (0, 4)] {
        let measured = poses[from].between(&poses[to]);
        graph.add_edge(
            nodes[from],
            nodes[to],
            measured,
            information,
            EdgeKind::Odometry,
        );
    }
    graph
}

#[test]
fn covariances_after_an_alignment_do_not_depend_on_the_fixed_node() {
    let [first, last] = [0, 5].map(|fixed| bent_path(fixed).aligned_covariances().unwrap());
    for (one, other) in first.iter().zip(&last) {
        // 1e-7 of a variance of 1e-3: the ridge of 1e-9 on information of 1e3.
        assert!((one - other).amax() < 1e-9, "{one} {other}");
        assert!(one.cholesky().is_some(), "{one}");
    }
    let [first, last] = [0, 5].map(|fixed| bent_path(fixed).pose_covariances().unwrap());
    assert!((first[5] - last[5]).amax() > 1e-3);
}

#[test]
fn an_alignment_leaves_half_of_an_error_of_length_at_each_end() {
    let mut graph = PoseGraph::new();
    let from = graph.add_fixed_node(SE2::identity());
    let to = graph.add_node(SE2::from_xy(2.0, 0.0));
    let information = Matrix3::from_diagonal(&nalgebra::Vector3::new(25.0, 4.0, 9.0));
    graph.add_edge(
        from,
        to,
        SE2::from_xy(2.0, 0.0),
        information,
        EdgeKind::Odometry,
    );
    for covariance in graph.aligned_covariances().unwrap() {
        // Half of 0.2 m along the line, and nothing across it, because a rotation aligns that. 1e-9: the ridge.
        let expected = nalgebra::Matrix2::new(0.01, 0.0, 0.0, 0.0);
        assert!((covariance - expected).amax() < 1e-9, "{covariance}");
    }
}

/// A square with a closing error of 0.3 m and a tenth of a turn, and a loop.
fn torn_square(graph: PoseGraph) -> PoseGraph {
    let mut graph = graph;
    let information = Matrix3::identity();
    let step = SE2::new(1.0, 0.0, core::f64::consts::FRAC_PI_2);
    let mut pose = SE2::identity();
    let mut last = graph.add_fixed_node(pose);
    for _ in 0..4 {
        pose = pose * SE2::new(1.1, 0.05, core::f64::consts::FRAC_PI_2 + 0.15);
        let next = graph.add_node(pose);
        graph.add_edge(last, next, step, information, EdgeKind::Odometry);
        last = next;
    }
    let off = SE2::new(0.3, 0.0, 0.6);
    graph.add_edge(0, last, off, information, EdgeKind::Loop);
    graph
}

#[test]
fn exact_jacobians_take_fewer_steps_and_stay_with_the_graph() {
    let iterations = |mut graph: PoseGraph| graph.optimize(50, 1e-9).iterations;
    let chapter = iterations(torn_square(PoseGraph::new()));
    let exact = || torn_square(PoseGraph::with_jacobians(JacobianModel::Exact));
    let fewest = iterations(exact());
    assert!(fewest < chapter, "{fewest} and {chapter}");
    assert_eq!(iterations(exact().with_edges(|_| true)), fewest);
    assert_eq!(iterations(exact().clone()), fewest);
    let named = torn_square(PoseGraph::new()).solved_with(JacobianModel::Exact);
    assert_eq!(iterations(named), fewest);
}
