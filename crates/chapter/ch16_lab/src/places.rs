//! Place recognition: every pair of keyframes of many laps, graded for every detector.
//!
//! A pair shows the same place if its true positions are within [`SAME_PLACE_M`]. A detector assigns each
//! pair a distance; pairs below a threshold count as detected. Precision is the share of right pairs among
//! the detected ones, recall the share of detected pairs among the right ones.

mod study;

pub use study::{Place, PlaceStudy};

use crate::lap::{Lap, LapConfig, LapDetector};
use pr_geom::order_by;
use serde::Serialize;

/// True positions closer than this are the same place, m.
pub const SAME_PLACE_M: f64 = 1.0;

/// The detectors that assign every pair a distance.
pub const GRADED: [LapDetector; 3] = [
    LapDetector::Nearby,
    LapDetector::Histogram,
    LapDetector::Context,
];

/// Number of points of a curve.
const CURVE_POINTS: usize = 50;

/// A pair of keyframes that are far apart in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacePair {
    /// The lap's seed.
    pub seed: u32,
    /// The older and the newer keyframe.
    pub nodes: [usize; 2],
    /// Whether the true positions are within [`SAME_PLACE_M`].
    pub is_same: bool,
    /// The distance by each detector, in the order of [`GRADED`].
    pub distances: [f64; GRADED.len()],
}

/// Precision and recall of a detector at one threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OperatingPoint {
    /// Pairs at this distance or below are detected.
    pub threshold: f64,
    /// Share of right pairs among the detected ones.
    pub precision: f64,
    /// Share of detected pairs among the right ones.
    pub recall: f64,
}

/// Precision and recall of a detector at all thresholds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceCurve {
    /// The detector.
    pub detector: LapDetector,
    /// From the strictest threshold to the loosest, evenly spaced in recall.
    pub points: Vec<OperatingPoint>,
    /// Mean precision over the recall: the area below the curve.
    pub average_precision: f64,
    /// Recall at the loosest threshold without a false pair.
    pub recall_without_errors: f64,
}

/// The recall at which detectors are compared.
pub const FIXED_RECALL: f64 = 0.5;

impl PlaceCurve {
    /// Precision at the strictest threshold that detects [`FIXED_RECALL`] of the right pairs. Chance has the share of the
    /// right pairs there, a perfect detector 1.
    #[must_use]
    pub fn precision_at_fixed_recall(&self) -> Option<f64> {
        let mut points = self.points.iter();
        let point = points.find(|point| point.recall >= FIXED_RECALL);
        point.map(|point| point.precision)
    }
}

/// The pairs of one lap that ran with the front end alone.
///
/// Distances between poses are those of the front end, in standard deviations of the drift that the gate
/// assumes: all that is known before the first loop.
#[must_use]
pub fn place_pairs(config: &LapConfig) -> Vec<PlacePair> {
    let mut lap = Lap::new(config.clone().without_loops());
    lap.run();
    PlaceStudy::new(&lap).run().graded().copied().collect()
}

/// The curve of every detector over these pairs.
#[must_use]
pub fn place_curves(pairs: &[PlacePair]) -> Vec<PlaceCurve> {
    let detectors = GRADED.iter().enumerate();
    detectors
        .map(|(index, &detector)| curve(pairs, index, detector))
        .collect()
}

fn curve(pairs: &[PlacePair], index: usize, detector: LapDetector) -> PlaceCurve {
    let ranked: Vec<(f64, bool)> = order_by(pairs.len(), &|pair| pairs[pair].distances[index])
        .into_iter()
        .map(|pair| (pairs[pair].distances[index], pairs[pair].is_same))
        .collect();
    let same = ranked.iter().filter(|(_, is_same)| *is_same).count();
    let mut curve = PlaceCurve {
        detector,
        points: Vec::new(),
        average_precision: 0.0,
        recall_without_errors: 0.0,
    };
    let (mut found, mut last_recall) = (0, 0.0);
    for (k, &(threshold, is_same)) in ranked.iter().enumerate() {
        found += usize::from(is_same);
        // Equal distances share one threshold.
        if ranked.get(k + 1).is_some_and(|next| next.0 == threshold) || same == 0 {
            continue;
        }
        let point = OperatingPoint {
            threshold,
            precision: found as f64 / (k + 1) as f64,
            recall: found as f64 / same as f64,
        };
        curve.average_precision += (point.recall - last_recall) * point.precision;
        if found == k + 1 {
            curve.recall_without_errors = point.recall;
        }
        let due = curve.points.len() as f64 / CURVE_POINTS as f64;
        if point.recall > last_recall && point.recall >= due {
            curve.points.push(point);
        }
        last_recall = point.recall;
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(is_same: bool, distance: f64) -> PlacePair {
        PlacePair {
            seed: 1,
            nodes: [0, 30],
            is_same,
            distances: [distance; 3],
        }
    }

    #[test]
    fn the_area_and_the_recall_are_those_of_a_ranking_by_hand() {
        // Ranked: same, same, other, same, other.
        let pairs = [
            pair(true, 0.1),
            pair(true, 0.2),
            pair(false, 0.3),
            pair(true, 0.4),
            pair(false, 0.5),
        ];
        let curve = &place_curves(&pairs)[0];
        // ⅓ · 1 + ⅓ · 1 + ⅓ · ¾.
        assert!((curve.average_precision - 11.0 / 12.0).abs() < 1e-12);
        assert!((curve.recall_without_errors - 2.0 / 3.0).abs() < 1e-12);
        let last = curve.points.last().unwrap();
        assert_eq!(
            (last.threshold, last.precision, last.recall),
            (0.4, 0.75, 1.0)
        );
    }

    #[test]
    fn pairs_at_equal_distance_stand_or_fall_together() {
        let pairs = [pair(false, 0.1), pair(true, 0.1)];
        let curve = &place_curves(&pairs)[0];
        assert!((curve.average_precision - 0.5).abs() < 1e-12);
        assert_eq!(curve.recall_without_errors, 0.0);
    }

    #[test]
    fn looks_recognize_places_of_the_lap_better_than_chance_and_context_better_than_ranges() {
        let pairs: Vec<_> = (1..=3)
            .flat_map(|seed| place_pairs(&LapConfig::with_seed_and_noise(seed, 1.0)))
            .collect();
        let same = pairs.iter().filter(|pair| pair.is_same).count();
        let chance = same as f64 / pairs.len() as f64;
        let [nearby, histogram, context] = place_curves(&pairs).try_into().unwrap();
        assert!(same > 50 && chance < 0.5, "{same} of {}", pairs.len());
        assert!(histogram.average_precision > 1.2 * chance);
        assert!(context.average_precision > histogram.average_precision);
        // On a short lap with good scan matching the pose itself is the best detector.
        assert!(nearby.average_precision > histogram.average_precision);
    }
}
