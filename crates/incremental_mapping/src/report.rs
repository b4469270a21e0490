//! What the ancestor reports of a frame.

use pr_geom::SE2;

use super::BeliefSpread;
use crate::field::Climb;

/// What the particles say at a keyframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleTest {
    /// The keyframe.
    pub node: usize,
    /// How far the particles agree.
    pub spread: BeliefSpread,
    /// Share of the scan that falls onto seen cells of the old map, from the particles' mean.
    pub known: f64,
    /// Share of that which lies at a wall of the old map, where the particles' place was looked at.
    pub fit: Option<f64>,
    /// What follows.
    pub verdict: CycleVerdict,
}

/// What the particles' test comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleVerdict {
    /// The place is new: too little of the old map is in view.
    NewPlace,
    /// The particles do not agree.
    Undecided,
    /// They agree on a place that the scan does not fit.
    PoorFit,
    /// The place is known, and the pose is right.
    Confirmed,
    /// The place is known, and the pose is off: the path was corrected.
    Closed(CycleClosure),
}

/// A cycle that was closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleClosure {
    /// The first keyframe that stays where it was.
    pub from_node: usize,
    /// The keyframe whose pose was off.
    pub to_node: usize,
    /// Its pose before, `world_from_body`.
    pub before: SE2,
    /// Its pose by the old map.
    pub after: SE2,
    /// Farthest that a keyframe moved, m.
    pub max_shift_m: f64,
}

/// Everything that one frame did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncrementalReport {
    /// Number of the frame, counted from 0.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// Where the motion leads: `world_from_body`.
    pub prediction: SE2,
    /// The climb; `None` for the first frame, which starts the map.
    pub climb: Option<Climb>,
    /// Estimate at the end of the frame, a cycle's correction included: `world_from_body`.
    pub estimate: SE2,
    /// Keyframe that was taken.
    pub new_keyframe: Option<usize>,
    /// What the particles say at it; `None` without the variant for cycles.
    pub cycle: Option<CycleTest>,
}

impl IncrementalReport {
    /// The cycle that was closed, if one was.
    #[must_use]
    pub fn closure(&self) -> Option<&CycleClosure> {
        match &self.cycle.as_ref()?.verdict {
            CycleVerdict::Closed(closure) => Some(closure),
            _ => None,
        }
    }
}
