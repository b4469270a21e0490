//! A loop that waits for confirmation.

use serde::{Deserialize, Serialize};

use super::LoopVerification;

/// A loop that passed its own tests and waits until another one along the path confirms it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PendingLoop {
    /// Result of its verification.
    pub verification: LoopVerification,
    /// Path length over the keyframes from the first to its new node, m.
    pub path_m: f64,
    /// Whether it lies within the gate.
    pub is_expected: bool,
}
