//! A custom loop: its settings, its result, and its undo history.

use ch16_lab::lap::{Claim, GateUse, OwnLoop, OwnLoopError, OwnLoopRequest};
use widget_kit::values::Values;

use super::runs::Runs;

use crate::w16_2_full_lap::spec::{KERNEL, OWN, OWN_FROM, OWN_GATE, OWN_TO};

/// Identifies the loop: its claim, and its ends.
type Which = (Option<Claim>, [usize; 2]);

/// All its parameters.
pub const PARAMS: [&str; 5] = ["own", "own-from", "own-to", "own-gate", "kernel"];

/// Largest number of changes that can be undone.
const MAX_UNDO: usize = 100;

/// The custom loop at the current tick, and its history.
#[derive(Default)]
pub struct Own {
    /// Its result; `None` without a loop.
    pub made: Option<Result<OwnLoop, OwnLoopError>>,
    /// The keyframe at which an unfinished loop begins.
    pub tied: Option<usize>,
    before: Vec<Which>,
    /// The keyframe from which a loop is being dragged: one drag is one change.
    dragged: Option<usize>,
}

impl Own {
    /// Computes the loop of the settings in the graph at a tick.
    pub fn refresh(&mut self, values: &Values, runs: &Runs, tick: usize) {
        self.made = request(values, tick).map(|request| runs.own_loop(&request));
    }

    /// The loop, if it could be tried.
    pub fn tried(&self) -> Option<&OwnLoop> {
        self.made.as_ref()?.as_ref().ok()
    }

    /// Records the loop before it changes.
    pub fn keep(&mut self, values: &Values) {
        let now = which(values);
        if self.before.last() == Some(&now) {
            return;
        }
        if self.before.len() == MAX_UNDO {
            self.before.remove(0);
        }
        self.before.push(now);
    }

    /// Undo: restores the loop before the last change, or none if there was none.
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

    /// Whether it already joins these two.
    pub fn is_between(&self, values: &Values, ends: [usize; 2]) -> bool {
        let (claim, between) = which(values);
        claim.is_some() && between == ends
    }

    /// Starts a drag from a keyframe. Returns whether this is the first call of the drag.
    pub fn drag_from(&mut self, node: usize) -> bool {
        self.dragged.replace(node) != Some(node)
    }

    /// Whether the reader dragged it.
    pub fn is_dragged(&self) -> bool {
        self.dragged.is_some()
    }

    /// Ends the drag.
    pub fn let_go(&mut self) {
        self.dragged = None;
    }

    /// Clears the history.
    pub fn forget(&mut self) {
        *self = Self::default();
    }
}

fn which(values: &Values) -> Which {
    let ends = [&OWN_FROM, &OWN_TO].map(|end| values.get(end));
    (values.get(&OWN), ends)
}

/// The loop in the settings at a tick; `None` if they contain none.
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
