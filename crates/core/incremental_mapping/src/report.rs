//! Reports of incremental mapping.

use pr_geom::SE2;
use serde::Serialize;

use super::BeliefSpread;
use crate::field::Climb;

/// Test for a cycle at a keyframe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleTest {
    /// The keyframe.
    pub node: usize,
    /// Spread of the particles.
    pub spread: BeliefSpread,
    /// Share of the scan on observed cells of the old map, at the particles' mean.
    pub known: f64,
    /// Share of these points at a wall of the old map, if the particles agreed.
    pub fit: Option<f64>,
    /// Result of the test.
    pub verdict: CycleVerdict,
}

/// Result of the test for a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CycleVerdict {
    /// The location is new: too little of the old map is in view.
    NewPlace,
    /// The particles do not agree.
    Undecided,
    /// They agree on a pose that the scan does not fit.
    PoorFit,
    /// The location is known, and the pose is correct.
    Confirmed,
    /// The location is known, and the pose was wrong: the path was corrected.
    Closed(CycleClosure),
}

/// A closed cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleClosure {
    /// The first keyframe, which stays.
    pub from_node: usize,
    /// The keyframe whose pose was corrected.
    pub to_node: usize,
    /// Its pose before, `world_from_body`.
    pub before: SE2,
    /// Its pose after, on the old map.
    pub after: SE2,
    /// Largest movement of a keyframe, m.
    pub max_shift_m: f64,
}

/// Report of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IncrementalReport {
    /// Index of the frame.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// Motion prediction: `world_from_body`.
    pub prediction: SE2,
    /// The climb; `None` for the first frame, which starts the map.
    pub climb: Option<Climb>,
    /// Estimate at the end of the frame, including a cycle's correction: `world_from_body`.
    pub estimate: SE2,
    /// Keyframe that was taken.
    pub new_keyframe: Option<usize>,
    /// The test for a cycle at it; `None` without cycle closing.
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
