//! The state of the search and its logic.
//!
//! # Computed
//!
//! Branch and bound over every heading and offset of the window (`ch16_slam2d::search`) on the two sweeps of w16.1, and ICP
//! from the same start for comparison. Each box shows its upper bound of the score.
//!
//! # Numbers
//!
//! Scene: `crates/chapter/ch16_lab/src/basin/scene.rs`; window and search: `crates/chapter/ch16_lab/src/whole_window.rs`.
//!
//! # Simplified
//!
//! As for w16.1. The search proves which pose of its lattice is best, not that this pose is right.

mod interaction;
mod picture;
mod search_task;
mod settings;
mod tables;
mod texts;

use ch16_lab::basin::{BasinScene, BasinStart};
use ch16_slam2d::icp::IcpWorkspace;
use ch16_slam2d::search::SearchGoal;
use pr_geom::{SE2, math};
use widget_kit::model::{
    Activity, Assessment, Handle, Model, Table, Timeline, TimelineMark, advance_played,
};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_6_whole_window::spec::{
    DX, DY, HEADING, OFFSET_SPAN_M, PARAMS, PROGRESS, SEED, SPEC,
};
use search_task::{Refined, SearchTask};

/// Names of the panels.
pub mod panel {
    /// The two sweeps.
    pub const SWEEPS: &str = "sweeps";
    /// The positions of the window, with the best score of each.
    pub const PLACES: &str = "places";
    /// Bounds of the boxes over the heading.
    pub const BOUNDS: &str = "bounds";
}

/// Duration of playing a search at normal speed, s, regardless of its length.
const PLAYS_FOR_S: f64 = 12.0;

/// Iterations of ICP per second at normal speed.
const REFINES_PER_S: f64 = 4.0;

/// The model of the widget.
pub struct WholeWindow {
    values: Values,
    playback: PlaybackParam,
    scene: BasinScene,
    workspace: IcpWorkspace,
    search_task: SearchTask,
    /// Number of searches so far.
    searches: u64,
    looked_at: Option<LookedAt>,
}

/// A box and its true scores.
struct LookedAt {
    /// Its index.
    seen: usize,
    /// The best score at each of its headings, `[heading in rad, score]`.
    scores: Vec<[f64; 2]>,
}

impl Default for WholeWindow {
    /// The start from which ICP fails, before the search.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let scene = BasinScene::with_seed(values.get(&SEED));
        let mut workspace = IcpWorkspace::new();
        Self {
            search_task: SearchTask::new(&scene, settings::config(&values), &mut workspace),
            playback: PlaybackParam::along(&PROGRESS),
            values,
            scene,
            workspace,
            searches: 1,
            looked_at: None,
        }
    }
}

impl WholeWindow {
    fn start_over(&mut self) {
        let config = settings::config(&self.values);
        self.search_task = SearchTask::new(&self.scene, config, &mut self.workspace);
        self.searches += 1;
        self.looked_at = None;
    }

    /// Looks at a box: the one under the pointer, or else the one taken up; at none while it plays.
    fn look_at(&mut self, seen: Option<usize>) {
        let window = &self.search_task.window;
        // While it plays, a curve that changes with each frame is noise.
        let is_still = !self.playback.is_playing();
        let taken = window.moments()[self.step()].taken;
        let seen = seen.or(taken.filter(|_| is_still));
        if seen != self.looked_at.as_ref().map(|looked_at| looked_at.seen) {
            self.looked_at = seen.map(|seen| LookedAt {
                seen,
                scores: window.best_by_heading(&window.boxes()[seen].poses),
            });
        }
    }

    /// The iteration of ICP alone, which races the search and ends halfway; `None` before the race.
    fn raced(&self) -> Option<usize> {
        let last = self.search_task.alone.path.len() - 1;
        let boxes = self.boxes_taken().max(1);
        let raced = (2 * last * self.step()).div_ceil(boxes).min(last);
        (self.place() > 0).then_some(raced)
    }

    /// The start of ICP, which is the centre of the window.
    fn guess(&self) -> SE2 {
        self.scene.guess(&self.search_task.window.config().start)
    }

    /// Number of boxes that the search expanded in total.
    fn boxes_taken(&self) -> usize {
        self.search_task.window.moments().len() - 1
    }

    /// ICP from the result of the search.
    fn refined(&self) -> Option<&Refined> {
        let found = self.search_task.found.as_ref()?;
        found.home.as_ref().map(|(_, refined)| refined)
    }

    /// Last position on the timeline: the boxes, followed by the iterations of ICP.
    fn last(&self) -> usize {
        let refining = self.refined().map_or(0, |refined| refined.path.len() - 1);
        self.boxes_taken() + refining
    }

    fn place(&self) -> usize {
        self.playback.place(&self.values, self.last() as f64) as usize
    }

    /// Number of expanded boxes at the current position.
    fn step(&self) -> usize {
        self.place().min(self.boxes_taken())
    }

    /// Number of ICP iterations at the current position; `None` during the search.
    fn refining(&self) -> Option<usize> {
        let refining = self.place().checked_sub(self.boxes_taken())?;
        self.refined().map(|_| refining)
    }

    /// The pose on screen: ICP's, the best one so far, or the start.
    fn shown_pose(&self) -> SE2 {
        if let (Some(k), Some(refined)) = (self.refining(), self.refined()) {
            return refined.path[k];
        }
        let moment = &self.search_task.window.moments()[self.step()];
        moment.best.map_or_else(|| self.guess(), |best| best.pose)
    }

    /// Sets the start to a pose, rounded, which keeps links short.
    fn start_at(&mut self, start: BasinStart) {
        let rounded = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
        let offset = |value: f64| rounded(value, 100.0).clamp(-OFFSET_SPAN_M, OFFSET_SPAN_M);
        let turned = SE2::new(0.0, 0.0, start.heading_deg.to_radians()).theta();
        self.playback.pause();
        self.values.put(
            &HEADING,
            rounded(turned.to_degrees(), 1.0).clamp(-180.0, 180.0),
        );
        self.values.put(&DX, offset(start.dx_m));
        self.values.put(&DY, offset(start.dy_m));
        self.values.put(&PROGRESS, 0.0);
        self.start_over();
    }
}

impl Model for WholeWindow {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        let searched = self.boxes_taken();
        let searching = math::max(searched as f64 / PLAYS_FOR_S, REFINES_PER_S);
        let is_found = self.search_task.found.is_some();
        Some(PlayedValues {
            end: is_found.then_some(self.last() as f64),
            steps_per_s: if self.place() < searched {
                searching
            } else {
                REFINES_PER_S
            },
            values: &mut self.values,
            playback: &mut self.playback,
        })
    }

    fn follow(&mut self, changed: Option<&str>) {
        if changed == Some(PROGRESS.id) {
            self.look_at(None);
            return;
        }
        if changed.is_none_or(|id| id == SEED.id) {
            self.scene = BasinScene::with_seed(self.values.get(&SEED));
        }
        self.start_over();
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        let (here, searched) = (self.place(), self.boxes_taken());
        let activity = advance_played(self, elapsed_s);
        // ICP has its own speed, from its first iteration on.
        if here < searched && self.playback.is_playing() && self.place() > searched {
            self.values.put(&PROGRESS, searched as f64);
        }
        activity
    }

    fn work(&mut self) -> Activity {
        match self.settle() {
            Activity::Idle => self.search_task.fill(),
            busy => busy,
        }
    }

    fn settle(&mut self) -> Activity {
        let searched = self.search_task.search(&self.scene, &mut self.workspace);
        if searched == Activity::Busy {
            self.look_at(None);
        }
        searched
    }

    fn timeline(&self) -> Option<Timeline> {
        let moments = self.search_task.window.moments();
        let mut marks = Vec::new();
        let mut mark = |at: usize, label: &str, standing| {
            marks.push(TimelineMark {
                at: at as f64,
                label: label.to_owned(),
                standing,
            });
        };
        if self.search_task.found.is_some() {
            let after = moments.iter().position(|m| m.goal == SearchGoal::RunnerUp);
            if let Some(at) = after {
                mark(at - 1, "the best pose is certain", Assessment::Neutral);
            }
            let alone = &self.search_task.alone;
            if self.boxes_taken() > 0 {
                let stop = format!("ICP alone stops {}", texts::stop(&alone.outcome));
                let standing = texts::standing_of(&alone.outcome);
                mark(self.boxes_taken().div_ceil(2), &stop, standing);
            }
            let standing = texts::standing(self);
            mark(self.last(), texts::verdict(self), standing);
        }
        Some(self.playback.timeline(self.last() as f64, marks))
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(self)
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        interaction::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        interaction::drag(self, handle, at);
    }

    fn plays_when_let_go(&self, _handle: &Handle) -> bool {
        true
    }

    fn tap(&mut self, panel: &str, at: [f64; 2], _reach: [f64; 2]) {
        self.look_at(picture::box_at(self, panel, at));
    }

    fn hover(&mut self, panel: &str, at: Option<[f64; 2]>) {
        let seen = at.and_then(|at| picture::box_at(self, panel, at));
        if seen.is_some() || !self.playback.is_playing() {
            self.look_at(seen);
        }
    }
}
