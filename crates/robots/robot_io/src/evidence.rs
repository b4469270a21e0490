//! Evidence that a run keeps of its loops and scans, for the quality report.

use ch16_slam2d::loops::LoopVerification;
use ch16_slam2d::slam::LoopAttempt;

/// A loop candidate that was tested, with the evidence and the decision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriedLoop {
    /// Candidate, registration and tests.
    pub verification: LoopVerification,
    /// Whether it is in the graph.
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

/// A scan that fits the map poorly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoorFit {
    /// Stamp, s.
    pub stamp_s: f64,
    /// Share of its points that fit, 0 to 1.
    pub score: f64,
}
