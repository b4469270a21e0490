//! The trial of a pose from a search against its rivals: other poses on the map, and "not on the map".

use nalgebra::{Matrix2, Vector2};
use pr_geom::{SE2, math};

use super::fit::TrailFit;
use super::trail::{Trail, thinned};
use super::{KnownMap, LocalizeConfig};
use crate::cloud::PointCloud;
use crate::local_map::{LocalMap, MapRegistrationConfig};
use crate::metrics::position_error_m;
use crate::search::SearchResult;

/// Cell to which a trail is thinned to be compared at its possible poses, m.
const TRAIL_CELL_M: f64 = 0.15;
/// The map shows the surroundings of a sweep if a keyframe was taken within this distance, m.
const ON_THE_MAP_M: f64 = 1.5;
/// Spread of the walls of a square room for each metre of its side, √(1/6).
const ROOM_SPREAD: f64 = 0.41;
/// A map is hardly larger than a room if a room has more than this share of its extent.
const ROOM_SHARE: f64 = 0.6;

/// A trail on trial.
pub struct Trial<'a> {
    pub map: &'a KnownMap,
    pub trail: &'a Trail,
    /// The newest scan.
    pub scan: &'a PointCloud,
    pub config: &'a LocalizeConfig,
    pub registration: &'a MapRegistrationConfig,
}

/// The best pose of a trail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    /// `map_from_body`.
    pub pose: SE2,
    /// The whole trail, and the part of it that was taken on the map.
    pub parts: [TriedPart; 2],
    /// How much better the trail fits there than at any other pose.
    pub margin: f64,
}

/// A part of a trail at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriedPart {
    /// Its fit.
    pub fit: TrailFit,
    /// Its extent: standard deviation of the points along their principal direction, m.
    pub spread_m: f64,
}

impl Trial<'_> {
    /// The best pose of the whole trail, with its margin to every other pose that was found, now or in the last search:
    /// all are registered and scored alike.
    pub fn run(&self, result: &SearchResult, candidate: Option<SE2>) -> Option<Tried> {
        let reach_m = self.map.scale() * self.config.search_reach_m;
        let points = self.trail.cloud(self.scan, reach_m, TRAIL_CELL_M);
        let mut around = LocalMap::default();
        let stages = [
            2.0 * self.registration.max_correspondence_m,
            self.registration.max_correspondence_m,
            self.registration.inlier_distance_m,
        ];
        let rival = result.runner_up.map(|scored| scored.pose);
        let poses = [Some(result.best.pose), rival, candidate];
        let mut compared: Vec<(SE2, TrailFit)> = Vec::new();
        for pose in poses.into_iter().flatten() {
            self.map.build_local(&self.map.around(&pose), &mut around);
            let found = around.register(&points, pose, &stages, None, self.registration);
            let pose = found.registered.pose;
            let fit = TrailFit::with_unseen(&around, &points, &pose, self.registration);
            compared.push((pose, fit));
        }
        compared.sort_by(|a, b| b.1.score.total_cmp(&a.1.score));
        let (pose, whole) = *compared.first()?;
        let distinct = self.config.neighborhood;
        let is_other = |other: &SE2| {
            position_error_m(other, &pose) > distinct.reach_m
                || other.between(&pose).theta().abs() > distinct.turn_rad
        };
        let rival = compared.iter().find(|(other, _)| is_other(other));
        // Poses that were not found score less by more than the margin.
        let mut margin = rival.map_or(self.config.unconfirmed_margin, |(_, other)| {
            whole.score - other.score
        });
        if !is_other(&result.best.pose) {
            // In space that no scan has seen a search scores less, so rivals there are farther behind.
            margin = math::max(margin, result.margin().unwrap_or(1.0));
        }
        let is_on_the_map = |body_from_sweep: &SE2| {
            let near_m = self.map.scale() * ON_THE_MAP_M;
            let at = pose * *body_from_sweep;
            !self.map.near(&at, near_m, 1).is_empty()
        };
        let shown = self.trail.sweeps_of(self.scan, is_on_the_map);
        self.map.build_local(&self.map.around(&pose), &mut around);
        Some(Tried {
            pose,
            parts: [
                TriedPart {
                    // A search does not know space that no scan has seen: there a registration scores too well.
                    fit: TrailFit {
                        score: math::min(whole.score, result.best.score),
                        ..whole
                    },
                    spread_m: spread_m(&points),
                },
                TriedPart {
                    fit: TrailFit::with_unseen(&around, &shown, &pose, self.registration),
                    spread_m: spread_m(&thinned(&shown, reach_m, TRAIL_CELL_M)),
                },
            ],
            margin,
        })
    }

    /// Extent of a room that the building may have several times, on the map or not, as in [`TriedPart::spread_m`].
    pub fn room_spread_m(&self) -> f64 {
        math::min(
            ROOM_SPREAD * self.config.room_m,
            ROOM_SHARE * spread_m(self.map.points()),
        )
    }
}

/// Standard deviation of points along their principal direction, m.
fn spread_m(points: &PointCloud) -> f64 {
    let count = points.len().max(1) as f64;
    let sum = points
        .iter()
        .map(|point| point.coords)
        .sum::<Vector2<f64>>();
    let mean = sum / count;
    let squares = points.iter().map(|point| {
        let off = point.coords - mean;
        off * off.transpose()
    });
    let scatter = squares.sum::<Matrix2<f64>>() / count;
    let half_gap = math::norm2(0.5 * (scatter.m11 - scatter.m22), scatter.m12);
    math::sqrt(0.5 * (scatter.m11 + scatter.m22) + half_gap)
}
