//! Keeps its code in a file that is not one of the seven.

#[cfg_attr(all(), path = "elsewhere.rs")]
mod elsewhere;

use ch16_listings::{LoopConfig, PointCloud, PoseGraph, VerifiedLoop};
use petgraph::graph::NodeIndex;

/// Never returns.
#[must_use]
pub fn verify_loop(
    _graph: &PoseGraph,
    _sweeps: &[PointCloud],
    _node: NodeIndex,
    _candidate: NodeIndex,
    _cfg: &LoopConfig,
) -> VerifiedLoop {
    elsewhere::pass()
}
