//! What a run leaves besides its trajectory and its quality: scans for a map, and χ² over time.

use ch16_slam2d::slam::SlamReport;

use crate::json_log::FrameLine;
use crate::log::LogFrame;
use crate::run::LogRun;

/// Keeps the frames of keyframes, and χ² at each, while a run goes on.
#[derive(Clone, Debug, Default)]
pub struct RunRecorder {
    keyframes: Vec<LogFrame>,
    chi2: Vec<[f64; 2]>,
}

impl RunRecorder {
    /// Takes what a frame did.
    pub fn take(&mut self, frame: &LogFrame, report: &SlamReport) {
        if report.new_keyframe.is_some() {
            self.keyframes.push(frame.clone());
            self.chi2.push([report.stamp_s, report.chi2]);
        }
    }

    /// The frames of the keyframes, in order.
    #[must_use]
    pub fn keyframes(&self) -> &[LogFrame] {
        &self.keyframes
    }

    /// The keyframes' scans with the poses that the graph gives them now: what a map is made of.
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

    /// Time (s) and χ² of the graph, after each keyframe.
    #[must_use]
    pub fn chi2_over_time(&self) -> &[[f64; 2]] {
        &self.chi2
    }
}
