//! A loop of the reader's own: what the settings ask for, what came of it, and the way back.

use ch16_lab::lap::{Choice, Claim, GateUse, OwnKernel, OwnLoop, OwnLoopError, OwnLoopRequest};
use kit::values::Values;

use super::runs::Runs;

/// The parameters that say which loop it is.
const WHICH: [&str; 3] = ["own", "own-from", "own-to"];

/// All parameters of it.
pub const PARAMS: [&str; 5] = ["own", "own-from", "own-to", "own-gate", "kernel"];

/// So many changes can be taken back.
const MOST_UNDO: usize = 100;

/// The loop of the reader's own at the moment shown, and what it was before.
#[derive(Default)]
pub struct Own {
    /// What came of it; none where there is none.
    pub made: Option<Result<OwnLoop, OwnLoopError>>,
    /// A keyframe at which a loop begins.
    pub tied: Option<usize>,
    before: Vec<[f64; WHICH.len()]>,
    /// The keyframe from which a loop is being dragged: one drag is one change.
    dragged: Option<usize>,
}

impl Own {
    /// Works out the loop of the settings in the graph at a tick.
    pub fn refresh(&mut self, values: &Values, runs: &Runs, tick: usize) {
        self.made = request(values, tick).map(|request| runs.own_loop(&request));
    }

    /// The loop, where it could be tried.
    pub fn tried(&self) -> Option<&OwnLoop> {
        self.made.as_ref()?.as_ref().ok()
    }

    /// Remembers the loop as it is, before it changes.
    pub fn keep(&mut self, values: &Values) {
        let now = which(values);
        if self.before.last() == Some(&now) {
            return;
        }
        if self.before.len() == MOST_UNDO {
            self.before.remove(0);
        }
        self.before.push(now);
    }

    /// The values of the loop before the last change; without one, no loop at all.
    pub fn undone(&mut self, values: &Values) -> Vec<(&'static str, f64)> {
        self.tied = None;
        let now = which(values);
        let mut before = self.before.pop();
        while before == Some(now) {
            before = self.before.pop();
        }
        let [_, from, to] = now;
        let before = before.unwrap_or([0.0, from, to]);
        WHICH.into_iter().zip(before).collect()
    }

    /// Whether it runs between these two already.
    pub fn is_between(&self, values: &Values, ends: [usize; 2]) -> bool {
        let [own, from, to] = which(values);
        own != 0.0 && [from, to] == ends.map(|end| end as f64)
    }

    /// A loop is dragged out of a keyframe; says whether it is the first of this drag.
    pub fn drag_from(&mut self, node: usize) -> bool {
        self.dragged.replace(node) != Some(node)
    }

    /// The drag is over.
    pub fn let_go(&mut self) {
        self.dragged = None;
    }

    /// Nothing is remembered any more.
    pub fn forget(&mut self) {
        *self = Self::default();
    }
}

fn which(values: &Values) -> [f64; WHICH.len()] {
    WHICH.map(|id| values.get(id))
}

/// What the settings ask for at a tick; none where they ask for no loop.
pub fn request(values: &Values, tick: usize) -> Option<OwnLoopRequest> {
    let claim = (values.get("own") as usize).checked_sub(1)?;
    Some(OwnLoopRequest {
        tick,
        nodes: ["own-from", "own-to"].map(|id| values.get(id) as usize),
        claim: Claim::ALL[claim],
        gate: if values.get("own-gate") == 0.0 {
            GateUse::Bypassed
        } else {
            GateUse::Asked
        },
        kernel: OwnKernel::ALL[values.get("kernel") as usize],
    })
}
