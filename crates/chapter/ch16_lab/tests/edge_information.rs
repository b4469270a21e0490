//! The information of an edge is the Hessian of what its registration minimized.

use ch16_lab::lap::{Lap, LapConfig, LapRunner};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::icp::{INFORMATION_CAP, INFORMATION_RIDGE, Pair, regularize};
use ch16_slam2d::matching::TrustConfig;
use pr_geom::{Matrix3, SE2, Vector3};

/// `½ Σ r² / (σ² · covariance_scale)` after the edge's target is moved to `T exp(δ)` with the pairs kept: along the
/// normal where a pair has one, along both axes where it has none.
fn cost(pairs: &[Pair], target_from_body: &SE2, delta: &Vector3<f64>, trust: &TrustConfig) -> f64 {
    let moved = target_from_body.boxplus(delta) * target_from_body.inverse();
    let squares = pairs.iter().map(|pair| {
        // The pairs' own gaps depend on δ to second order only through the curvature of a rotation, which
        // Gauss–Newton neglects; so each pair is treated as if it fitted.
        let gap = moved.transform(pair.source) - pair.source;
        match pair.normal {
            Some(normal) => normal.dot(&gap) * normal.dot(&gap),
            None => gap.norm_squared(),
        }
    });
    0.5 * squares.sum::<f64>() / (trust.sigma_m * trust.sigma_m * trust.covariance_scale)
}

fn numerical_hessian(pairs: &[Pair], target_from_body: &SE2, trust: &TrustConfig) -> Matrix3<f64> {
    let step = 1e-4;
    let unit = |k: usize| Vector3::from_fn(|row, _| if row == k { step } else { 0.0 });
    Matrix3::from_fn(|a, b| {
        let at = |i: f64, j: f64| {
            let delta = unit(a) * i + unit(b) * j;
            cost(pairs, target_from_body, &delta, trust)
        };
        (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * step * step)
    })
}

/// Largest difference of two matrices, as a share of the first one's largest entry.
fn off(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).abs().max() / a.abs().max()
}

/// Difference between the information of every odometry edge of a lap and the Hessian of its registration.
fn of_odometry(frame: InformationFrame) -> Vec<f64> {
    let config = LapConfig::default().with_information(frame);
    let record = LapRunner::new().run(&config);
    let edges = record.lap.edges(record.ticks());
    let odometry = edges.iter().filter(|edge| edge.kind == EdgeKind::Odometry);
    odometry
        .map(|edge| {
            let view = record
                .registration(edge.tick)
                .expect("a tick after the start");
            let trust = config.slam.chapter.odometry_trust;
            let hessian = numerical_hessian(&view.icp.pairs, &view.icp.pose, &trust);
            let hessian = regularize(hessian, INFORMATION_RIDGE, INFORMATION_CAP);
            off(&hessian, &edge.information)
        })
        .collect()
}

/// The same difference for every loop that is tried.
fn of_loops(frame: InformationFrame) -> Vec<f64> {
    let config = LapConfig::default().with_information(frame);
    let mut lap = Lap::new(config.clone());
    let mut found = Vec::new();
    while let Some(report) = lap.step() {
        let Some(attempt) = report.loop_attempt else {
            continue;
        };
        let (pairs, pose) = (
            lap.slam().loop_workspace().unwrap().pairs(),
            attempt.verification.registered,
        );
        let hessian = numerical_hessian(pairs, &pose, &config.slam.chapter.loops.trust);
        let hessian = regularize(hessian, INFORMATION_RIDGE, INFORMATION_CAP);
        found.push(off(&hessian, &attempt.verification.information));
    }
    found
}

#[test]
fn every_edge_of_a_lap_has_the_hessian_of_its_registration_and_the_chapters_do_not() {
    for edges in [of_odometry, of_loops] {
        let exact = edges(InformationFrame::Exact);
        assert!(exact.len() > 1);
        // 1e-5: central differences with steps of 1e-4 are off by 1e-8 times the fourth derivative, which
        // grows with the fourth power of the arms of 6 m, and by rounding.
        assert!(exact.iter().all(|off| *off < 1e-5), "{exact:?}");
        let chapter = edges(InformationFrame::Chapter);
        // The smallest difference is 0.004, where all headings happen to be alike: 400 times the bound above.
        assert!(chapter.iter().all(|off| *off > 1e-3), "{chapter:?}");
    }
}
