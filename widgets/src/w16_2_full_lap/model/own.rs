//! A loop of the reader's own: what the settings ask for, what came of it, and the way back.

use ch16_lab::lap::{Claim, GateUse, OwnLoop, OwnLoopError, OwnLoopRequest};
use kit::values::Values;

use super::runs::Runs;

use crate::w16_2_full_lap::spec::{KERNEL, OWN, OWN_FROM, OWN_GATE, OWN_TO};

/// Which loop it is: what it claims, and its ends.
type Which = (Option<Claim>, [usize; 2]);

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
    before: Vec<Which>,
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

    /// Puts back the loop before the last change; without one, no loop at all.
    pub fn undone(&mut self, values: &mut Values) {
        self.tied = None;
        let now = which(values);
        let mut before = self.before.pop();
        while before == Some(now) {
            before = self.before.pop();
        }
        let (claim, [from, to]) = before.unwrap_or((None, now.1));
        values.put(&OWN, claim);
        values.put(&OWN_FROM, from);
        values.put(&OWN_TO, to);
    }

    /// Whether it runs between these two already.
    pub fn is_between(&self, values: &Values, ends: [usize; 2]) -> bool {
        let (claim, between) = which(values);
        claim.is_some() && between == ends
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

fn which(values: &Values) -> Which {
    let ends = [&OWN_FROM, &OWN_TO].map(|end| values.get(end));
    (values.get(&OWN), ends)
}

/// What the settings ask for at a tick; none where they ask for no loop.
pub fn request(values: &Values, tick: usize) -> Option<OwnLoopRequest> {
    let (claim, nodes) = which(values);
    Some(OwnLoopRequest {
        tick,
        nodes,
        claim: claim?,
        gate: if values.get(&OWN_GATE) {
            GateUse::Asked
        } else {
            GateUse::Bypassed
        },
        kernel: values.get(&KERNEL),
    })
}
