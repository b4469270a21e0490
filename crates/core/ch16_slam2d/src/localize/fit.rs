//! How well scans fit on a map at a pose, and how well scans of this map fit on it.

use pr_geom::{SE2, math, sort_numbers};

use super::{KnownMap, LocalizeConfig};
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, MapFit, MapRegistrationConfig};

/// Number of keyframes from which the usual fit of a map is learned.
const LEARNED_FROM: usize = 32;
/// Quantile of their scores that is expected of a scan at its right pose.
const EXPECTED_QUANTILE: f64 = 0.25;
/// A right pose scores less than expected by at most this, 0 to 1.
const SCORE_SLACK: f64 = 0.05;
/// Share of contradictions that any map may have, 0 to 1.
const CONTRADICTIONS: f64 = 0.05;

/// Fit of scans on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrailFit {
    /// Score of the points, 0 to 1.
    pub score: f64,
    /// Share of all points in space that the map's scans observed as free.
    pub in_free_space: f64,
}

impl TrailFit {
    /// The fit of points on `map` at a pose, where space that no scan has seen costs as in a registration.
    pub fn with_unseen(
        map: &LocalMap,
        points: &PointCloud,
        map_from_points: &SE2,
        config: &MapRegistrationConfig,
    ) -> Self {
        Self::of(&map.fit(points, map_from_points, config), points)
    }

    /// The fit of points on `map` at a pose, where space that no scan has seen does not count.
    pub fn new(
        map: &LocalMap,
        points: &PointCloud,
        map_from_points: &SE2,
        config: &MapRegistrationConfig,
    ) -> Self {
        let fit = map.fit(points, map_from_points, config);
        let shown = (fit.inliers + fit.contradicting) as f64;
        let all = points.len() as f64;
        let cost = (1.0 - fit.score) * all - config.unseen_cost * (all - shown);
        Self {
            score: 1.0 - cost / math::max(shown, 1.0),
            ..Self::of(&fit, points)
        }
    }

    fn of(fit: &MapFit, points: &PointCloud) -> Self {
        Self {
            score: fit.score,
            in_free_space: fit.contradicting as f64 / points.len().max(1) as f64,
        }
    }
}

/// What is expected of a scan at its right pose on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedFit {
    /// Least score of a tracked pose that is not doubtful, 0 to 1.
    pub usual_score: f64,
    /// Least score of a scan that fits, 0 to 1.
    pub good_score: f64,
    /// Least score of a trail at a pose that is accepted, 0 to 1.
    pub found_score: f64,
    /// Largest share of contradictions there, as in [`TrailFit`].
    pub in_free_space: f64,
}

impl ExpectedFit {
    /// Learned from keyframes of the map, each on the others around it: on a map of few scans, or of scans with few
    /// beams, right poses score less.
    pub fn learned(
        map: &KnownMap,
        config: &LocalizeConfig,
        registration: &MapRegistrationConfig,
    ) -> Self {
        let mut around = LocalMap::default();
        let (mut scores, mut in_free) = (Vec::new(), Vec::new());
        let count = map.keyframes().len();
        let tried = count.min(LEARNED_FROM);
        for keyframe in (0..tried).map(|k| k * count / tried) {
            let pose = map.poses()[keyframe];
            let mut near = map.near(&pose, config.near_m, config.near_keyframes + 1);
            near.retain(|other| *other != keyframe);
            if near.is_empty() {
                continue;
            }
            map.build_local(&near, &mut around);
            let scan = &map.keyframes()[keyframe].scan;
            let fit = TrailFit::new(&around, scan, &pose, registration);
            scores.push(fit.score);
            in_free.push(fit.in_free_space);
        }
        let quantile = |values: &mut Vec<f64>, share: f64, or: f64| {
            sort_numbers(values);
            let at = (share * values.len() as f64) as usize;
            values.get(at).copied().unwrap_or(or)
        };
        let expected = quantile(&mut scores, EXPECTED_QUANTILE, 1.0);
        let rest = 1.0 - EXPECTED_QUANTILE;
        let least = |usual: f64, below: f64| math::max(math::min(usual, expected - below), 0.5);
        Self {
            usual_score: least(config.usual_score, SCORE_SLACK),
            good_score: least(config.good_score, 3.0 * SCORE_SLACK),
            found_score: least(config.found_score, SCORE_SLACK),
            in_free_space: CONTRADICTIONS + quantile(&mut in_free, rest, 0.0),
        }
    }
}
