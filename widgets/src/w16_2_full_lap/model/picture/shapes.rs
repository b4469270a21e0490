//! Shapes of the graph's parts on the map.

use ch16_lab::lap::RecordedLoopAttempt;

use crate::loop_arc::loop_arc;
use crate::w16_2_full_lap::model::moment::LapState;
use crate::xy::xy;

/// A loop's factor as an arc.
pub fn arc(moment: &LapState, attempt: &RecordedLoopAttempt) -> Vec<[f64; 2]> {
    let loop_ = &attempt.verification;
    let [from, to] = [loop_.from_node, loop_.candidate.node].map(|node| xy(&moment.nodes[node]));
    loop_arc(from, to)
}

/// Position of a loop's mark: at the top of its arc.
pub fn loop_mark(moment: &LapState, attempt: &RecordedLoopAttempt) -> [f64; 2] {
    let arc = arc(moment, attempt);
    arc[arc.len() / 2]
}
