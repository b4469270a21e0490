//! Drift of a chain of edges, drawn edge by edge, against the gate that assumes a sum of independent errors.
//!
//! An edge's heading error turns all later edges, so the position at the end scatters farther than the sum of
//! the edges' own position errors, and in a bent cloud (Barfoot & Furgale 2014; Long, Wolfe, Mashner &
//! Chirikjian 2012).

use ch16_slam2d::chapter::path_information;
use ch16_slam2d::loops::{LoopConfig, chi_squared_gate};
use ch16_slam2d::prelude::Vector3;
use pr_geom::{Rng, SE2};

/// A straight path of `edges` equal steps.
#[must_use]
pub fn straight(edges: usize, step_m: f64) -> Vec<SE2> {
    vec![SE2::from_xy(step_m, 0.0); edges]
}

/// The same, but turned round in place after half of the edges.
#[must_use]
pub fn out_and_back(edges: usize, step_m: f64) -> Vec<SE2> {
    let mut path = straight(edges, step_m);
    let about_face = SE2::new(0.0, 0.0, core::f64::consts::PI);
    if let Some(turn) = path.get_mut(edges / 2) {
        *turn = about_face * *turn;
    }
    path
}

/// The innovation of a right closure over `path`, `ξ = log(T₀⁻¹ T)`, with the errors of the gate's model drawn
/// at each edge: `T₀ = Π Zₖ`, `T = Π Zₖ exp(δₖ)`, `δₖ ~ N(0, diag(s², s², r²))`.
#[must_use]
pub fn drawn_innovation(path: &[SE2], config: &LoopConfig, rng: &mut Rng) -> Vector3<f64> {
    let sigmas = [
        config.drift_sigma_m,
        config.drift_sigma_m,
        config.drift_sigma_rad,
    ];
    let (mut predicted, mut truth) = (SE2::identity(), SE2::identity());
    for edge in path {
        let error = Vector3::from(sigmas.map(|sigma| rng.normal(0.0, sigma)));
        predicted = predicted * *edge;
        truth = truth * *edge * SE2::exp(&error);
    }
    predicted.between(&truth).log()
}

/// Share of right closures over `path` that the gate rejects, of `draws` draws.
#[must_use]
pub fn rejected_share(path: &[SE2], config: &LoopConfig, draws: usize, seed: u32) -> f64 {
    let information = path_information(path.len(), config);
    let mut rng = Rng::new(seed);
    let rejected = (0..draws).filter(|_| {
        let innovation = drawn_innovation(path, config, &mut rng);
        !chi_squared_gate(&innovation, &information, config.gate_chi2).passes()
    });
    rejected.count() as f64 / draws as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRAWS: usize = 4000;

    #[test]
    fn the_gate_rejects_its_nominal_share_only_if_the_robot_does_not_move() {
        let config = LoopConfig::default();
        let rejected = |path: &[SE2]| rejected_share(path, &config, DRAWS, 1);
        // The gate's threshold is the 95 % quantile; 4 standard deviations of a share of 4000 are 1.4 %.
        let still = rejected(&straight(22, 0.0));
        assert!((still - 0.05).abs() < 0.014, "{still}");
        let (back, away) = (
            rejected(&out_and_back(22, 0.4)),
            rejected(&straight(22, 0.4)),
        );
        assert!(still + 0.014 < back && back + 0.014 < away, "{back} {away}");
        // The lever is the cause: without errors of the heading the share is the nominal one again.
        let exact = LoopConfig {
            drift_sigma_rad: 1e-9,
            ..config
        };
        let held = rejected_share(&straight(22, 0.4), &exact, DRAWS, 1);
        assert!((held - 0.05).abs() < 0.014, "{held}");
    }

    #[test]
    fn out_and_back_ends_where_it_began() {
        let end = out_and_back(22, 0.4)
            .iter()
            .fold(SE2::identity(), |at, edge| at * *edge);
        // 1e-12: rounding of 22 sums.
        assert!(end.x().abs() < 1e-12 && end.y().abs() < 1e-12);
    }
}
