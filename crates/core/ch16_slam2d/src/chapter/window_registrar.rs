//! The chapter's registration: a matcher on the last few sweeps, and an adaptive threshold.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::{AdaptiveThreshold, ChapterConfig};
use crate::cloud::PointCloud;
use crate::icp::{INFORMATION_RIDGE, Pair, regularize};
use crate::matching::{
    InformationFrame, MatchRequest, MatchSummary, Matcher, chapter_information, match_information,
};
use crate::scan::PreparedFrame;
use crate::slam::{ExpectedMotion, NamedNumbers, ScanRegistrar, ScanWindow, SnapshotError};

/// Names in a snapshot: sum (m²) and number of the threshold's deviations, and the covariance of the motions since
/// the last accepted registration, which is absent directly after one.
const DEVIATIONS: &str = "deviations";
const UNREGISTERED: &str = "unregistered motion";

/// Registers with a [`Matcher`] on the points of the window, within a threshold that adapts to its corrections.
#[derive(Clone)]
pub(crate) struct WindowRegistrar {
    config: ChapterConfig,
    threshold: AdaptiveThreshold,
    local_cloud: PointCloud,
    matcher: Box<dyn Matcher>,
    /// The pairs of the last registration.
    pairs: Vec<Pair>,
    /// Covariance of the motions since the last accepted registration, `None` directly after one.
    unregistered: Option<Matrix3<f64>>,
}

impl WindowRegistrar {
    pub fn new(config: &ChapterConfig, matcher: Box<dyn Matcher>) -> Self {
        Self {
            threshold: AdaptiveThreshold::new(
                config.threshold.initial_m,
                config.threshold.min_motion_m,
                config.threshold.max_range_m,
            ),
            config: config.clone(),
            local_cloud: PointCloud::default(),
            matcher,
            pairs: Vec::new(),
            unregistered: None,
        }
    }

    fn match_scan(&mut self, scan: &PointCloud, prediction: &SE2) -> MatchSummary {
        let (tau_m, steps) = (self.threshold.tau_m(), self.config.max_iterations);
        let found = self
            .matcher
            .register(scan, &MatchRequest::new(*prediction, tau_m, steps));
        self.pairs = found.pairs;
        found.summary
    }
}

impl ScanRegistrar for WindowRegistrar {
    /// Starts at the prediction; the chapter ignores the motion after that.
    fn register(
        &mut self,
        frame: &PreparedFrame,
        expected: &ExpectedMotion<'_>,
        window: &ScanWindow,
    ) -> MatchSummary {
        self.local_cloud.clear();
        for (pose, scan) in window.posed_scans() {
            self.local_cloud.extend_transformed(scan, pose);
        }
        self.matcher.set_target(&self.local_cloud);
        let prediction = expected.prediction();
        let found = self.match_scan(&frame.cloud, &prediction);
        match &expected.sweep {
            Some(sweep) => sweep.register(
                &expected.velocity,
                found,
                |found| found.pose,
                |scan| self.match_scan(scan, &prediction),
            ),
            None => found,
        }
    }

    /// Adapts the threshold, and accumulates the covariance of motion without an accepted registration.
    fn decided(&mut self, expected: &ExpectedMotion<'_>, estimate: &SE2, accepted: bool) {
        self.unregistered = (!accepted).then(|| {
            let noise = self.config.motion_noise(expected.is_measured);
            let before = self.unregistered.unwrap_or_default();
            noise.then(&before, &expected.motion)
        });
        self.threshold.update(&expected.prediction(), estimate);
    }

    fn edge_information(&mut self, estimate: &SE2, source_theta: f64) -> Matrix3<f64> {
        let trust = &self.config.odometry_trust;
        let information = match (self.config.information_frame, self.unregistered) {
            // Every motion noise has a floor, so only an overflow has no inverse.
            (InformationFrame::Exact, Some(covariance)) => {
                return covariance.try_inverse().unwrap_or_else(Matrix3::identity);
            }
            (InformationFrame::Exact, None) => match_information(&self.pairs, estimate, trust),
            (InformationFrame::Chapter, _) => chapter_information(&self.pairs, source_theta, trust),
        };
        regularize(information, INFORMATION_RIDGE, trust.information_cap)
    }

    fn local_cloud(&self) -> &PointCloud {
        &self.local_cloud
    }

    fn tau_m(&self) -> f64 {
        self.threshold.tau_m()
    }

    fn snapshot(&self) -> NamedNumbers {
        let (sum_m2, count) = self.threshold.seen();
        let numbers = NamedNumbers::default().with(DEVIATIONS, &[sum_m2, count as f64]);
        match &self.unregistered {
            Some(covariance) => numbers.with(UNREGISTERED, covariance.as_slice()),
            None => numbers,
        }
    }

    fn restore(&mut self, snapshot: &NamedNumbers) -> Result<(), SnapshotError> {
        let [sum_m2, count] = snapshot.get(DEVIATIONS)?;
        if sum_m2 < 0.0 || count < 0.0 {
            return Err(SnapshotError::Numbers(DEVIATIONS));
        }
        self.unregistered = if snapshot.has(UNREGISTERED) {
            let covariance = snapshot.get::<9>(UNREGISTERED)?;
            Some(Matrix3::from_column_slice(&covariance))
        } else {
            None
        };
        self.threshold = self.threshold.having_seen(sum_m2, count as usize);
        Ok(())
    }
}
