//! Verification of one loop: the keyframes before a node, registered together on a submap.
//!
//! If the window is smaller than a metre, registration starts at the graph's relative pose. Otherwise the whole window is
//! searched first, a share of it at each scan, so that no scan takes long: one builds the map of the search, one turns the
//! keyframes, and each of the next evaluates the same number of poses.

use std::sync::Arc;

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::submaps::Submaps;
use super::tuning::{
    BUNDLE, BUNDLE_CELL_M, HALF_SUBMAP, LOOP_FLOOR, MIN_LOOP_SCORE, MIN_MARGIN, SUBMAP_MARGIN_M,
    UNCONFIRMED_M,
};
use super::{MIN_SEARCH_SCORE, MapRegistration, window_search};
use crate::chi_squared::GATE_99;
use crate::cloud::PointCloud;
use crate::loops::{LoopRejection, LoopVerification, LoopWindow};
use crate::metrics::position_error_m;
use crate::search::{ScanSearch, SearchMap, SearchWindow};
use crate::slam::Mapper;

/// Distinct poses are searched up to twice the required margin.
const FARTHEST: f64 = 2.0 * MIN_MARGIN;

/// A verification in progress; its submap is the present one.
#[derive(Clone)]
pub(super) struct WindowSearch {
    window: LoopWindow,
    predicted: SE2,
    bundle: PointCloud,
    stage: Stage,
    /// Number of boxes and poses that were evaluated at the last scan.
    pub evaluated: u64,
}

/// What the next scan does.
#[derive(Clone)]
enum Stage {
    BuildMap,
    TurnScan(Arc<SearchMap>),
    Evaluate(Box<ScanSearch>),
    /// The start, if there is one, and its margin to the best distinct pose.
    Register(Option<SE2>, Option<f64>),
}

impl WindowSearch {
    /// Builds the submap of the keyframes before `end` around the candidate.
    pub fn new(window: LoopWindow, mapper: &Mapper, submaps: &mut Submaps, end: usize) -> Self {
        let poses = mapper.poses();
        let predicted = poses[window.candidate.node].between(&poses[window.node]);
        build_submap(&window, mapper, submaps, end);
        Self {
            predicted,
            bundle: bundle(mapper, window.node),
            stage: if is_sure(&window) {
                Stage::Register(Some(predicted), None)
            } else {
                Stage::BuildMap
            },
            window,
            evaluated: 0,
        }
    }

    /// The share of one scan, of at most `budget` boxes and poses; the result, once there is one.
    pub fn step(&mut self, submaps: &mut Submaps, budget: u64) -> Option<LoopVerification> {
        self.evaluated = 0;
        let nowhere = Stage::Register(None, None);
        let around = SearchWindow::around(self.predicted, self.window.half_m, self.window.half_rad);
        self.stage = match &mut self.stage {
            Stage::BuildMap => submaps.map.search_map().map_or(nowhere, Stage::TurnScan),
            Stage::TurnScan(map) => {
                let search = window_search(Arc::clone(map), &self.bundle, &around, FARTHEST);
                search.map_or(nowhere, |search| Stage::Evaluate(Box::new(search)))
            }
            Stage::Evaluate(search) => {
                let before = search.counts().scored();
                let is_finished = search.advance(budget);
                self.evaluated = search.counts().scored() - before;
                if !is_finished {
                    return None;
                }
                search.result().map_or(nowhere, |found| {
                    let margin = found.margin().unwrap_or(FARTHEST);
                    Stage::Register(Some(found.best.pose), Some(margin))
                })
            }
            &mut Stage::Register(start, margin) => {
                return Some(self.registered(start, margin, submaps));
            }
        };
        None
    }

    fn registered(
        &self,
        start: Option<SE2>,
        margin: Option<f64>,
        submaps: &mut Submaps,
    ) -> LoopVerification {
        let settings = submaps.registration;
        let (max_correspondence_m, inlier_distance_m) =
            (settings.max_correspondence_m, settings.inlier_distance_m);
        let stages = [
            2.0 * max_correspondence_m,
            max_correspondence_m,
            inlier_distance_m,
        ];
        let stages = match start {
            None => &[],
            Some(_) if is_sure(&self.window) => &stages[..],
            Some(_) => &stages[1..],
        };
        let initial = start.unwrap_or(self.predicted);
        let found = submaps
            .map
            .register(&self.bundle, initial, stages, None, &settings);
        let rejection = match start {
            None => Some(LoopRejection::NoPlace {
                half_width_m: self.window.half_m,
                min_score: MIN_SEARCH_SCORE,
            }),
            Some(_) => rejection(&found, margin),
        };
        let information = found.information() + Matrix3::identity() * LOOP_FLOOR;
        let own = information.try_inverse().unwrap_or_default();
        let gate_information = (self.window.covariance + own).try_inverse();
        LoopVerification {
            initial,
            // Without a pose there is no score.
            score: start.is_some().then_some(found.fit.score),
            margin,
            information,
            rejection,
            ..found.verification(
                self.window.node,
                self.window.candidate,
                self.predicted,
                gate_information.unwrap_or_default(),
                GATE_99,
            )
        }
    }
}

/// Whether the window is so small that its loop needs no search and no confirmation.
pub(super) fn is_sure(window: &LoopWindow) -> bool {
    window.half_m <= UNCONFIRMED_M
}

/// The keyframes up to `node` in its frame, thinned.
fn bundle(mapper: &Mapper, node: usize) -> PointCloud {
    let poses = &mapper.poses()[..=node];
    let mut points = PointCloud::default();
    let first = poses.len().saturating_sub(BUNDLE);
    for (pose, keyframe) in poses.iter().zip(mapper.keyframes()).skip(first) {
        points.extend_transformed(&keyframe.scan, &poses[node].between(pose));
    }
    points.downsample(BUNDLE_CELL_M)
}

/// Builds the submap around a candidate in its frame, of the keyframes of one visit within the window.
fn build_submap(window: &LoopWindow, mapper: &Mapper, submaps: &mut Submaps, end: usize) {
    let poses = mapper.poses();
    let here = poses[window.node];
    let reach_m = window.half_m + SUBMAP_MARGIN_M;
    let center = window.candidate.node;
    let is_near = |near: usize| {
        center.abs_diff(near) <= HALF_SUBMAP || position_error_m(&poses[near], &here) < reach_m
    };
    let mut first = center;
    while first > 0 && is_near(first - 1) {
        first -= 1;
    }
    let mut last = center;
    while last + 1 < end && is_near(last + 1) {
        last += 1;
    }
    submaps.build(mapper, first..=last, center);
}

fn rejection(found: &MapRegistration, margin: Option<f64>) -> Option<LoopRejection> {
    let score = found.fit.score;
    if score < MIN_LOOP_SCORE {
        return Some(LoopRejection::LowScore {
            score,
            min_score: MIN_LOOP_SCORE,
        });
    }
    Some(LoopRejection::Ambiguous {
        margin: margin.filter(|margin| *margin < MIN_MARGIN)?,
        min_margin: MIN_MARGIN,
    })
}
