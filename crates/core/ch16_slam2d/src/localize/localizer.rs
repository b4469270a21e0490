//! The localizer: tracks the pose, or searches for it, one frame at a time.

mod finding;

use std::sync::Arc;

use pr_geom::{SE2, math};

use super::belief::Belief;
use super::fit::ExpectedFit;
use super::pending_fix::PendingFix;
use super::trail::Trail;
use super::{KnownMap, LocalizeConfig, LocalizeReport, MapSearch, StartPose, Verdict};
use crate::chi_squared::GATE_99;
use crate::cloud::PointCloud;
use crate::icp::{INFORMATION_CAP, INFORMATION_RIDGE, regularize};
use crate::local_map::{
    LocalMap, LocalMapConfig, MapRegistration, MapRegistrationConfig, MotionPrior, PriorTail,
};
use crate::scan::{Frame, FrameError, PreparedFrame, ScanPreparer};
use crate::search::{ScoredPose, SearchResult, SearchWindow};
use crate::slam::SlamConfig;

/// A search result confirms the previous one within this distance, m and rad.
const CONFIRMATION_REACH: f64 = 0.4;
/// While the robot is lost, a search starts at least every this many frames.
const SEARCH_EVERY: usize = 20;
/// Largest number of further sweeps to wait for after unsuccessful searches.
const MAX_SEARCH_INTERVAL: usize = 4;
/// Rate of the running average of the score.
const SCORE_RATE: f64 = 0.1;
/// With fewer points that fit, a pose is not called measured, as ICP ends with fewer pairs by default: three points fit in
/// many places.
const MIN_POINTS: usize = 8;
/// Half width of the search around a given start, in standard deviations.
const START_SIGMAS: f64 = 3.0;

/// Tracks a robot on a fixed map, and relocalizes it if it is lost.
#[derive(Clone)]
pub struct Localizer {
    map: Arc<KnownMap>,
    config: LocalizeConfig,
    slam: SlamConfig,
    preparer: ScanPreparer,
    robot: LocalMapConfig,
    registration: MapRegistrationConfig,
    /// The local map, and its keyframes.
    local: LocalMap,
    near: Vec<usize>,
    expected: ExpectedFit,
    trail: Trail,
    frames: usize,
    last_stamp_s: f64,
    start: StartPose,
    belief: Option<Belief>,
    /// Whether a pose was called found before: the robot is in the map's building, so "not on the map" is unlikely. An
    /// accepted pose that stayed doubtful is no evidence for that.
    was_found: bool,
    /// The unconfirmed result of the last search, propagated by the motion since.
    candidate: Option<SE2>,
    searched_ago: usize,
    /// A search that goes on, and the motion since it began.
    running: Option<(MapSearch, SE2)>,
    /// Sweeps that the trail needs before the next search, and the interval between searches, which doubles after
    /// each failure: in an unmapped area every search is slow and fails.
    scans_until_search: usize,
    search_interval: usize,
}

impl Localizer {
    /// A localizer without frames; `slam` holds the scan preparation and the odometry noise of the map's session.
    #[must_use]
    pub fn new(
        map: Arc<KnownMap>,
        slam: SlamConfig,
        config: LocalizeConfig,
        start: StartPose,
    ) -> Self {
        let robot = slam.local_map.unwrap_or_default();
        let registration = robot.registration();
        Self {
            expected: ExpectedFit::learned(&map, &config, &registration),
            map,
            registration,
            robot,
            local: LocalMap::default(),
            near: Vec::new(),
            trail: Trail::new(slam.clone()),
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            start,
            belief: None,
            was_found: false,
            candidate: None,
            searched_ago: 0,
            running: None,
            scans_until_search: 0,
            search_interval: 1,
            slam,
            config,
        }
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &Arc<KnownMap> {
        &self.map
    }

    /// Takes one frame.
    ///
    /// # Errors
    /// If the frame cannot be used; the localizer is unchanged.
    pub fn step(&mut self, frame: &Frame) -> Result<LocalizeReport, FrameError> {
        let velocity = self.trail.velocity();
        let prepared =
            self.preparer
                .prepare_frame(frame, self.last_stamp_s, velocity, &self.slam.scan)?;
        self.step_prepared(&prepared)
    }

    /// [`Localizer::step`] with a prepared scan.
    ///
    /// # Errors
    /// If the frame cannot be used; the localizer is unchanged.
    pub fn step_prepared(&mut self, frame: &PreparedFrame) -> Result<LocalizeReport, FrameError> {
        let mut pending = self.begin(frame)?;
        while self.search_step(&mut pending) {}
        Ok(pending.report)
    }

    /// First part of a frame: tracks the pose, or starts a search for it.
    ///
    /// The parts are for callers that need the intermediate states; [`Localizer::step`] runs all of them in order.
    ///
    /// # Errors
    /// If the frame cannot be used; the localizer is unchanged.
    pub fn begin(&mut self, frame: &PreparedFrame) -> Result<PendingFix, FrameError> {
        let here = self.belief.map_or_else(SE2::identity, |belief| belief.pose);
        let dt_s = frame.seconds_after(self.last_stamp_s, &here)?;
        self.last_stamp_s = frame.stamp_s;
        self.frames += 1;
        let mut frame = frame.clone();
        let moved = self.trail.step(&mut frame, dt_s, &self.config);
        let frame = &frame;
        // In a corridor scans alone stand still; their motion is already in the trail.
        let motion = frame
            .odometry
            .or(moved.motion)
            .unwrap_or_else(SE2::identity);
        self.running = self
            .running
            .take()
            .zip(moved.motion)
            .map(|((search, since), motion)| (search, since * motion));
        self.candidate = match moved.motion {
            Some(motion) => self.candidate.map(|pose| pose * motion),
            None => None,
        };
        let mut pending = PendingFix {
            scan: Arc::clone(&frame.cloud),
            joined: moved.joined,
            start: None,
            search: None,
            since: SE2::identity(),
            sums_before: 0,
            report: LocalizeReport {
                frame: self.frames - 1,
                stamp_s: frame.stamp_s,
                verdict: Verdict::Lost,
                pose: None,
                covariance: None,
                score: None,
                search: None,
            },
        };
        if let StartPose::Near(start) = self.start {
            self.start = StartPose::Anywhere;
            let (sigma_m, sigma_rad) = (self.config.start_sigma_m, self.config.start_sigma_rad);
            let window =
                SearchWindow::around(start, START_SIGMAS * sigma_m, START_SIGMAS * sigma_rad);
            let around = self.trail_cloud(&frame.cloud);
            pending.start = Some(start);
            pending.search = Some(MapSearch::within(around, window, self.config.min_score));
            return Ok(pending);
        }
        if self.belief.is_some() {
            self.follow(&motion, frame, &mut pending.report);
        }
        self.plan_search(&mut pending);
        Ok(pending)
    }

    /// Second part, until it returns false: expands one box of the search, or evaluates its result.
    pub fn search_step(&mut self, pending: &mut PendingFix) -> bool {
        let Some(search) = &mut pending.search else {
            return false;
        };
        let is_whole_map = pending.start.is_none();
        if is_whole_map && search.sums() - pending.sums_before >= self.config.frame_sums {
            self.running = pending.search.take().map(|search| (search, pending.since));
            return false;
        }
        if search.step(&self.map, &self.config) {
            return true;
        }
        let result = search.result();
        pending.search = None;
        match pending.start.take() {
            Some(start) => {
                self.evaluate_near(&start, result, pending);
                self.plan_search(pending);
            }
            None => {
                // The robot may have moved during the search.
                let moved = |scored: ScoredPose| ScoredPose {
                    pose: scored.pose * pending.since,
                    ..scored
                };
                let result = result.map(|result| SearchResult {
                    best: moved(result.best),
                    runner_up: result.runner_up.map(moved),
                    ..result
                });
                self.evaluate_whole_map(result, pending);
            }
        }
        pending.search.is_some()
    }

    /// Registers the scan around the prediction and fuses both.
    fn follow(&mut self, motion: &SE2, frame: &PreparedFrame, report: &mut LocalizeReport) {
        let Some(belief) = self.belief else { return };
        let noise = self.robot.motion_noise(frame.odometry.is_some());
        let prediction = belief.pose * *motion;
        let covariance = noise.then(&belief.covariance, motion);
        let prior = MotionPrior {
            pose: prediction,
            sigma_m: math::sqrt(math::max(covariance.m11, covariance.m22)),
            sigma_rad: math::sqrt(covariance.m33),
            tail: PriorTail::Student,
        };
        self.rebuild_local_map(&prediction);
        let found = self
            .local
            .locate(&frame.cloud, &prior, &[], &self.registration);
        let score = found.fit.score;
        let is_measured = found.fit.inliers >= MIN_POINTS;
        let mut next = Belief {
            pose: prediction,
            covariance,
            misses: if score < self.expected.good_score {
                belief.misses + 1
            } else {
                0
            },
            ..belief
        };
        if next.misses >= self.config.lost_after {
            self.belief = None;
            return;
        }
        if score < belief.usual_score - self.config.score_drop {
            if belief.drops == 0 {
                // Earlier sweeps may have been taken elsewhere.
                self.trail.restart(frame, self.frames - 1);
            }
            next.drops += 1;
        } else if is_measured && !self.is_suspect(&belief) {
            next.drops = 0;
            next.usual_score += SCORE_RATE * (score - belief.usual_score);
        }
        let mut is_sure =
            is_measured && next.misses == 0 && next.drops == 0 && self.is_usual(&next);
        if score >= self.config.poor_score {
            let (position, heading) = prior.squared(&prior.deviation(&found.registered.pose));
            is_sure &= position + heading <= GATE_99;
            next.pose = found.registered.pose;
            // Large if the odometry predicted a different pose.
            let before = covariance.try_inverse().unwrap_or_default()
                * math::min(GATE_99 / (position + heading), 1.0);
            let joint = found.information() + before;
            let joint = regularize(joint, INFORMATION_RIDGE, INFORMATION_CAP);
            next.covariance = joint.try_inverse().unwrap_or(covariance);
        }
        let sigma_m = math::sqrt(math::max(next.covariance[(0, 0)], next.covariance[(1, 1)]));
        is_sure &= sigma_m <= self.config.doubt_m;
        self.belief = Some(next);
        report.verdict = if is_sure {
            Verdict::Tracking
        } else {
            Verdict::Doubtful
        };
        report.pose = Some(next.pose);
        report.covariance = Some(next.covariance);
        report.score = (!frame.cloud.is_empty()).then_some(score);
    }

    /// Whether enough scans have fitted clearly worse than usual, so the robot may be elsewhere.
    fn is_suspect(&self, belief: &Belief) -> bool {
        belief.drops >= self.config.lost_after
    }

    /// Whether the usual score is as high as at a correct pose.
    fn is_usual(&self, belief: &Belief) -> bool {
        belief.usual_score >= self.expected.usual_score
    }

    /// Registers a scan around a pose from a search.
    fn register(&mut self, scan: &PointCloud, guess: SE2) -> MapRegistration {
        self.rebuild_local_map(&guess);
        let stages = [
            self.registration.max_correspondence_m,
            self.registration.inlier_distance_m,
        ];
        self.local
            .register(scan, guess, &stages, None, &self.registration)
    }

    /// Rebuilds the local map from the keyframes around a pose.
    fn rebuild_local_map(&mut self, pose: &SE2) {
        let config = &self.config;
        let near = self.map.near(pose, config.near_m, config.near_keyframes);
        if near != self.near {
            self.map.build_local(&near, &mut self.local);
            self.near = near;
        }
    }
}
