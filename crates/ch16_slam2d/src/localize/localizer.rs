//! One frame at a time: follow the pose, or look for it.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use super::trail::{Trail, TrailStep};
use super::{KnownMap, LocalizeConfig, LocalizeReport, StartPose, Verdict};
use crate::cloud::PointCloud;
use crate::icp::{INFORMATION_CAP, INFORMATION_RIDGE, regularize};
use crate::loops::chi_squared_gate;
use crate::matching::{MatchRequest, MatchSummary, Matcher, without_aperture};
use crate::metrics::position_error_m;
use crate::scan::{Frame, FrameError, PreparedFrame, ScanPreparer};
use crate::search::{SearchResult, SearchWindow};
use crate::slam::{SlamConfig, fuse};

/// Disagreement of scan and prediction that both allow: 99 of 100 lie below.
const BELIEVED_CHI2: f64 = 11.34;
/// A place that a search finds again is so near to the one before, m and rad.
const AGAIN: f64 = 0.4;
/// A search is made at least once in so many frames while the robot is lost.
const SEARCH_EVERY: usize = 20;
/// After searches that found nothing so many sweeps of the trail are awaited at most.
const MOST_AWAITED: usize = 4;
/// Standard deviations of a given start within which it is looked for.
const START_SIGMAS: f64 = 3.0;

/// What is believed of the pose.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Belief {
    pose: SE2,
    covariance: Matrix3<f64>,
    /// Scans in a row that do not fit.
    misses: usize,
}

/// Follows a robot on a map that stays as it is, and finds it where it is lost.
#[derive(Clone)]
pub struct Localizer {
    map: Arc<KnownMap>,
    config: LocalizeConfig,
    slam: SlamConfig,
    preparer: ScanPreparer,
    matcher: Box<dyn Matcher>,
    /// The keyframes that the matcher's target is made of.
    target: Vec<usize>,
    cloud: PointCloud,
    trail: Trail,
    frames: usize,
    last_stamp_s: f64,
    start: StartPose,
    belief: Option<Belief>,
    /// The place that the last search found, moved on since, while it is not believed.
    candidate: Option<SE2>,
    searched_ago: usize,
    /// Sweeps that still have to join the trail before the next search, and how many it was told to
    /// await: where the map knows nothing, every search is as long as it is vain.
    awaited: usize,
    patience: usize,
}

impl Localizer {
    /// A localizer that has seen nothing; `slam` says how scans become clouds and how far wheels are
    /// trusted, as in the session of the map.
    #[must_use]
    pub fn new(
        map: Arc<KnownMap>,
        slam: SlamConfig,
        config: LocalizeConfig,
        start: StartPose,
    ) -> Self {
        Self {
            map,
            matcher: config.matcher.build(&config.map),
            target: Vec::new(),
            cloud: PointCloud::default(),
            trail: Trail::new(slam.clone()),
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            start,
            belief: None,
            candidate: None,
            searched_ago: 0,
            awaited: 0,
            patience: 1,
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
    /// Where the frame cannot be used; the localizer stays as it was.
    pub fn step(&mut self, frame: &Frame) -> Result<LocalizeReport, FrameError> {
        frame.validate()?;
        let dt_s = frame.stamp_s - self.last_stamp_s;
        if dt_s <= 0.0 {
            return Err(FrameError::Stamp {
                stamp_s: frame.stamp_s,
                last_s: self.last_stamp_s,
            });
        }
        let velocity = match frame.odometry {
            Some(odometry) if dt_s.is_finite() => odometry.log() / dt_s,
            Some(_) => Vector3::zeros(),
            None => self.trail.velocity(),
        };
        let scan = self
            .preparer
            .prepare(&frame.scan, &velocity, &self.slam.scan);
        self.step_prepared(&PreparedFrame {
            stamp_s: frame.stamp_s,
            odometry: frame.odometry,
            cloud: Arc::new(scan),
        })
    }

    /// [`Localizer::step`] with a scan that is already a cloud.
    ///
    /// # Errors
    /// Where the frame cannot be used; the localizer stays as it was.
    pub fn step_prepared(&mut self, frame: &PreparedFrame) -> Result<LocalizeReport, FrameError> {
        frame.validate()?;
        let dt_s = frame.stamp_s - self.last_stamp_s;
        if dt_s <= 0.0 {
            return Err(FrameError::Stamp {
                stamp_s: frame.stamp_s,
                last_s: self.last_stamp_s,
            });
        }
        self.last_stamp_s = frame.stamp_s;
        self.frames += 1;
        let moved = self.trail.step(frame, dt_s, &self.config);
        let motion = moved
            .motion
            .or(frame.odometry)
            .unwrap_or_else(SE2::identity);
        self.candidate = match moved.motion {
            Some(motion) => self.candidate.map(|pose| pose * motion),
            None => None,
        };
        let mut report = LocalizeReport {
            frame: self.frames - 1,
            stamp_s: frame.stamp_s,
            verdict: Verdict::Lost,
            pose: None,
            covariance: None,
            score: None,
            search: None,
        };
        if let StartPose::Near(pose) = self.start {
            self.start = StartPose::Anywhere;
            self.look_near(&pose, frame, &mut report);
        } else if self.belief.is_some() {
            self.follow(&motion, frame, &mut report);
        }
        if self.belief.is_none() {
            self.look_everywhere(moved, frame, &mut report);
        }
        Ok(report)
    }

    /// Registers the scan around the prediction and weighs both.
    fn follow(&mut self, motion: &SE2, frame: &PreparedFrame, report: &mut LocalizeReport) {
        let Some(belief) = self.belief else { return };
        let noise = self.slam.motion_noise(frame.odometry.is_some());
        let prediction = belief.pose * *motion;
        let covariance = noise.then(&belief.covariance, motion);
        let found = self.register(&frame.cloud, prediction);
        let score = found.score.unwrap_or(0.0);
        let mut next = Belief {
            pose: prediction,
            covariance,
            misses: if score < self.config.good_score {
                belief.misses + 1
            } else {
                0
            },
        };
        if next.misses >= self.config.lost_after {
            self.belief = None;
            return;
        }
        let mut is_sure = next.misses == 0;
        if score >= self.config.poor_score {
            let known = self.known(&found, score);
            if let Some(fusion) = fuse(&found.pose, &known, &prediction, &covariance) {
                is_sure &= fusion.chi2 <= BELIEVED_CHI2;
                // A scan that fits is believed where the wheels say something else.
                let is_scan = fusion.chi2 > BELIEVED_CHI2 && next.misses == 0;
                next.pose = if is_scan { found.pose } else { fusion.pose };
                let before = covariance.try_inverse().unwrap_or_default();
                let joint = regularize(known + before, INFORMATION_RIDGE, INFORMATION_CAP);
                next.covariance = joint.try_inverse().unwrap_or(covariance);
            }
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
        report.score = Some(score);
    }

    /// Looks around a given start, and holds what it finds against it.
    fn look_near(&mut self, start: &SE2, frame: &PreparedFrame, report: &mut LocalizeReport) {
        let (sigma_m, sigma_rad) = (self.config.start_sigma_m, self.config.start_sigma_rad);
        let window = SearchWindow::around(*start, START_SIGMAS * sigma_m, START_SIGMAS * sigma_rad);
        let around = self.trail.cloud(&frame.cloud, &self.config);
        let Some(result) = self.search(&around, &window, self.config.min_score) else {
            return;
        };
        let square = |sigma: f64| 1.0 / (sigma * sigma);
        let xy = square(sigma_m);
        let believed = Matrix3::from_diagonal(&Vector3::new(xy, xy, square(sigma_rad)));
        let found = self.register(&frame.cloud, result.best.pose);
        let innovation = start.between(&found.pose).log();
        let gate = chi_squared_gate(&innovation, &believed, self.config.gate_chi2);
        if gate.passes() {
            self.take(&found, Some(believed), report);
        }
        report.search = Some(result);
    }

    /// Searches the whole map for the trail.
    fn look_everywhere(
        &mut self,
        moved: TrailStep,
        frame: &PreparedFrame,
        report: &mut LocalizeReport,
    ) {
        self.searched_ago += 1;
        self.awaited = self.awaited.saturating_sub(usize::from(moved.joined));
        let has_moved = moved.joined && self.awaited == 0;
        let is_due = has_moved || self.searched_ago >= SEARCH_EVERY || self.frames == 1;
        if !is_due || frame.cloud.is_empty() {
            return;
        }
        self.searched_ago = 0;
        let trail = self.trail.cloud(&frame.cloud, &self.config);
        let Some(result) = self.search_whole(&trail, &frame.cloud) else {
            self.candidate = None;
            self.patience = (2 * self.patience).min(MOST_AWAITED);
            self.awaited = self.patience;
            return;
        };
        self.patience = 1;
        report.search = Some(result);
        let margin = result.margin().unwrap_or(1.0);
        let best = result.best.pose;
        let is_again = self.candidate.is_some_and(|pose| {
            position_error_m(&pose, &best) < AGAIN && pose.between(&best).theta().abs() < AGAIN
        });
        self.candidate = Some(best);
        let is_believed =
            margin >= self.config.sure_margin || (margin >= self.config.min_margin && is_again);
        let found = self.register(&frame.cloud, best);
        if is_believed && self.take(&found, None, report) {
            return;
        }
        report.verdict = Verdict::Doubtful;
        report.pose = Some(best);
        report.score = found.score;
    }

    /// Believes a registration that fits; whether it did.
    fn take(
        &mut self,
        found: &MatchSummary,
        prior: Option<Matrix3<f64>>,
        report: &mut LocalizeReport,
    ) -> bool {
        let score = found.score.unwrap_or(0.0);
        if score < self.config.good_score {
            return false;
        }
        let known = self.known(found, score) + prior.unwrap_or_default();
        let known = regularize(known, INFORMATION_RIDGE, INFORMATION_CAP);
        let covariance = known.try_inverse().unwrap_or_else(Matrix3::identity);
        self.belief = Some(Belief {
            pose: found.pose,
            covariance,
            misses: 0,
        });
        self.candidate = None;
        report.verdict = Verdict::Found;
        report.pose = Some(found.pose);
        report.covariance = Some(covariance);
        report.score = Some(score);
        true
    }

    /// How much the last registration knows; what fits in part may fit elsewhere as well.
    fn known(&self, found: &MatchSummary, score: f64) -> Matrix3<f64> {
        let trust = &self.slam.loops.trust;
        let known = self.matcher.information(&found.pose, trust);
        let known = without_aperture(&known, self.slam.loops.aperture);
        known * (score * score * score * score)
    }

    fn register(&mut self, scan: &PointCloud, guess: SE2) -> MatchSummary {
        let LocalizeConfig {
            near_m,
            near_keyframes,
            max_iterations,
            ..
        } = self.config;
        let near = self.map.near(&guess, near_m, near_keyframes);
        if near != self.target {
            self.map.points_of(&near, &mut self.cloud);
            self.matcher.set_target(&self.cloud);
            self.target = near;
        }
        self.matcher
            .register(scan, &MatchRequest::new(guess, 0.6, max_iterations))
    }

    fn search(
        &self,
        scan: &PointCloud,
        window: &SearchWindow,
        min_score: f64,
    ) -> Option<SearchResult> {
        let search = self.map.search(scan, window, &self.config.neighborhood);
        let search = search.ok()?.with_min_score(min_score);
        let mut search = search.with_margin(self.config.sure_margin);
        while search.counts().scored() < self.config.most_sums {
            if search.step().is_none() {
                return search.result();
            }
        }
        None
    }

    /// The best place of the whole map; keyframes that look alike say what it has to beat.
    fn search_whole(&self, trail: &PointCloud, scan: &PointCloud) -> Option<SearchResult> {
        let guesses = self.map.alike(scan, self.config.alike);
        let near = guesses.iter().filter_map(|guess| {
            let window = SearchWindow::around(guess.pose, 0.75, 0.2);
            let found = self.search(trail, &window, self.config.min_score)?;
            Some(found.best.score)
        });
        let known = near.fold(self.config.min_score, math::max);
        // 0.01: both searches put their poses at other places of a cell.
        let floor = math::max(known - 0.01, self.config.min_score);
        self.search(trail, &self.map.whole(), floor)
    }
}
