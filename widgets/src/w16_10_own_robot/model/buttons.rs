//! The effect of each button.

use log_messages::{MapperOrder, Stage};
use widget_kit::spec::PLAY;

use super::OwnRobot;
use super::interaction::{may_edit, nudge};
use super::log_state::LogState;
use crate::w16_10_own_robot::spec::{FILE, KEYFRAME, LOOP, MARKED, MAX_SCANS, OPTION, SCAN};

impl OwnRobot {
    /// Whether a button has anything to do.
    pub(super) fn has_work_for(&self, id: &str) -> bool {
        let robot = &self.robot;
        let (has_map, is_editable) = (!robot.keyframes.is_empty(), may_edit(self));
        match id {
            "cancel" => robot.is_under_way(),
            "doubt" => !self.doubts().is_empty(),
            "previous" | "next" => !robot.links.is_empty(),
            "turn" => is_editable && !robot.links.is_empty(),
            "mark" | "save" => has_map,
            "add" => {
                let marked = self.values.get(&MARKED);
                is_editable && robot.has_scans && marked != self.keyframe()
            }
            "west" | "east" | "north" | "south" | "unpin" => is_editable && has_map,
            "locate" | "locate-sample" => {
                !matches!(robot.progress.stage, Stage::Empty | Stage::Failed)
            }
            "change" => self.place().is_some(),
            "other" => self.other_order().is_some(),
            _ => true,
        }
    }

    /// The effect of a button; `None` if it is not one of this widget's own.
    pub(super) fn press_own(&mut self, id: &str) -> Option<()> {
        let keyframe = self.keyframe();
        match id {
            "open" | "cancel" | "reference" => self.ask(id.to_owned()),
            "unpin" => self.order(MapperOrder::Unpin),
            "sample" => self.begin_sample(),
            "locate" | "locate-sample" => {
                let order = format!("{id}{}", self.start());
                self.ask(order);
                self.values.store(SCAN.id, MAX_SCANS);
            }
            "change" => self.go_to_change(),
            "other" => self.take_other(),
            "doubt" => self.go_to_doubt(),
            "previous" => self.go_to_link(false),
            "next" => self.go_to_link(true),
            "mark" => {
                self.values.put(&MARKED, keyframe);
            }
            "turn" => {
                if let Some(link) = self.link() {
                    self.order(MapperOrder::Turn(link));
                }
            }
            "add" => {
                let marked = self.values.get(&MARKED);
                self.order(MapperOrder::Add(marked, keyframe));
                // Added loops come first.
                self.values.put(&LOOP, 0);
            }
            "west" => nudge(self, [-1.0, 0.0]),
            "east" => nudge(self, [1.0, 0.0]),
            "north" => nudge(self, [0.0, 1.0]),
            "south" => nudge(self, [0.0, -1.0]),
            "save" => {
                let file = self.values.get(&FILE);
                self.ask(format!("save {file}"));
            }
            _ if id == PLAY.id => self.press_play(),
            _ => return None,
        }
        Some(())
    }

    fn press_play(&mut self) {
        match self.robot.progress.stage {
            Stage::Empty | Stage::Failed => self.begin_sample(),
            _ if self.robot.is_under_way() => {
                self.robot.paused = !self.robot.paused;
                let order = if self.robot.paused { "pause" } else { "resume" };
                self.ask(order.to_owned());
            }
            _ => {
                let (here, last) = (self.keyframe() as f64, self.last() as f64);
                let position = self.playback.toggle(here, last);
                self.values.store(KEYFRAME.id, position);
                self.look();
            }
        }
    }

    fn begin_sample(&mut self) {
        self.ask("sample".to_owned());
        self.robot = LogState::opening("the sample");
        self.playback.pause();
    }

    /// The order for the next topic or frame of the recording for the selected option, if it offers another one.
    fn other_order(&self) -> Option<String> {
        let option = self.values.get(&OPTION);
        let mut offers = self.robot.offers.iter();
        let offer = offers.find(|offer| offer.option == option)?;
        let here = offer.names.iter().position(|name| *name == offer.taken);
        let next = here.map_or(0, |here| (here + 1) % offer.names.len());
        let name = offer.names.get(next)?;
        (*name != offer.taken).then(|| format!("option {option} {name}"))
    }

    fn take_other(&mut self) {
        if let Some(order) = self.other_order() {
            self.ask(order);
        }
    }

    /// Selects the loop after or before the current one.
    fn go_to_link(&mut self, forward: bool) {
        let Some(here) = self.link() else {
            return;
        };
        let last = self.robot.links.len() - 1;
        let next = match (forward, here) {
            (true, here) if here == last => 0,
            (true, here) => here + 1,
            (false, 0) => last,
            (false, here) => here - 1,
        };
        self.values.put(&LOOP, next);
        self.show_link();
    }

    fn go_to_doubt(&mut self) {
        let here = self.keyframe();
        let doubts = self.doubts();
        let next = doubts.iter().find(|&&keyframe| keyframe > here);
        if let Some(&next) = next.or(doubts.first()) {
            self.playback.pause();
            self.show(next);
        }
    }
}
