//! 7. Place recognition by range histograms.

use ch16_lab::lap::{Lap, LapConfig};
use ch16_listings::{PointCloud, SE2};
use ch16_slam2d::loops::{LoopDetector, LoopQuery};
use ch16_slam2d::places::{PlaceDetector, PlaceDetectorConfig};
use exercises::{chi2_distance, detect_by_histogram, range_histogram};
use nalgebra::{Point2, Vector2};

use crate::canonical::listing;

fn seen(ranges_m: &[f64]) -> PointCloud {
    PointCloud {
        points: ranges_m
            .iter()
            .map(|&range| Point2::new(0.0, -range))
            .collect(),
        stamp: 0.0,
    }
}

/// By hand: shares (½, ¼, ¼) and (¼, ¾, 0) give ½ (1/16 / ¾ + ¼ / 1 + 1/16 / ¼) = 7/24.
#[test]
fn the_distance_is_that_of_chi_squared() {
    let of = |ranges_m: &[f64]| range_histogram(&seen(ranges_m), 6.0);
    let (a, b) = (of(&[0.5, 0.5, 2.0, 3.0]), of(&[0.5, 2.0, 2.0, 2.0]));
    assert!((chi2_distance(&a, &b) - 7.0 / 24.0).abs() < 1e-12);
    assert_eq!(chi2_distance(&a, &b), chi2_distance(&b, &a));
    assert_eq!(chi2_distance(&a, &a), 0.0);
    assert_eq!(chi2_distance(&of(&[1.0]), &of(&[4.0])), 1.0);
}

#[test]
fn a_turn_changes_nothing_and_a_return_beyond_the_last_bin_counts_in_it() {
    let cloud = seen(&[0.05, 0.1, 2.0, 5.99, 7.5]);
    let shares = range_histogram(&cloud, 6.0);
    // Bins of 6 m / 64 = 0.094 m.
    for (bin, share) in [(0, 0.2), (1, 0.2), (21, 0.2), (63, 0.4)] {
        assert!((shares[bin] - share).abs() < 1e-12, "bin {bin}: {shares:?}");
    }
    let turned = cloud.transformed(&SE2::new(Vector2::zeros(), 2.1));
    assert_eq!(range_histogram(&turned, 6.0), shares);
    assert_eq!(range_histogram(&seen(&[]), 6.0), [0.0; 64]);
}

/// At the default, 0.15, no two places of the lap are similar enough.
const MAX_DISTANCE: f64 = 0.3;

/// The core's detector on the chapter's lap without loops.
#[test]
fn the_proposals_are_those_of_the_core_in_their_order() {
    let mut lap = Lap::new(LapConfig::default().without_loops());
    lap.run();
    let keyframes = lap.slam().keyframes();
    let sweeps: Vec<PointCloud> = keyframes.iter().map(|k| listing(&k.scan)).collect();
    let mut core = PlaceDetector::new(PlaceDetectorConfig {
        max_distance: MAX_DISTANCE,
        ..PlaceDetectorConfig::histogram(22)
    });
    let mut proposed = 0;
    for node in 0..sweeps.len() {
        let mut graph = lap.graph().clone();
        let known = &keyframes[..=node];
        let expected = core.detect(&mut LoopQuery::new(&mut graph, known));
        let expected: Vec<usize> = expected.iter().map(|old| old.node).collect();
        let found = detect_by_histogram(&sweeps, node, 22, 6.0, MAX_DISTANCE);
        assert_eq!(found, expected, "node {node}");
        proposed += found.len();
    }
    assert!(proposed > 10, "{proposed} proposals are too few to compare");
}

#[test]
fn of_equals_the_older_comes_first_and_the_young_are_left_out() {
    let sweeps = vec![seen(&[1.0, 2.0]); 6];
    assert_eq!(detect_by_histogram(&sweeps, 5, 3, 6.0, 0.15), [0, 1, 2]);
    assert!(detect_by_histogram(&sweeps, 2, 3, 6.0, 0.15).is_empty());
    assert_eq!(
        detect_by_histogram(&sweeps, 5, 0, 6.0, 0.15),
        [0, 1, 2, 3, 4]
    );
    let shares = |sweep: &PointCloud| range_histogram(sweep, 6.0);
    let other = seen(&[1.0, 4.0]);
    let limit = chi2_distance(&shares(&sweeps[0]), &shares(&other));
    let sweeps = [&sweeps[..3], &[other]].concat();
    assert_eq!(
        detect_by_histogram(&sweeps, 3, 1, 6.0, limit),
        [0, 1, 2],
        "≤, not <"
    );
}
