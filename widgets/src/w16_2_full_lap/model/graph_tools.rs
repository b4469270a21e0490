//! Operations on the graph: select parts, add a custom loop, go from loop to loop.

use super::FullLap;
use super::found::stepped;
use super::pick::{GraphPart, PickDirection};
use crate::w16_2_full_lap::spec::{LOOP_BUTTONS, OWN, OWN_FROM, OWN_TO};

impl FullLap {
    /// Selects a part of the graph, or nothing.
    pub(super) fn look_at(&mut self, part: Option<GraphPart>) {
        GraphPart::put(part, &mut self.values);
    }

    /// Selects the next part, or the previous one.
    pub(super) fn look_on(&mut self, step: PickDirection) {
        let part = stepped(GraphPart::chosen(&self.values), step, &self.moment());
        self.look_at(part);
    }

    /// Adds a custom loop between two keyframes.
    pub(super) fn tie(&mut self, [from, to]: [usize; 2]) {
        // A claim that was selected stays; the default is a registration of the sweeps.
        let claim = self.values.get(&OWN).unwrap_or_default();
        self.values.put(&OWN, Some(claim));
        self.values.put(&OWN_FROM, from);
        self.values.put(&OWN_TO, to);
        self.own.tied = None;
        self.refresh_own();
    }

    pub(super) fn refresh_own(&mut self) {
        let tick = self.tick();
        self.own.refresh(&self.values, &self.runs, tick);
        self.animate();
    }

    /// Starts a loop at the selected keyframe, or ends it there.
    pub(super) fn press_tie(&mut self) {
        let Some(GraphPart::Keyframe(node)) = GraphPart::chosen(&self.values) else {
            self.own.tied = None;
            return;
        };
        match self.own.tied {
            Some(from) if from != node => {
                self.own.keep(&self.values);
                self.tie([from, node]);
                self.look_at(None);
            }
            Some(_) => self.own.tied = None,
            None => {
                // Changes a value, so that listeners of the page are notified.
                self.own.keep(&self.values);
                self.values.put(&OWN_FROM, node);
                self.refresh_own();
                self.own.tied = Some(node);
            }
        }
    }

    pub(super) fn undo(&mut self) {
        self.own.undone(&mut self.values);
        self.refresh_own();
    }

    pub(super) fn press_loop_button(&mut self, offset: isize) {
        self.playback.pause();
        if let Some(attempt) = self.runs.graph.attempt_near(self.tick()) {
            self.go_to(attempt.tick.saturating_add_signed(offset));
        }
    }

    pub(super) fn next_loop(&mut self) {
        self.playback.pause();
        let tick = self.tick();
        let attempts = self.runs.graph.attempts();
        let next = attempts.iter().find(|attempt| attempt.tick > tick);
        if let Some(attempt) = next.or(attempts.first()) {
            self.go_to(attempt.tick);
        }
    }

    /// Handles the buttons that go from loop to loop. Returns whether the button is one of them.
    pub(super) fn press_loop(&mut self, id: &str) -> bool {
        let Some(button) = LOOP_BUTTONS.iter().find(|button| button.id == id) else {
            return false;
        };
        if self.laps.is_running() {
            self.pressed.push(button.id);
            return true;
        }
        match button.id {
            "before" => self.press_loop_button(-1),
            "at" => self.press_loop_button(0),
            "after" => self.press_loop_button(1),
            _ => self.next_loop(),
        }
        true
    }
}
