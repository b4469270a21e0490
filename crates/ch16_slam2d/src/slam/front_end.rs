//! The front end: registers each scan on a map of the last few.

mod weighing;

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use self::weighing::Driven;
use super::config::{PredictionUse, SlamConfig};
use super::snapshot::FrontEndSnapshot;
use crate::cloud::PointCloud;
use crate::icp::{AdaptiveThreshold, INFORMATION_CAP, INFORMATION_RIDGE, Pair, regularize};
use crate::matching::{
    InformationFrame, MatchRequest, MatchSummary, Matcher, TrustConfig, chapter_information,
    match_information, without_aperture,
};
use crate::metrics::position_error_m;
use crate::scan::{PreparedFrame, is_finite};
use crate::submaps::{ActiveSubmaps, FinishedSubmap, FrontEndKind};

/// Stamps that are closer all but coincide, s: a motion between them tells no velocity.
const SHORTEST_S: f64 = 1e-6;
/// A velocity that leads farther leads nowhere, m: no map is so large.
const FARTHEST_M: f64 = 1e9;

/// A sweep of the local map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSweep {
    /// The frame in which it was taken.
    pub frame: usize,
    /// Where it was taken, by the estimate: `world_from_body`.
    pub pose: SE2,
}

/// What a registration made of one scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registration {
    /// Estimate before it, moved by the odometry or by the last velocity: `world_from_body`.
    pub prediction: SE2,
    /// The result, or the prediction where too few pairs were found.
    pub estimate: SE2,
    /// Correspondence threshold τ that was used, m.
    pub tau_m: f64,
    /// τ for the next registration, m: it has seen this one's correction.
    pub next_tau_m: f64,
    /// Whether the result was believed.
    pub accepted: bool,
    /// Whether the scan joined the window of the next local map.
    pub joined_window: bool,
    /// The registration itself.
    pub matched: MatchSummary,
}

/// Local map, threshold and estimate, with the memory of a registration.
///
/// Its memory is bounded: it holds the scans of its window and nothing older.
#[derive(Clone)]
pub struct FrontEnd {
    estimate: SE2,
    velocity: Vector3<f64>,
    /// How long the last motion took, s.
    last_dt_s: f64,
    window: Vec<WindowSweep>,
    scans: Vec<Arc<PointCloud>>,
    threshold: AdaptiveThreshold,
    local_cloud: PointCloud,
    matcher: Box<dyn Matcher>,
    /// In place of the window, where scans are registered on submaps.
    submaps: Option<ActiveSubmaps>,
    pairs: Vec<Pair>,
    /// Covariance of the predicted motions since the last keyframe, where they are measurements.
    driven: Matrix3<f64>,
    /// Share of what the last registration claims that the wheels leave it.
    believed: f64,
    /// Covariance of the motions since the last registration that was believed, none after one.
    unregistered: Option<Matrix3<f64>>,
}

impl FrontEnd {
    /// A front end that has seen nothing and registers with `matcher`.
    #[must_use]
    pub fn new(config: &SlamConfig, matcher: Box<dyn Matcher>) -> Self {
        Self {
            estimate: config.start,
            velocity: Vector3::zeros(),
            last_dt_s: f64::INFINITY,
            window: Vec::new(),
            scans: Vec::new(),
            threshold: AdaptiveThreshold::new(
                config.threshold.initial_m,
                config.threshold.min_motion_m,
                config.threshold.max_range_m,
            ),
            local_cloud: PointCloud::default(),
            matcher,
            submaps: match config.front_end {
                FrontEndKind::Window => None,
                FrontEndKind::Submaps(submaps) => Some(ActiveSubmaps::new(submaps)),
            },
            pairs: Vec::new(),
            driven: Matrix3::zeros(),
            believed: 1.0,
            unregistered: None,
        }
    }

    /// The estimated pose, `world_from_body`.
    #[must_use]
    pub fn estimate(&self) -> SE2 {
        self.estimate
    }

    /// Twist of the last motion, in m/s, m/s, rad/s.
    #[must_use]
    pub fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }

    /// Correspondence threshold τ for the next registration, m.
    #[must_use]
    pub fn tau_m(&self) -> f64 {
        self.threshold.tau()
    }

    /// The sweeps of the next local map, oldest first.
    #[must_use]
    pub fn window(&self) -> &[WindowSweep] {
        &self.window
    }

    /// The points of the last local map, world frame.
    #[must_use]
    pub fn local_cloud(&self) -> &PointCloud {
        &self.local_cloud
    }

    /// The submaps that scans are added to; none where there is a window.
    #[must_use]
    pub fn submaps(&self) -> Option<&ActiveSubmaps> {
        self.submaps.as_ref()
    }

    /// What it is between two frames.
    pub(crate) fn snapshot(&self) -> FrontEndSnapshot {
        let (deviations_m2, deviations) = self.threshold.seen();
        FrontEndSnapshot {
            estimate: self.estimate,
            velocity: self.velocity,
            last_dt_s: self.last_dt_s,
            window: self.window.clone(),
            scans: self.scans.clone(),
            deviations_m2,
            deviations,
            driven: self.driven,
            unregistered: self.unregistered,
        }
    }

    /// Goes on from a snapshot; the matcher has a new target before it is asked.
    pub(crate) fn restore(&mut self, snapshot: &FrontEndSnapshot) {
        self.estimate = snapshot.estimate;
        self.velocity = snapshot.velocity;
        self.last_dt_s = snapshot.last_dt_s;
        self.window.clone_from(&snapshot.window);
        self.scans.clone_from(&snapshot.scans);
        self.threshold = self
            .threshold
            .having_seen(snapshot.deviations_m2, snapshot.deviations);
        self.driven = snapshot.driven;
        self.unregistered = snapshot.unregistered;
    }

    /// Takes the first scan into the window, or begins the first submap.
    pub(crate) fn start(&mut self, scan: Arc<PointCloud>) {
        if let Some(submaps) = &mut self.submaps {
            submaps.tie(0, &scan, &self.estimate);
            return;
        }
        self.window.push(WindowSweep {
            frame: 0,
            pose: self.estimate,
        });
        self.scans.push(scan);
    }

    /// Registers the scan of a frame that is `dt_s` seconds after the last one, and moves on.
    pub(crate) fn register(
        &mut self,
        frame: &PreparedFrame,
        dt_s: f64,
        number: usize,
        config: &SlamConfig,
    ) -> Registration {
        self.rebuild_local_map();
        let before = self.estimate;
        let going_on = self.going_on(dt_s, config);
        let motion = frame.odometry.unwrap_or(going_on);
        let motion = if is_finite(&(before * motion)) {
            motion
        } else {
            SE2::identity()
        };
        let prediction = before * motion;
        let tau_m = self.threshold.tau();
        // What is weighed afterwards is not weighed while the scan climbs.
        let believed = match config.prediction_use {
            PredictionUse::Start => {
                let noise = config.motion_noise(frame.odometry.is_some());
                noise.covariance(&motion).try_inverse()
            }
            PredictionUse::Measurement => None,
        };
        let request = MatchRequest::new(prediction, tau_m, config.max_iterations);
        let matched = self.match_scan(&frame.cloud, &request, believed);
        let accepted = matched.inliers >= config.min_inliers && is_finite(&matched.pose);
        self.estimate = if accepted { matched.pose } else { prediction };
        self.believed = 1.0;
        if config.prediction_use == PredictionUse::Measurement {
            let noise = config.motion_noise(frame.odometry.is_some());
            self.driven = noise.then(&self.driven, &motion);
        }
        let (mut matched, mut accepted) = (matched, accepted);
        if config.prediction_use == PredictionUse::Measurement {
            let wheels = Driven::new(&before, motion, &going_on, frame);
            if accepted || wheels.going_on.is_some() {
                let found = self.weigh(&matched, &wheels, frame, config);
                accepted |= found.is_some();
                matched = found.unwrap_or(matched);
            }
        }
        self.remember_trust(accepted, &motion, frame.odometry.is_some(), config);
        self.last_dt_s = dt_s;
        self.velocity = before.between(&self.estimate).log() / dt_s.max(SHORTEST_S);
        self.threshold.update(&prediction, &self.estimate);
        Registration {
            prediction,
            estimate: self.estimate,
            tau_m,
            next_tau_m: self.threshold.tau(),
            accepted,
            joined_window: self.join_window(frame, number, config),
            matched,
        }
    }

    /// Information of the estimate about the last keyframe's edge, whose heading is `source_theta`.
    pub(super) fn information(&mut self, source_theta: f64, config: &SlamConfig) -> Matrix3<f64> {
        let trust = &config.odometry_trust;
        let information = match (config.information_frame, self.unregistered) {
            (InformationFrame::Exact, Some(covariance)) => {
                // Every motion noise has a floor, so only an overflow has no inverse.
                return covariance.try_inverse().unwrap_or_else(Matrix3::identity);
            }
            (InformationFrame::Exact, None) => {
                let known = self.matched_information(&self.estimate, trust) * self.believed;
                let driven = std::mem::take(&mut self.driven);
                let wheels = driven.try_inverse().unwrap_or_default();
                without_aperture(&known, config.aperture) + wheels
            }
            (InformationFrame::Chapter, _) => {
                match &self.submaps {
                    Some(submaps) => {
                        self.pairs.clear();
                        self.pairs.extend_from_slice(submaps.pairs());
                    }
                    None => self.matcher.pairs(&mut self.pairs),
                }
                chapter_information(&self.pairs, source_theta, trust)
            }
        };
        regularize(information, INFORMATION_RIDGE, INFORMATION_CAP)
    }

    /// Moves the estimate and the window by `correction`, applied on the left: a loop was closed.
    pub(super) fn correct(&mut self, correction: &SE2) {
        self.estimate = *correction * self.estimate;
        for sweep in &mut self.window {
            sweep.pose = *correction * sweep.pose;
        }
        if let Some(submaps) = &mut self.submaps {
            submaps.correct(correction);
        }
    }

    /// Whether the last registration was believed.
    pub(super) fn is_registered(&self) -> bool {
        self.unregistered.is_none()
    }

    /// Ties keyframe `node` at the estimate to the submaps; the anchors with the node's pose in each
    /// one's frame. Nothing where there is a window.
    pub(super) fn tie(&mut self, node: usize, scan: &PointCloud) -> Vec<(usize, SE2)> {
        let submaps = self.submaps.as_mut();
        submaps.map_or_else(Vec::new, |submaps| submaps.tie(node, scan, &self.estimate))
    }

    /// The submap that was finished since this was asked last.
    pub(super) fn take_finished(&mut self) -> Option<FinishedSubmap> {
        self.submaps.as_mut()?.take_finished()
    }

    /// Information of the motions since the last keyframe, where they are measurements.
    pub(super) fn take_wheels(&mut self) -> Option<Matrix3<f64>> {
        let driven = std::mem::take(&mut self.driven);
        let wheels = driven.try_inverse()?;
        Some(regularize(wheels, INFORMATION_RIDGE, INFORMATION_CAP))
    }

    /// Registers a scan on the window or on the submaps; only these hold it by what is believed.
    fn match_scan(
        &mut self,
        scan: &PointCloud,
        request: &MatchRequest,
        believed: Option<Matrix3<f64>>,
    ) -> MatchSummary {
        match &mut self.submaps {
            Some(submaps) => submaps.register(scan, request, believed),
            None => self.matcher.register(scan, request),
        }
    }

    /// The same next to the guess alone, without other starts.
    fn match_near(&mut self, scan: &PointCloud, request: &MatchRequest) -> MatchSummary {
        match &mut self.submaps {
            Some(submaps) => submaps.register(scan, request, None),
            None => self.matcher.register_near(scan, request),
        }
    }

    fn matched_information(&self, pose: &SE2, trust: &TrustConfig) -> Matrix3<f64> {
        match &self.submaps {
            Some(submaps) => match_information(submaps.pairs(), pose, trust),
            None => self.matcher.information(pose, trust),
        }
    }

    /// The motion with the last velocity, for as long as it is expected to stay.
    fn going_on(&self, dt_s: f64, config: &SlamConfig) -> SE2 {
        let stays_s = dt_s.min(config.extrapolation * self.last_dt_s);
        let motion = SE2::exp(&(self.velocity * stays_s));
        // The velocity of a jump may lead anywhere: then it is none.
        if position_error_m(&SE2::identity(), &motion) <= FARTHEST_M {
            motion
        } else {
            SE2::identity()
        }
    }

    fn rebuild_local_map(&mut self) {
        if self.submaps.is_some() {
            return;
        }
        self.local_cloud.clear();
        for (sweep, scan) in self.window.iter().zip(&self.scans) {
            self.local_cloud.extend_transformed(scan, &sweep.pose);
        }
        self.matcher.set_target(&self.local_cloud);
    }

    fn remember_trust(
        &mut self,
        accepted: bool,
        motion: &SE2,
        is_measured: bool,
        config: &SlamConfig,
    ) {
        if accepted {
            self.unregistered = None;
            return;
        }
        let noise = config.motion_noise(is_measured);
        let before = self.unregistered.unwrap_or_default();
        self.unregistered = Some(noise.then(&before, motion));
    }

    fn join_window(&mut self, frame: &PreparedFrame, number: usize, config: &SlamConfig) -> bool {
        if let Some(submaps) = &mut self.submaps {
            let (distance_m, turn_rad) = (config.window_distance_m, config.window_turn_rad);
            return submaps.insert(&frame.cloud, &self.estimate, distance_m, turn_rad);
        }
        if let Some(newest) = self.window.last()
            && self.window.len() >= config.window_sweeps
        {
            let turn = newest.pose.between(&self.estimate).theta().abs();
            if position_error_m(&newest.pose, &self.estimate) < config.window_distance_m
                && turn < config.window_turn_rad
            {
                return false;
            }
            self.window.remove(0);
            self.scans.remove(0);
        }
        self.window.push(WindowSweep {
            frame: number,
            pose: self.estimate,
        });
        self.scans.push(Arc::clone(&frame.cloud));
        true
    }
}
