//! Random numbers against `rng.json`: every seed, uniform and normal.

use pr_sim::Rng;
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

#[derive(Deserialize)]
struct Case {
    seed: u32,
    uniform: Vec<f64>,
    normal: Vec<f64>,
}

#[test]
fn every_seed_draws_the_reference_numbers() {
    for case in reference::<Vec<Case>>("rng.json") {
        let mut rng = Rng::new(case.seed);
        for (k, expected) in case.uniform.iter().enumerate() {
            let what = format!("uniform {k} of seed {}", case.seed);
            assert_close(&what, rng.unit(), *expected, 1e-9);
        }
        let mut rng = Rng::new(case.seed);
        for (k, expected) in case.normal.iter().enumerate() {
            let what = format!("normal {k} of seed {}", case.seed);
            assert_close(&what, rng.normal(0.0, 1.0), *expected, 1e-9);
        }
    }
}
