//! The chapter's registration: a matcher on the last few sweeps, and an adaptive threshold.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::{AdaptiveThreshold, ChapterConfig, InformationFrame, chapter_information};
use crate::cloud::PointCloud;
use crate::icp::{INFORMATION_CAP, INFORMATION_RIDGE, Pair, regularize};
use crate::matching::{MatchRequest, MatchSummary, Matcher, match_information};

/// A matcher with its target, and the threshold that adapts to its corrections.
#[derive(Clone)]
pub(crate) struct WindowMatching {
    pub threshold: AdaptiveThreshold,
    pub local_cloud: PointCloud,
    pub matcher: Box<dyn Matcher>,
    /// The pairs of the last registration.
    pairs: Vec<Pair>,
    /// Covariance of the motions since the last accepted registration, `None` directly after one.
    pub unregistered: Option<Matrix3<f64>>,
}

impl WindowMatching {
    pub fn new(config: &ChapterConfig, matcher: Box<dyn Matcher>) -> Self {
        Self {
            threshold: AdaptiveThreshold::new(
                config.threshold.initial_m,
                config.threshold.min_motion_m,
                config.threshold.max_range_m,
            ),
            local_cloud: PointCloud::default(),
            matcher,
            pairs: Vec::new(),
            unregistered: None,
        }
    }

    /// Registers a scan from `prediction`; the chapter ignores the motion after that.
    pub fn register(
        &mut self,
        scan: &PointCloud,
        prediction: &SE2,
        config: &ChapterConfig,
    ) -> MatchSummary {
        let request = MatchRequest::new(*prediction, self.threshold.tau_m(), config.max_iterations);
        let found = self.matcher.register(scan, &request);
        self.pairs = found.pairs;
        found.summary
    }

    /// Accumulates the covariance of motion without an accepted registration.
    pub fn remember(
        &mut self,
        accepted: bool,
        motion: &SE2,
        is_measured: bool,
        config: &ChapterConfig,
    ) {
        if accepted {
            self.unregistered = None;
            return;
        }
        let noise = config.motion_noise(is_measured);
        let before = self.unregistered.unwrap_or_default();
        self.unregistered = Some(noise.then(&before, motion));
    }

    /// Information of `estimate` for the edge from the last keyframe, whose heading is `source_theta`.
    pub fn information(
        &self,
        estimate: &SE2,
        source_theta: f64,
        config: &ChapterConfig,
    ) -> Matrix3<f64> {
        let trust = &config.odometry_trust;
        let information = match (config.information_frame, self.unregistered) {
            // Every motion noise has a floor, so only an overflow has no inverse.
            (InformationFrame::Exact, Some(covariance)) => {
                return covariance.try_inverse().unwrap_or_else(Matrix3::identity);
            }
            (InformationFrame::Exact, None) => match_information(&self.pairs, estimate, trust),
            (InformationFrame::Chapter, _) => chapter_information(&self.pairs, source_theta, trust),
        };
        regularize(information, INFORMATION_RIDGE, INFORMATION_CAP)
    }
}
