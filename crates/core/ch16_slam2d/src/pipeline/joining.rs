//! The pieces of a log: when one starts, joins the map, or is left out.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::continuity::RoughPose;
use super::piece::Piece;
use super::report::numbered_after;
use super::{LeftOut, LogFrame, PieceFate, PieceReport, Pipeline};
use crate::scan::{Frame, FrameError};
use crate::slam::{PiecePose, Slam, SlamConfig, SlamReport};

impl Pipeline {
    /// Starts a piece; one that has not joined the map is compared with it, and the shorter one is left out.
    pub(super) fn begin_piece(&mut self, recorded: &LogFrame, gap_s: f64) {
        self.join(true);
        self.leave_out_shorter();
        let Some(slam) = &mut self.slam else { return };
        // The map is searched as it would be saved.
        if self.before_finish.is_none() {
            slam.conclude();
        }
        let start = self.start.take().unwrap_or_default();
        self.piece = Some(Box::new(Piece::new(slam, start)));
        self.pieces.push(PieceReport {
            first_s: recorded.stamp_s,
            gap_s,
            scans_before: self.scans.len(),
            scans: 0,
            fate: PieceFate::Alone,
        });
    }

    /// Continues the map at a rough pose: later loops search as far around it as it is uncertain. Returns `None` without a
    /// map.
    ///
    /// # Errors
    /// If the frame cannot be used.
    pub(super) fn step_roughly(
        &mut self,
        frame: &Frame,
        rough: &RoughPose,
    ) -> Result<Option<SlamReport>, FrameError> {
        let Some(map) = &self.slam else {
            return Ok(None);
        };
        let mut alone = Slam::new(SlamConfig {
            start: rough.pose,
            ..map.config().clone()
        });
        let report = alone.step(frame)?;
        let (m, rad) = rough.sigmas;
        let here = PiecePose {
            map_from_piece: SE2::identity(),
            covariance: Matrix3::from_diagonal(&Vector3::new(m * m, m * m, rad * rad)),
        };
        let first = self.map_keyframes();
        Ok(joined(map, &alone, &here).map(|joined| {
            self.slam = Some(joined);
            numbered_after(first, report)
        }))
    }

    /// Joins the piece to the map if the robot was found on it.
    pub(super) fn join(&mut self, is_end: bool) {
        let (Some(piece), Some(slam)) = (&self.piece, &self.slam) else {
            return;
        };
        let Some(found) = piece.pose(is_end) else {
            return;
        };
        let Some(joined) = joined(slam, &piece.slam, &found) else {
            return;
        };
        self.slam = Some(joined);
        self.piece = None;
        self.is_session = false;
        if let Some(newest) = self.pieces.last_mut() {
            newest.fate = PieceFate::Joined(newest.scans);
        }
    }

    /// Leaves out the map or the piece, whichever has fewer scans; a session's map is left out in any case, because
    /// its file still has it.
    pub(super) fn leave_out_shorter(&mut self) {
        let Some(piece) = self.piece.take() else {
            return;
        };
        let first = self.map_keyframes();
        let Some(newest) = self.pieces.last_mut() else {
            return;
        };
        let before = self.scans.partition_point(|scan| scan.keyframe < first);
        let left_out = if self.is_session || newest.scans >= before {
            newest.fate = PieceFate::Kept;
            self.is_session = false;
            self.slam = Some(piece.slam);
            self.scans.drain(..before);
            for scan in &mut self.scans {
                scan.keyframe -= first;
            }
            LeftOut {
                keyframes: 0..first,
                scans: 0..before,
            }
        } else {
            newest.fate = PieceFate::LeftOut;
            let end = first + piece.slam.keyframes().len();
            let scans = before..self.scans.len();
            self.scans.truncate(before);
            LeftOut {
                keyframes: first..end,
                scans,
            }
        };
        self.left_out.push(left_out);
    }
}

/// The map with a piece that was found on it; `None` if they do not make one graph.
fn joined(map: &Slam, piece: &Slam, found: &PiecePose) -> Option<Slam> {
    let joined = map.snapshot().joined(&piece.snapshot(), found);
    Slam::restore(&joined).ok()
}
