//! The chapter's registration: a matcher on the last few sweeps, or on submaps, and an adaptive threshold.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::config::SlamConfig;
use crate::cloud::PointCloud;
use crate::icp::{AdaptiveThreshold, Pair};
use crate::matching::{
    InformationFrame, MatchRequest, MatchSummary, Matcher, TrustConfig, chapter_information,
    match_information,
};
use crate::scan::PreparedFrame;
use crate::submaps::{ActiveSubmaps, FrontEndKind};

/// A matcher with its target, and the threshold that follows its corrections.
#[derive(Clone)]
pub(super) struct WindowMatching {
    pub threshold: AdaptiveThreshold,
    pub local_cloud: PointCloud,
    pub matcher: Box<dyn Matcher>,
    /// In place of the window, where scans are registered on submaps.
    pub submaps: Option<ActiveSubmaps>,
    pairs: Vec<Pair>,
    /// Covariance of the motions since the last registration that was accepted, none after one.
    pub unregistered: Option<Matrix3<f64>>,
}

impl WindowMatching {
    pub fn new(config: &SlamConfig, matcher: Box<dyn Matcher>) -> Self {
        Self {
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
            unregistered: None,
        }
    }

    /// Registers the scan of a frame from `prediction`; the chapter forgets the motion after that.
    pub fn register(
        &mut self,
        frame: &PreparedFrame,
        prediction: &SE2,
        motion: &SE2,
        config: &SlamConfig,
    ) -> MatchSummary {
        let request = MatchRequest::new(*prediction, self.threshold.tau(), config.max_iterations);
        match &mut self.submaps {
            Some(submaps) => {
                let noise = config.motion_noise(frame.odometry.is_some());
                let believed = noise.covariance(motion).try_inverse();
                submaps.register(&frame.cloud, &request, believed)
            }
            None => self.matcher.register(&frame.cloud, &request),
        }
    }

    /// Keeps the covariance of what was driven without a registration.
    pub fn remember(
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

    /// Information of `estimate` about the last keyframe's edge, whose heading is `source_theta`.
    pub fn information(
        &mut self,
        estimate: &SE2,
        source_theta: f64,
        config: &SlamConfig,
    ) -> Matrix3<f64> {
        let trust = &config.odometry_trust;
        match config.information_frame {
            InformationFrame::Exact => self.matched_information(estimate, trust),
            InformationFrame::Chapter => {
                match &self.submaps {
                    Some(submaps) => {
                        self.pairs.clear();
                        self.pairs.extend_from_slice(submaps.pairs());
                    }
                    None => self.matcher.pairs(&mut self.pairs),
                }
                chapter_information(&self.pairs, source_theta, trust)
            }
        }
    }

    fn matched_information(&self, pose: &SE2, trust: &TrustConfig) -> Matrix3<f64> {
        match &self.submaps {
            Some(submaps) => match_information(submaps.pairs(), pose, trust),
            None => self.matcher.information(pose, trust),
        }
    }
}
