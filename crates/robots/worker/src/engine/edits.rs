//! The user's changes of the graph, which the worker after a crash makes again.

use log_messages::MapperOrder;

use super::{Engine, Work};
use crate::update::Update;

impl Engine<'_> {
    /// Makes these changes of an earlier worker once the map is complete.
    pub fn repeat(&mut self, edits: Vec<MapperOrder>) {
        self.to_repeat = edits.into();
    }

    /// Whether the map is complete, with all changes of an earlier worker.
    #[must_use]
    pub fn is_mapped(&self) -> bool {
        matches!(self.work, Work::Idle) && self.to_repeat.is_empty()
    }

    /// Makes the next of these changes; returns false if there is none.
    pub(super) fn repeat_next(&mut self) -> bool {
        let next = self.to_repeat.pop_front();
        next.map(|edit| self.order(edit)).is_some()
    }

    /// Records a change; of a dragged keyframe only the last pose.
    pub(super) fn keep_edit(&mut self, order: MapperOrder) {
        let is_same = |last: &MapperOrder| match (last, order) {
            (MapperOrder::Pin(last, _), MapperOrder::Pin(keyframe, _)) => *last == keyframe,
            _ => false,
        };
        self.edits.pop_if(|last| is_same(last));
        self.edits.push(order);
        self.waiting.push(Update::Edits(self.edits.clone()));
    }
}
