//! What a pipeline reports of its pieces.

use core::ops::Range;

use crate::slam::SlamReport;

/// What became of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceFate {
    /// It is still mapped on its own.
    Alone,
    /// The robot was found on the map at this scan of the piece, counted from 1, and all its scans are on the map.
    Joined(usize),
    /// Nothing connects it to the map, and it was left out.
    LeftOut,
    /// Nothing connects it to the map, which was left out.
    Kept,
}

/// Scans that do not continue those before them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceReport {
    /// Stamp of its first scan, s.
    pub first_s: f64,
    /// Time since the scan before, s.
    pub gap_s: f64,
    /// Number of scans before it.
    pub scans_before: usize,
    /// Its number of scans.
    pub scans: usize,
    /// What became of it.
    pub fate: PieceFate,
}

/// A gap between scans in which nothing measured the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgedGap {
    /// Stamp of the first scan after it, s.
    pub stamp_s: f64,
    /// Its duration, s.
    pub gap_s: f64,
}

/// Keyframes and scans that were left out, by their numbers before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The keyframes; later ones have lower numbers since.
    pub keyframes: Range<usize>,
    /// The scans.
    pub scans: Range<usize>,
}

/// The report of a piece, with keyframes and frames numbered after those of the map.
pub(super) fn numbered_after(keyframes: usize, mut report: SlamReport) -> SlamReport {
    report.new_keyframe = report.new_keyframe.map(|node| keyframes + node);
    for attempt in &mut report.loop_attempts {
        attempt.verification.from_node += keyframes;
        attempt.verification.candidate.node += keyframes;
    }
    report
}
