//! Shapes of the graph's parts on the map.

use ch16_lab::lap::RecordedLoopAttempt;
use pr_geom::math;

use crate::w16_2_full_lap::model::moment::LapState;
use crate::xy::xy;

/// Lowest and highest arc of a loop, m; in between its height is the distance of its ends.
const ARC_HEIGHT_M: [f64; 2] = [0.7, 1.2];
/// Segments of a loop's arc.
const ARC_STEPS: u32 = 24;

/// A loop's factor as an arc to the north; straight, the factors of the corridor would hide it.
pub fn arc(moment: &LapState, attempt: &RecordedLoopAttempt) -> Vec<[f64; 2]> {
    let loop_ = &attempt.verification;
    let [from, to] = [loop_.from_node, loop_.candidate.node].map(|node| xy(&moment.nodes[node]));
    let apart = math::norm2(to[0] - from[0], to[1] - from[1]);
    let top = apart.clamp(ARC_HEIGHT_M[0], ARC_HEIGHT_M[1]);
    (0..=ARC_STEPS)
        .map(|step| {
            let s = f64::from(step) / f64::from(ARC_STEPS);
            let height = top * 4.0 * s * (1.0 - s);
            [
                from[0] + s * (to[0] - from[0]),
                from[1] + s * (to[1] - from[1]) + height,
            ]
        })
        .collect()
}

/// Position of a loop's mark: at the top of its arc.
pub fn loop_mark(moment: &LapState, attempt: &RecordedLoopAttempt) -> [f64; 2] {
    let arc = arc(moment, attempt);
    arc[arc.len() / 2]
}
