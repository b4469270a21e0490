//! The state of the widget: the worker's reports on a log, and the reader's view of it.
//!
//! # Computed
//!
//! A worker reads the reader's log (`robot_io`) and maps it with the estimator for recorded logs
//! (`ch16_slam2d::pipeline`); corrections by hand change the pose graph and optimize it again.
//!
//! # Numbers
//!
//! As for `slam2d run` with the same file: docs/robots.md.
//!
//! # Simplified
//!
//! Nothing is simplified for the page; it has no ground truth to compare with. The walls in the picture are the ends of
//! the keyframes' beams, thinned for drawing.

mod buttons;
mod interaction;
pub mod log_state;
mod picture;
pub(super) mod settings;
mod tables;
mod texts;
mod wheels;

use core::cell::OnceCell;

use log_messages::{LocalizedScan, MapperOrder, Stage};
use widget_kit::disclosure::Disclosure;
use widget_kit::host_messages::Delivery;
use widget_kit::model::{
    Activity, Assessment, Handle, Model, Motion, Table, TablePlace, Timeline, TimelineMark,
    press_preset,
};
use widget_kit::param::ParamError;
use widget_kit::playback::{Playback, SPEED};
use widget_kit::scene::Layer;
use widget_kit::spec::DEFAULTS;
use widget_kit::values::{Changed, Values};

use crate::from_modules::from_modules;
use crate::w16_10_own_robot::spec::{
    DROP, KEYFRAME, KEYS, LOOP, MARKED, MAX_KEYFRAMES, MAX_SCANS, PARAMS, POOR, SCAN, SPEC,
    STARTS_HERE, WITHOUT_LOG,
};
use log_state::LogState;

/// Names of the panels.
pub mod panel {
    /// The map with path and loops.
    pub const MAP: &str = "map";
    /// Share of each scan that fits.
    pub const FIT: &str = "fit";
    /// σ of each keyframe.
    pub const SURE: &str = "sure";
}

/// Duration of playing a whole path at normal speed, s.
const PLAY_S: f64 = 12.0;
/// Largest number of marks on a timeline; more would be unreadable.
const MAX_MARKS: usize = 150;

/// A request to the page, or an order that it passes on.
enum Request {
    Page(String),
    Worker(MapperOrder),
}

/// The reader's own robot.
pub struct OwnRobot {
    values: Values,
    robot: LogState,
    playback: Playback,
    requests: Vec<Request>,
    /// The picture before a log is opened, once it is drawn.
    invitation: OnceCell<Vec<Layer>>,
}

impl Default for OwnRobot {
    fn default() -> Self {
        Self::new()
    }
}

impl OwnRobot {
    /// The widget without a log.
    #[must_use]
    pub fn new() -> Self {
        Self {
            values: Values::defaults(PARAMS),
            robot: LogState::default(),
            playback: Playback::default(),
            requests: Vec::new(),
            invitation: OnceCell::new(),
        }
    }

    /// The reports of the worker.
    #[must_use]
    pub fn robot(&self) -> &LogState {
        &self.robot
    }

    fn last(&self) -> usize {
        self.robot.keyframes.len().saturating_sub(1)
    }

    /// The current keyframe.
    fn keyframe(&self) -> usize {
        self.values.get(&KEYFRAME).min(self.last())
    }

    /// The selected loop, if any.
    fn link(&self) -> Option<usize> {
        let last = self.robot.links.len().checked_sub(1)?;
        Some(self.values.get(&LOOP).min(last))
    }

    fn ask(&mut self, request: String) {
        self.requests.push(Request::Page(request));
    }

    /// Sends an order to the worker, in place of a waiting one that it replaces.
    fn order(&mut self, order: MapperOrder) {
        let is_old = |old: &Request| matches!(old, Request::Worker(old) if order.replaces(old));
        self.requests.retain(|old| !is_old(old));
        self.requests.push(Request::Worker(order));
    }

    /// Selects a keyframe and requests its scan.
    fn show(&mut self, keyframe: usize) {
        self.values.put(&KEYFRAME, keyframe);
        self.look();
    }

    fn look(&mut self) {
        let keyframe = self.keyframe();
        let is_there = matches!(&self.robot.scan, Some(scan) if scan.keyframe == keyframe);
        if self.robot.has_scans && !is_there && !self.robot.keyframes.is_empty() {
            self.order(MapperOrder::Look(keyframe));
        }
    }

    /// The initial pose of the other log's robot, in the form of an order.
    fn start(&self) -> String {
        let shown = self.robot.keyframes.get(self.keyframe());
        match shown.filter(|_| self.values.get(&STARTS_HERE)) {
            Some(shown) => {
                let [x, y, theta] = shown.pose;
                format!(" {x} {y} {theta}")
            }
            None => String::new(),
        }
    }

    /// The selected scan of the other log and its place.
    fn place(&self) -> Option<(usize, &LocalizedScan)> {
        let places = &self.robot.other_log.as_ref()?.places;
        let last = places.len().checked_sub(1)?;
        let scan = self.values.get(&SCAN);
        let after = places.partition_point(|place| place.scan <= scan);
        let shown = after.saturating_sub(1).min(last);
        Some((shown, &places[shown]))
    }

    /// Moves on to the next scan of the other log whose localization state differs from the one before it.
    fn go_to_change(&mut self) {
        let Some(((here, _), other_log)) = self.place().zip(self.robot.other_log.as_ref()) else {
            return;
        };
        let places = &other_log.places;
        let is_change = |k: &usize| {
            let before = k
                .checked_sub(1)
                .map(|before| places[before].state.is_localized());
            before != Some(places[*k].state.is_localized())
        };
        let next = (here + 1..places.len()).find(is_change).unwrap_or(0);
        let scan = places[next].scan;
        self.values.put(&SCAN, scan);
    }

    /// Selects the newer keyframe of the current loop.
    fn show_link(&mut self) {
        let link = self.link().map(|link| &self.robot.links[link]);
        if let Some(link) = link.filter(|link| link.new < self.robot.keyframes.len()) {
            let new = link.new;
            self.robot.answer = texts::evidence(link);
            self.playback.pause();
            self.show(new);
        }
    }

    /// Keyframes to check: those of contradicted loops and edges, and of scans that fit badly.
    fn doubts(&self) -> Vec<usize> {
        let poor = self.values.get(&POOR);
        let keyframes = self.robot.keyframes.iter().enumerate();
        let badly = keyframes.filter(|(_, keyframe)| keyframe.fit < poor);
        let mut doubts: Vec<usize> = badly.map(|(k, _)| k).collect();
        let last = self.last();
        let look_into = self.robot.look_into.iter().copied();
        doubts.extend(look_into.filter(|keyframe| *keyframe <= last));
        doubts.sort_unstable();
        doubts.dedup();
        doubts
    }

    /// Tells the worker the purpose of the next dropped log.
    fn ask_drop(&mut self) {
        self.ask(format!("drop {}", self.values.get(&DROP)));
    }
}

impl Model for OwnRobot {
    from_modules!();

    fn disclosure(&self) -> Disclosure {
        let opening = match self.robot.progress.stage {
            Stage::Empty => WITHOUT_LOG,
            _ => SPEC.opening,
        };
        Disclosure::visible(opening, &self.values)
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes {
            match id {
                _ if id == KEYFRAME.id => self.look(),
                _ if id == LOOP.id => self.show_link(),
                _ if id == DROP.id => self.ask_drop(),
                _ => {}
            }
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        if self.press_own(id).is_some() {
            return Ok(());
        }
        if id != DEFAULTS.id {
            return press_preset(self, id);
        }
        self.playback.pause();
        let dropped = self.values.get(&DROP);
        self.values.reset();
        self.robot = LogState::default();
        self.requests.clear();
        self.ask("close".to_owned());
        if dropped != self.values.get(&DROP) {
            self.ask_drop();
        }
        Ok(())
    }

    fn is_enabled(&self, button: &str) -> bool {
        self.has_work_for(button)
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let last = self.last() as f64;
        let rate = (last / PLAY_S).max(4.0) * self.values.get(&SPEED);
        let here = self.keyframe() as f64;
        let next = self.playback.advance(here, last, elapsed_s, rate);
        self.values.store(KEYFRAME.id, next);
        self.look();
        Activity::Busy
    }

    fn takes_files(&self) -> bool {
        true
    }

    fn receive(&mut self, delivery: &Delivery<'_>) {
        self.robot.receive(delivery);
        if delivery.kind == "opening" {
            self.playback.pause();
            self.values.store(KEYFRAME.id, MAX_KEYFRAMES);
            self.values.put(&LOOP, 0);
            self.values.put(&MARKED, 0);
            self.values.store(SCAN.id, MAX_SCANS);
        }
        if delivery.kind == "dropped" {
            let order = format!("locate-dropped{}", self.start());
            self.ask(order);
            self.values.store(SCAN.id, MAX_SCANS);
        }
        if delivery.kind == "progress" && self.robot.progress.stage == Stage::Done {
            self.look();
        }
    }

    fn keys(&self) -> &'static [(&'static str, &'static str)] {
        KEYS
    }

    fn take_requests(&mut self) -> Vec<String> {
        let requests = core::mem::take(&mut self.requests).into_iter();
        requests
            .map(|request| match request {
                Request::Page(request) => request,
                Request::Worker(order) => order.request(),
            })
            .collect()
    }

    fn timeline(&self) -> Option<Timeline> {
        if self.disclosure() == Disclosure::First(WITHOUT_LOG) {
            return None;
        }
        let closed = self
            .robot
            .links
            .iter()
            .filter(|link| link.decision.is_in_graph());
        let loops = closed.map(|link| TimelineMark {
            at: link.new as f64,
            label: format!("loop {} to {}", link.new, link.old),
            standing: Assessment::Good,
        });
        let doubts = self.doubts().into_iter().map(|keyframe| TimelineMark {
            at: keyframe as f64,
            label: format!("look into keyframe {keyframe}"),
            standing: Assessment::Doubtful,
        });
        let last = self.last() as f64;
        let is_read = self.robot.is_under_way() && !self.robot.paused;
        Some(Timeline {
            param: KEYFRAME.id,
            last,
            playing: is_read || self.playback.is_playing(),
            marks: doubts
                .chain(loops)
                .filter(|mark| mark.at <= last)
                .take(MAX_MARKS)
                .collect(),
        })
    }

    fn shown_tables(&self) -> Vec<Table> {
        let mut tables = tables::shown(self);
        tables.retain(|table| table.place == TablePlace::Shown);
        tables
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        interaction::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        interaction::drag(self, handle, at);
    }

    fn set_motion(&mut self, motion: Motion) {
        let last = self.last() as f64;
        if let Some(end) = self.playback.set_motion(motion, last) {
            self.values.store(KEYFRAME.id, end);
        }
    }
}
