//! What a run keeps of its keyframes for its map and its report: their scans as measured, and χ² over time.

use ch16_slam2d::slam::{Slam, SlamReport};

use super::LogRun;
use crate::json_log::FrameLine;
use crate::log::LogFrame;
use crate::map_image::{MapError, MapImage, NoReturn, build_map, finest_map};
use crate::session::Session;

/// The frames of the keyframes, and χ² at each of them.
#[derive(Default)]
pub(super) struct Record {
    keyframes: Vec<LogFrame>,
    chi2: Vec<[f64; 2]>,
}

impl Record {
    /// That of a run which continues a session: the session has its own keyframes already.
    pub(super) fn resume(session: &Session) -> Self {
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
    pub(super) fn add(&mut self, frame: &LogFrame, report: &SlamReport) {
        if report.new_keyframe.is_some() {
            self.keyframes.push(frame.clone());
            self.chi2.push([report.stamp_s, report.chi2]);
        }
    }

    /// Drops what belongs to keyframes that are not on the map of the finished run: those of a piece that was left out.
    pub(super) fn keep_mapped(&mut self, slam: Option<&Slam>) {
        let keyframes = slam.map_or(&[][..], Slam::keyframes);
        let is_mapped = |stamp_s: f64| {
            keyframes
                .binary_search_by(|keyframe| keyframe.stamp_s.total_cmp(&stamp_s))
                .is_ok()
        };
        self.keyframes.retain(|frame| is_mapped(frame.stamp_s));
        self.chi2.retain(|[stamp_s, _]| is_mapped(*stamp_s));
    }
}

impl LogRun {
    /// The frames of the keyframes, in order; before the end of the run also those of a piece that will be left out.
    #[must_use]
    pub fn keyframe_frames(&self) -> &[LogFrame] {
        &self.record.keyframes
    }

    /// The keyframes' scans at their poses in the graph of the finished run.
    #[must_use]
    pub fn map_lines(&self) -> Vec<FrameLine> {
        let poses = self.slam().map_or(&[][..], |slam| slam.graph().poses());
        let lines = self.record.keyframes.iter().zip(poses);
        lines
            .map(|(frame, pose)| FrameLine {
                pose: Some(pose.to_array()),
                ..FrameLine::from(frame)
            })
            .collect()
    }

    /// The map of the finished run with the finest cells that fit, of this side (m) or larger.
    ///
    /// # Errors
    /// If no scan has a point, or no such cells fit.
    pub fn map(&self, cell_m: f64, no_return: NoReturn) -> Result<MapImage, MapError> {
        let lines = self.map_lines();
        finest_map(cell_m, |cell_m| build_map(&lines, cell_m, no_return))
    }

    /// Time (s) and χ² of the graph after each keyframe.
    #[must_use]
    pub fn chi2_over_time(&self) -> &[[f64; 2]] {
        &self.record.chi2
    }
}
