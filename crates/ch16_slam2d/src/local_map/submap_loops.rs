//! Loop closure for robots: registers the newest keyframes together on submaps of older ones.
//!
//! Candidates are submaps within the covariance of the relative pose in the graph. A loop in a window of more than a
//! metre, which is searched over several scans, needs a margin to every distinct pose, and waits for confirmation by
//! another one along the path. Loops that contradict the graph need two others, and then the outlier test runs over all
//! loops.
//!
//! Sources: Hess et al., "Real-time loop closure in 2D LIDAR SLAM", 2016, for keyframes on submaps; Olson,
//! "Recognizing places using spectrally clustered local matches", 2009, for loops that agree.

use pr_geom::math;
use pr_optim::OptimizeError;

use super::pairwise_consistency::are_consistent;
use super::submaps::Submaps;
use super::tuning::{
    AGREEING_CONTRADICTING, AGREEING_EXPECTED, EVALUATIONS, EVERY_KEYFRAMES, MAX_TURN_RAD,
    MIN_SEPARATION_M, PENDING_DISTANCE_M, SUBMAP_MARGIN_M, SUBMAPS, WINDOW_FLOOR_M,
    WINDOW_FLOOR_RAD, WINDOW_SIGMAS,
};
use super::window_search::{WindowSearch, is_sure};
use super::{LocalMapConfig, SubmapLoopConfig, linking};
use crate::loops::{
    Agreement, LoopSearches, LoopVerification, LoopWindow, PendingLoop, detect_visits,
};
use crate::slam::{Consistency, LoopFinder, Mapper, SnapshotError, TriedLoops};

/// Finds loops, and keeps the pending ones.
#[derive(Clone)]
pub(crate) struct SubmapLoops {
    config: SubmapLoopConfig,
    /// Largest number of boxes and poses that are evaluated at a scan.
    budget: u64,
    pending: Vec<PendingLoop>,
    searches: LoopSearches,
    /// The search of the first window; it is repeated if it was dropped.
    active: Option<WindowSearch>,
    submaps: Submaps,
}

impl SubmapLoops {
    pub fn new(robot: &LocalMapConfig) -> Self {
        Self {
            config: robot.loops,
            budget: EVALUATIONS,
            pending: Vec::new(),
            searches: LoopSearches::default(),
            active: None,
            submaps: Submaps::new(robot.registration()),
        }
    }

    #[cfg(test)]
    pub fn with_budget(mut self, budget: u64) -> Self {
        self.budget = budget;
        self
    }

    /// Windows around keyframes that are near `node` and older, the nearest first.
    fn windows(&self, mapper: &mut Mapper, node: usize) -> Vec<LoopWindow> {
        let config = &self.config;
        let old_enough = old_enough(&mapper.path_lengths_m()[..=node], config.min_path_m);
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
            windows.push(LoopWindow {
                node,
                candidate,
                covariance,
                half_m,
                half_rad: math::min(half_rad, MAX_TURN_RAD),
            });
        }
        windows
    }

    /// The share of one scan of the search of `window`; the result, once there is one.
    fn search(
        &mut self,
        mapper: &Mapper,
        window: LoopWindow,
        evaluated: &mut u64,
    ) -> Option<LoopVerification> {
        let is_begun = self.active.is_some();
        let lengths_m = mapper.path_lengths_m();
        let submaps = &mut self.submaps;
        let active = self.active.get_or_insert_with(|| {
            let end = old_enough(&lengths_m[..=window.node], self.config.min_path_m);
            WindowSearch::new(window, mapper, submaps, end)
        });
        // What was done before the search was dropped.
        let missed = if is_begun { 0 } else { self.searches.scans };
        let found = (0..=missed).find_map(|_| active.step(submaps, self.budget));
        *evaluated += active.evaluated;
        self.searches.scans += 1;
        if found.is_some() {
            self.active = None;
            self.searches.windows.remove(0);
            self.searches.scans = 0;
        }
        found
    }

    /// Closes a loop, or lets it wait for others.
    fn decide(
        &mut self,
        mapper: &mut Mapper,
        window: &LoopWindow,
        found: LoopVerification,
        tried: &mut TriedLoops,
    ) {
        let is_expected = found.gate.passes();
        if !found.accepted() || (is_expected && is_sure(window)) {
            tried.found.push(found);
            return;
        }
        let path_m = mapper.path_lengths_m()[found.from_node];
        let agreeing = self.agreeing(mapper, &found, path_m);
        let needed = if is_expected {
            AGREEING_EXPECTED
        } else {
            AGREEING_CONTRADICTING
        };
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
            return;
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

    /// Indices of the pending loops that agree with this one.
    fn agreeing(&self, mapper: &mut Mapper, found: &LoopVerification, path_m: f64) -> Vec<usize> {
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
        self.searches.due.extend(mapper.newest());
        self.advance(mapper)
    }

    /// Searches the small windows of a keyframe, or a share of a wide one.
    fn advance(&mut self, mapper: &mut Mapper) -> TriedLoops {
        let mut tried = TriedLoops::default();
        while self.searches.windows.is_empty() && !self.searches.due.is_empty() {
            let node = self.searches.due.remove(0);
            self.searches.windows = self.windows(mapper, node);
        }
        while let Some(&window) = self.searches.windows.first() {
            let found = self.search(mapper, window, &mut tried.evaluated);
            if let Some(found) = found {
                self.decide(mapper, &window, found, &mut tried);
            }
            if !is_sure(&window) {
                break;
            }
        }
        tried
    }

    /// Completes the searches, and accepts the newest pending loop if no pending loop contradicts the graph.
    fn conclude(&mut self, mapper: &mut Mapper, is_searched: bool) -> Option<TriedLoops> {
        if !is_searched {
            self.searches.due.extend(mapper.newest());
        }
        let mut tried = TriedLoops::default();
        while !self.searches.is_empty() {
            tried.append(self.advance(mapper));
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
        self.active = None;
        linking::link_all(mapper, &mut self.submaps)
    }

    fn verify(
        &mut self,
        mapper: &mut Mapper,
        old: usize,
        new: usize,
    ) -> Result<LoopVerification, OptimizeError> {
        self.active = None;
        linking::link_on_request(mapper, old, new, &mut self.submaps)
    }

    fn pending(&self) -> &[PendingLoop] {
        &self.pending
    }

    fn searches(&self) -> LoopSearches {
        self.searches.clone()
    }

    fn restore(
        &mut self,
        pending: &[PendingLoop],
        searches: &LoopSearches,
    ) -> Result<(), SnapshotError> {
        self.pending = pending.to_vec();
        self.searches = searches.clone();
        Ok(())
    }

    fn remove_keyframe(&mut self, node: usize, path_m: &[f64]) {
        let moved_up = |known: usize| known - usize::from(known > node);
        self.submaps.forget();
        self.active = None;
        self.searches.remove(node);
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
