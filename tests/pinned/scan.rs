//! LiDAR sweeps in the Apartment against `scan.json`: true ranges and noisy ones.

use pr_geom::SE2;
use pr_sim::{Lidar, LidarConfig, Rng, World};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

#[derive(Deserialize)]
struct Case {
    pose: [f64; 3],
    beams: usize,
    max_range: f64,
    true_ranges: Vec<f64>,
    noisy_seed: u32,
    noisy_sigma: f64,
    noisy_ranges: Vec<f64>,
}

#[test]
fn every_sweep_has_the_reference_ranges() {
    let world = World::apartment();
    for case in reference::<Vec<Case>>("scan.json") {
        let mut lidar = Lidar::new(LidarConfig {
            beams: case.beams,
            max_range_m: case.max_range,
            range_sigma_m: case.noisy_sigma,
            ..LidarConfig::default()
        });
        let [x, y, theta] = case.pose;
        let pose = SE2::new(x, y, theta);
        let mut ranges = Vec::new();
        lidar.measure_into(&world, &pose, &mut ranges);
        assert_ranges(&case.pose, "true", &ranges, &case.true_ranges);
        lidar.sense_into(&world, &pose, &mut Rng::new(case.noisy_seed), &mut ranges);
        assert_ranges(&case.pose, "noisy", &ranges, &case.noisy_ranges);
    }
}

fn assert_ranges(pose: &[f64; 3], kind: &str, ranges: &[f64], expected: &[f64]) {
    assert_eq!(ranges.len(), expected.len());
    for (beam, (range, expected)) in ranges.iter().zip(expected).enumerate() {
        assert_close(
            &format!("{kind} range {beam} at {pose:?}"),
            *range,
            *expected,
            1e-9,
        );
    }
}
