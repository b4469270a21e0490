//! Loop closure for robots: registers the newest keyframes together on submaps of older ones.
//!
//! Candidates are submaps within the covariance of the relative pose in the graph. If the window is smaller than a
//! metre, registration starts at the graph's relative pose; otherwise the whole window is searched by branch and
//! bound, the best pose needs a margin to every distinct one, and the loop waits for confirmation by another one
//! along the path. Loops that contradict the graph need two others, and then the outlier test runs over all loops.
//!
//! Sources: Hess et al., "Real-time loop closure in 2D LIDAR SLAM", 2016, for keyframes on submaps; Olson,
//! "Recognizing places using spectrally clustered local matches", 2009, for loops that agree.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use pr_optim::OptimizeError;

use super::pairwise_consistency::are_consistent;
use super::submaps::Submaps;
use super::tuning::{
    AGREEING_CONTRADICTING, AGREEING_EXPECTED, BUNDLE, BUNDLE_CELL_M, EVERY_KEYFRAMES, HALF_SUBMAP,
    LOOP_FLOOR, MAX_TURN_RAD, MIN_LOOP_SCORE, MIN_MARGIN, MIN_SEPARATION_M, PENDING_DISTANCE_M,
    SUBMAP_MARGIN_M, SUBMAPS, UNCONFIRMED_M, WINDOW_FLOOR_M, WINDOW_FLOOR_RAD, WINDOW_SIGMAS,
};
use super::{LocalMapConfig, MIN_SEARCH_SCORE, MapRegistration, SubmapLoopConfig, linking};
use crate::chi_squared::GATE_99;
use crate::cloud::PointCloud;
use crate::loops::{
    Agreement, LoopCandidate, LoopRejection, LoopVerification, PendingLoop, detect_visits,
};
use crate::metrics::position_error_m;
use crate::search::SearchWindow;
use crate::slam::{Consistency, LoopFinder, Mapper, SnapshotError, TriedLoops};

/// Finds loops, and keeps the pending ones.
#[derive(Clone)]
pub(crate) struct SubmapLoops {
    config: SubmapLoopConfig,
    pending: Vec<PendingLoop>,
    submaps: Submaps,
}

/// A submap that may show the surroundings of the newest keyframes, and the uncertainty of the relative pose.
struct Window {
    candidate: LoopCandidate,
    predicted: SE2,
    covariance: Matrix3<f64>,
    half_m: f64,
    half_rad: f64,
}

impl SubmapLoops {
    pub fn new(robot: &LocalMapConfig) -> Self {
        Self {
            config: robot.loops,
            pending: Vec::new(),
            submaps: Submaps::new(robot.registration()),
        }
    }

    /// Windows around older keyframes near the newest one, the nearest first.
    fn windows(&self, mapper: &mut Mapper, lengths_m: &[f64]) -> Vec<Window> {
        let config = &self.config;
        let node = lengths_m.len() - 1;
        let old_enough = old_enough(lengths_m, config.min_path_m);
        let Some(youngest) = old_enough.checked_sub(1) else {
            return Vec::new();
        };
        let radius_m = config.max_window_m + SUBMAP_MARGIN_M;
        let mut windows = Vec::new();
        for candidate in detect_visits(mapper.poses(), node, radius_m, node - youngest) {
            if windows.len() == SUBMAPS {
                break;
            }
            let Ok(covariance) = mapper.graph_mut().relative_covariance(candidate.node, node)
            else {
                continue;
            };
            let sigma = |variance: f64| WINDOW_SIGMAS * math::sqrt(math::max(variance, 0.0));
            let half_m = sigma(math::max(covariance.m11, covariance.m22)) + WINDOW_FLOOR_M;
            let half_rad = sigma(covariance.m33) + WINDOW_FLOOR_RAD;
            let half_m = math::min(half_m, config.max_window_m);
            if candidate.distance_m > half_m + SUBMAP_MARGIN_M {
                continue;
            }
            let poses = mapper.poses();
            windows.push(Window {
                candidate,
                predicted: poses[candidate.node].between(&poses[node]),
                covariance,
                half_m,
                half_rad: math::min(half_rad, MAX_TURN_RAD),
            });
        }
        windows
    }

    /// The newest keyframes in the frame of the last one, thinned.
    fn bundle(&self, mapper: &Mapper) -> PointCloud {
        let poses = mapper.poses();
        let here = poses[poses.len() - 1];
        let mut points = PointCloud::default();
        let first = poses.len().saturating_sub(BUNDLE);
        for (pose, keyframe) in poses.iter().zip(mapper.keyframes()).skip(first) {
            points.extend_transformed(&keyframe.scan, &here.between(pose));
        }
        points.downsample(BUNDLE_CELL_M)
    }

    /// Builds the submap around a candidate in its frame, of the keyframes of one visit within the
    /// window.
    fn build_submap(&mut self, mapper: &Mapper, window: &Window, lengths_m: &[f64]) {
        let node = lengths_m.len() - 1;
        let poses = mapper.poses();
        let here = poses[node];
        let reach_m = window.half_m + SUBMAP_MARGIN_M;
        let last = old_enough(lengths_m, self.config.min_path_m) - 1;
        let center = window.candidate.node;
        let is_near = |near: usize| {
            center.abs_diff(near) <= HALF_SUBMAP || position_error_m(&poses[near], &here) < reach_m
        };
        let mut first = center;
        while first > 0 && is_near(first - 1) {
            first -= 1;
        }
        let mut end = center;
        while end < last && is_near(end + 1) {
            end += 1;
        }
        self.submaps.build(mapper, first..=end, center);
    }

    fn verify_window(
        &mut self,
        mapper: &Mapper,
        window: &Window,
        bundle: &PointCloud,
        lengths_m: &[f64],
    ) -> LoopVerification {
        self.build_submap(mapper, window, lengths_m);
        let is_sure = window.half_m <= UNCONFIRMED_M;
        let (start, margin) = if is_sure {
            (Some(window.predicted), None)
        } else {
            self.search(window, bundle)
        };
        let settings = self.submaps.registration;
        let (max_correspondence_m, inlier_distance_m) =
            (settings.max_correspondence_m, settings.inlier_distance_m);
        let stages = [
            2.0 * max_correspondence_m,
            max_correspondence_m,
            inlier_distance_m,
        ];
        let stages = if is_sure { &stages[..] } else { &stages[1..] };
        let from = start.unwrap_or(window.predicted);
        let stages = if start.is_some() { stages } else { &[] };
        let found = self
            .submaps
            .map
            .register(bundle, from, stages, None, &settings);
        let rejection = match start {
            None => Some(LoopRejection::NoPlace {
                half_width_m: window.half_m,
                min_score: MIN_SEARCH_SCORE,
            }),
            Some(_) => rejection(&found, margin),
        };
        self.verification(window, lengths_m.len() - 1, from, &found, margin, rejection)
    }

    /// The best pose of the window, and its margin to the best distinct one.
    fn search(&self, window: &Window, bundle: &PointCloud) -> (Option<SE2>, Option<f64>) {
        let around = SearchWindow::around(window.predicted, window.half_m, window.half_rad);
        // Distinct poses are searched up to twice the required margin.
        let farthest = 2.0 * MIN_MARGIN;
        match self.submaps.map.search(bundle, &around, farthest) {
            Some(found) => (
                Some(found.best.pose),
                Some(found.margin().unwrap_or(farthest)),
            ),
            None => (None, None),
        }
    }

    fn verification(
        &self,
        window: &Window,
        node: usize,
        initial: SE2,
        found: &MapRegistration,
        margin: Option<f64>,
        rejection: Option<LoopRejection>,
    ) -> LoopVerification {
        let information = found.information() + Matrix3::identity() * LOOP_FLOOR;
        let own = information.try_inverse().unwrap_or_default();
        let gate_information = (window.covariance + own).try_inverse().unwrap_or_default();
        let is_nowhere = matches!(rejection, Some(LoopRejection::NoPlace { .. }));
        LoopVerification {
            initial,
            // Without a pose there is no score.
            score: (!is_nowhere).then_some(found.fit.score),
            margin,
            information,
            rejection,
            ..found.verification(
                node,
                window.candidate,
                window.predicted,
                gate_information,
                GATE_99,
            )
        }
    }

    /// Indices of the pending loops that agree with this one.
    fn agreeing(
        &self,
        mapper: &mut Mapper,
        found: &LoopVerification,
        lengths_m: &[f64],
    ) -> Vec<usize> {
        let path_m = lengths_m[found.from_node];
        let mut agreeing = Vec::new();
        for (index, other) in self.pending.iter().enumerate() {
            let apart_m = path_m - other.path_m;
            let is_beside = apart_m < MIN_SEPARATION_M;
            if is_beside || apart_m > PENDING_DISTANCE_M {
                continue;
            }
            if are_consistent(mapper, &other.verification, found) {
                agreeing.push(index);
            }
        }
        agreeing
    }
}

impl LoopFinder for SubmapLoops {
    fn every_keyframes(&self) -> usize {
        EVERY_KEYFRAMES
    }

    fn find(&mut self, mapper: &mut Mapper) -> TriedLoops {
        let mut tried = TriedLoops::default();
        let lengths_m = mapper.path_lengths_m();
        let windows = self.windows(mapper, &lengths_m);
        if windows.is_empty() {
            return tried;
        }
        let bundle = self.bundle(mapper);
        for window in windows {
            let found = self.verify_window(mapper, &window, &bundle, &lengths_m);
            let is_expected = found.gate.passes();
            if !found.accepted() || (is_expected && window.half_m <= UNCONFIRMED_M) {
                tried.found.push(found);
                continue;
            }
            let agreeing = self.agreeing(mapper, &found, &lengths_m);
            let needed = if is_expected {
                AGREEING_EXPECTED
            } else {
                AGREEING_CONTRADICTING
            };
            let path_m = lengths_m[found.from_node];
            if agreeing.len() + 1 < needed {
                let reach_m = PENDING_DISTANCE_M;
                self.pending
                    .retain(|other| path_m - other.path_m <= reach_m);
                self.pending.push(PendingLoop {
                    verification: found,
                    path_m,
                    is_expected,
                });
                tried.found.push(LoopVerification {
                    waits: Some(Agreement {
                        agreeing: agreeing.len() + 1,
                        needed,
                    }),
                    ..found
                });
                continue;
            }
            for index in agreeing.into_iter().rev() {
                let waited = self.pending.remove(index);
                if !waited.is_expected {
                    tried.consistency = Consistency::Contradicting;
                }
                tried.found.push(waited.verification);
            }
            if !is_expected {
                tried.consistency = Consistency::Contradicting;
            }
            tried.found.push(found);
        }
        tried
    }

    /// Accepts the newest pending loop if no pending loop contradicts the graph.
    fn conclude(&mut self, mapper: &mut Mapper, is_searched: bool) -> Option<TriedLoops> {
        let mut tried = TriedLoops::default();
        if !is_searched {
            tried = self.find(mapper);
        }
        if tried.found.iter().any(LoopVerification::accepted) {
            return Some(tried);
        }
        let pending = core::mem::take(&mut self.pending);
        let last = pending.last().filter(|last| last.is_expected);
        let is_alone = pending.iter().all(|other| other.is_expected);
        if let Some(last) = last.filter(|_| is_alone) {
            tried.found.push(last.verification);
        }
        Some(tried)
    }

    fn link_all(&mut self, mapper: &mut Mapper) -> Vec<LoopVerification> {
        linking::link_all(mapper, &mut self.submaps)
    }

    fn verify(
        &mut self,
        mapper: &mut Mapper,
        old: usize,
        new: usize,
    ) -> Result<LoopVerification, OptimizeError> {
        linking::link_on_request(mapper, old, new, &mut self.submaps)
    }

    fn pending(&self) -> &[PendingLoop] {
        &self.pending
    }

    fn restore(&mut self, pending: &[PendingLoop]) -> Result<(), SnapshotError> {
        self.pending = pending.to_vec();
        Ok(())
    }

    fn remove_keyframe(&mut self, node: usize, path_m: &[f64]) {
        let moved_up = |known: usize| known - usize::from(known > node);
        self.submaps.forget();
        self.pending.retain(|pending| {
            let found = &pending.verification;
            found.from_node != node && found.candidate.node != node
        });
        for pending in &mut self.pending {
            let found = &mut pending.verification;
            found.from_node = moved_up(found.from_node);
            found.candidate.node = moved_up(found.candidate.node);
            pending.path_m = path_m[found.from_node];
        }
    }
}

/// Number of keyframes that are at least this far back along the path, m.
fn old_enough(lengths_m: &[f64], min_path_m: f64) -> usize {
    let here_m = lengths_m.last().copied().unwrap_or_default();
    lengths_m.partition_point(|length_m| *length_m < here_m - min_path_m)
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
