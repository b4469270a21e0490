//! What a run keeps of its loops and scans, for whoever judges its map.

use ch16_slam2d::loops::LoopVerification;
use ch16_slam2d::slam::LoopAttempt;

/// A loop that was looked at, with the evidence and whether it is in the graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriedLoop {
    /// Candidate, registration and tests.
    pub verification: LoopVerification,
    /// Whether it was closed.
    pub accepted: bool,
}

impl From<&LoopAttempt> for TriedLoop {
    fn from(attempt: &LoopAttempt) -> Self {
        Self {
            verification: attempt.verification,
            accepted: attempt.accepted(),
        }
    }
}

/// A scan that hardly fits the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoorFit {
    /// Its time, s.
    pub stamp_s: f64,
    /// Share of it that fits, 0 to 1.
    pub score: f64,
}
