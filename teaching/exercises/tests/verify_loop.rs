//! 5. The gate, on the canonical lap.

use ch16_listings::{
    EdgeKind, IcpConfig, IcpResult, LoopConfig, PointCloud, PoseGraph, SE2, VerifiedLoop,
    associate, icp, icp_information, regularize, submap,
};
use exercises::verify_loop;
use nalgebra::{Matrix3, Vector2, Vector3};
use petgraph::graph::NodeIndex;
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

use crate::canonical::{assert_same_pose, lap, nodes_before_loop, sweeps};

#[derive(Deserialize)]
struct Lap {
    events: Vec<Event>,
}

#[derive(Deserialize)]
struct Event {
    from: usize,
    to: usize,
    chi2: f64,
    rmse: f64,
    inliers: usize,
}

/// `tests/reference/lap.json`: χ² 4.236, 0.421 and 1.125.
#[test]
fn the_three_loops_of_the_lap_have_the_numbers_of_the_reference() {
    let record = lap();
    let sweeps = sweeps(&record);
    let events = &reference::<Vec<Lap>>("lap.json")[0].events;
    let attempts: Vec<_> = record.lap.loop_attempts().collect();
    assert_eq!((events.len(), attempts.len()), (3, 3));
    for (event, attempt) in events.iter().zip(attempts) {
        let graph = nodes_before_loop(&record, attempt.tick);
        let (node, old) = (NodeIndex::new(event.from), NodeIndex::new(event.to));
        let found = verify_loop(&graph, &sweeps, node, old, &LoopConfig::default());
        // 1e-6: rounding accumulates over a whole lap.
        assert_close("χ²", found.chi2, event.chi2, 1e-6);
        assert_close("rmse", found.rmse, event.rmse, 1e-6);
        assert_eq!(found.inliers, event.inliers);
        assert!(found.accepted);
    }
}

/// The first loop of the lap, 29 to 7.
struct First {
    graph: PoseGraph,
    sweeps: Vec<PointCloud>,
    node: NodeIndex,
    old: NodeIndex,
}

impl First {
    fn new() -> Self {
        let record = lap();
        let attempt = record.lap.loop_attempts().next().expect("three loops");
        Self {
            graph: nodes_before_loop(&record, attempt.tick),
            sweeps: sweeps(&record),
            node: NodeIndex::new(29),
            old: NodeIndex::new(7),
        }
    }

    fn verify(&self, cfg: &LoopConfig) -> VerifiedLoop {
        verify_loop(&self.graph, &self.sweeps, self.node, self.old, cfg)
    }

    fn belief(&self) -> SE2 {
        self.graph.pose(self.old).inverse() * self.graph.pose(self.node)
    }

    /// The listing's registration from the belief with this threshold and limit.
    fn register(&self, cfg: &LoopConfig, tau: f64, max_iters: usize) -> IcpResult {
        let map = submap(&self.graph, &self.sweeps, self.old, cfg);
        let settings = IcpConfig {
            tau,
            max_iters,
            ..IcpConfig::default()
        };
        icp(
            &self.sweeps[self.node.index()],
            &map,
            self.belief(),
            &settings,
        )
    }

    /// The same with the node's belief moved.
    fn moved(mut self, by: SE2) -> Self {
        self.graph.graph[self.node] = self.graph.pose(self.node) * by;
        self
    }
}

#[test]
fn a_belief_that_is_far_off_fails_the_gate_and_nothing_else() {
    let first = First::new();
    let right = first.verify(&LoopConfig::default());
    let first = first.moved(SE2::new(Vector2::zeros(), 0.2));
    let off = first.verify(&LoopConfig::default());
    // It fits: registration corrects the rotation.
    assert!(off.rmse <= 0.16 && off.inliers >= 25, "{off:?}");
    assert!(off.chi2 > 7.815 && !off.accepted, "{off:?}");
    let apart = right.edge.z.inverse() * off.edge.z;
    assert!(
        apart.theta().abs() < 0.02,
        "the edge is what was registered"
    );
}

#[test]
fn the_drift_grows_with_the_gap() {
    let first = First::new();
    let usual = first.verify(&LoopConfig::default());
    let innovation = (first.belief().inverse() * usual.edge.z).log();
    // By hand: 22 nodes of 0.045 m and 0.012 rad each.
    let s = 22.0 * Vector3::new(0.045_f64.powi(2), 0.045_f64.powi(2), 0.012_f64.powi(2));
    let expected = innovation
        .component_mul(&innovation)
        .component_div(&s)
        .sum();
    assert_close("χ²", usual.chi2, expected, 1e-9);
    let narrow = LoopConfig {
        drift: (0.0225, 0.006),
        ..LoopConfig::default()
    };
    let narrow = first.verify(&narrow);
    assert_close("half the drift", narrow.chi2, 4.0 * usual.chi2, 1e-9);
    assert!(!narrow.accepted);
}

#[test]
fn a_poor_fit_and_few_pairs_fail_whatever_the_gate_says() {
    let first = First::new();
    let usual = first.verify(&LoopConfig::default());
    for cfg in [
        LoopConfig {
            max_rmse: 0.99 * usual.rmse,
            ..LoopConfig::default()
        },
        LoopConfig {
            min_inliers: usual.inliers + 1,
            ..LoopConfig::default()
        },
    ] {
        let found = first.verify(&cfg);
        assert!(found.chi2 <= cfg.gate && !found.accepted, "{found:?}");
    }
    let at_the_limits = LoopConfig {
        max_rmse: usual.rmse,
        min_inliers: usual.inliers,
        gate: usual.chi2,
        ..LoopConfig::default()
    };
    assert!(
        first.verify(&at_the_limits).accepted,
        "≤ and ≥, not < and >"
    );
}

#[test]
fn the_gate_is_the_one_that_was_asked_for() {
    let first = First::new();
    let usual = first.verify(&LoopConfig::default());
    let narrow = LoopConfig {
        gate: 0.99 * usual.chi2,
        ..LoopConfig::default()
    };
    let found = first.verify(&narrow);
    assert!(
        !found.accepted,
        "χ² {} is above the gate {}, and the loop was accepted",
        found.chi2, narrow.gate
    );
    let off = First::new().moved(SE2::new(Vector2::zeros(), 0.2));
    let wide = LoopConfig {
        gate: 1e6,
        ..LoopConfig::default()
    };
    let found = off.verify(&wide);
    assert!(
        found.accepted,
        "χ² {} is below the gate {}, and the loop was rejected",
        found.chi2, wide.gate
    );
}

#[test]
fn a_narrow_search_still_pairs_within_0_6_m_and_a_wide_one_within_half_its_radius() {
    let first = First::new().moved(SE2::new(Vector2::new(0.3, -0.2), 0.05));
    for (radius, half_width, tau) in [(0.4, 3, 0.6), (1.0, 1, 0.6), (3.0, 3, 1.5)] {
        let cfg = LoopConfig {
            radius,
            half_width,
            ..LoopConfig::default()
        };
        let (found, expected) = (first.verify(&cfg), first.register(&cfg, tau, 30));
        assert_eq!(
            found.inliers, expected.inliers,
            "pairs at radius {radius} m"
        );
        assert_same_pose(found.edge.z, expected.pose, 1e-9);
    }
}

/// From this belief 25 iterations, the default of a registration, end 5 cm from where 30 end.
#[test]
fn the_registration_may_take_30_iterations() {
    let first = First::new().moved(SE2::new(Vector2::new(-0.2, 0.6), 0.1));
    let cfg = LoopConfig::default();
    let tau = cfg.radius / 2.0;
    let [early, expected] = [25, 30].map(|limit| first.register(&cfg, tau, limit));
    assert!((early.pose.inverse() * expected.pose).step_size() > 0.01);
    assert_same_pose(first.verify(&cfg).edge.z, expected.pose, 1e-9);
}

#[test]
fn the_edge_is_a_loop_and_trusts_its_points_as_it_is_told() {
    let first = First::new();
    let usual = first.verify(&LoopConfig::default());
    assert_eq!(usual.edge.kind, EdgeKind::Loop);
    let omega = |inflate| {
        let cfg = LoopConfig {
            trust: (0.2, inflate),
            ..LoopConfig::default()
        };
        first.verify(&cfg).edge.omega
    };
    let (tight, loose) = (omega(50.0), omega(100.0));
    // The cap is reached by neither. Twice the scale leaves half of what the ridge did not add.
    assert!(tight.diagonal().max() < 2500.0, "{tight}");
    let expected = (tight - Matrix3::identity()) / 2.0 + Matrix3::identity();
    assert!(
        (loose - expected).amax() < 1e-6,
        "with twice the covariance the information is {loose}, expected {expected}"
    );
    assert!(
        (usual.edge.omega - tight).amax() > 1.0,
        "the noise of a point"
    );
}

#[test]
fn the_edge_knows_what_its_pairs_know() {
    let first = First::new();
    let cfg = LoopConfig::default();
    let edge = first.verify(&cfg).edge;
    let map = submap(&first.graph, &first.sweeps, first.old, &cfg);
    let tau = IcpConfig::default().tau.max(cfg.radius / 2.0);
    let pairs = associate(&first.sweeps[first.node.index()], &map, &edge.z, tau);
    let expected = regularize(icp_information(&pairs, 0.05, 25.0), 1.0, 2500.0);
    assert!((edge.omega - expected).amax() < 1e-6, "{}", edge.omega);
}

#[test]
fn a_guess_without_pairs_is_no_loop_whatever_the_limits_are() {
    let limits = LoopConfig {
        max_rmse: f64::INFINITY,
        min_inliers: 0,
        gate: f64::INFINITY,
        ..LoopConfig::default()
    };
    for points in [0, 7, usize::MAX] {
        let mut first = First::new();
        let sweep = &mut first.sweeps[first.node.index()];
        sweep.points.truncate(points);
        let found = first.verify(&limits);
        assert_eq!(
            found.accepted,
            points == usize::MAX,
            "a loop of {} pairs, of which 8 are needed: accepted is {}",
            found.inliers,
            found.accepted
        );
    }
    let far = First::new().moved(SE2::new(Vector2::new(50.0, 0.0), 0.0));
    let found = far.verify(&limits);
    assert!(
        found.inliers == 0 && !found.accepted,
        "a belief 50 m off has no pair: {found:?}"
    );
    let apart = (found.edge.omega - Matrix3::identity()).amax();
    assert!(
        apart < 1e-12,
        "no pair measured anything, so the ridge is left: {}",
        found.edge.omega
    );
}
