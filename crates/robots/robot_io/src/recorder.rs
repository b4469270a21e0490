//! Records scans for a map, and χ² over time, during a run.

use ch16_slam2d::slam::{Slam, SlamReport};

use crate::json_log::FrameLine;
use crate::log::LogFrame;
use crate::run::LogRun;
use crate::session::Session;

/// Keeps the frames of keyframes, and χ² at each of them.
#[derive(Clone, Debug, Default)]
pub struct RunRecorder {
    keyframes: Vec<LogFrame>,
    chi2: Vec<[f64; 2]>,
}

impl RunRecorder {
    /// A recorder for a run that continues a session, which has its own keyframes already.
    #[must_use]
    pub fn resume(session: &Session) -> Self {
        let keyframes = session.snapshot.keyframes.iter();
        let scans = session.posed_scans().map(|(_, scan)| scan);
        let frames = keyframes.zip(scans).map(|(keyframe, scan)| LogFrame {
            stamp_s: keyframe.stamp_s,
            odometry: None,
            scan,
        });
        Self {
            keyframes: frames.collect(),
            chi2: Vec::new(),
        }
    }

    /// Adds the result of a frame.
    pub fn add(&mut self, frame: &LogFrame, report: &SlamReport) {
        if report.new_keyframe.is_some() {
            self.keyframes.push(frame.clone());
            self.chi2.push([report.stamp_s, report.chi2]);
        }
    }

    /// Drops the frames of keyframes that are not on the map: those of a piece that was left out. To be called once
    /// the run is finished.
    pub fn forget_left_out(&mut self, run: &LogRun) {
        let stamps_s = || run.slam().into_iter().flat_map(Slam::keyframes);
        let stamps_s: Vec<f64> = stamps_s().map(|keyframe| keyframe.stamp_s).collect();
        let is_mapped = |stamp_s: f64| {
            stamps_s
                .binary_search_by(|known| known.total_cmp(&stamp_s))
                .is_ok()
        };
        self.keyframes.retain(|frame| is_mapped(frame.stamp_s));
        self.chi2.retain(|[stamp_s, _]| is_mapped(*stamp_s));
    }

    /// The frames of the keyframes, in order.
    #[must_use]
    pub fn keyframes(&self) -> &[LogFrame] {
        &self.keyframes
    }

    /// The keyframes' scans at their current poses in the graph, for building a map.
    #[must_use]
    pub fn map_lines(&self, run: &LogRun) -> Vec<FrameLine> {
        let poses = run.slam().map_or(&[][..], |slam| slam.graph().poses());
        let lines = self.keyframes.iter().zip(poses);
        lines
            .map(|(frame, pose)| FrameLine {
                pose: Some(pose.to_array()),
                ..FrameLine::from(frame)
            })
            .collect()
    }

    /// Time (s) and χ² of the graph after each keyframe.
    #[must_use]
    pub fn chi2_over_time(&self) -> &[[f64; 2]] {
        &self.chi2
    }
}
