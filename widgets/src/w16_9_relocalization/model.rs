//! The state of a localization run and its logic.
//!
//! # Computed
//!
//! The map is a lap of an earlier day; each frame of the robot goes to the localizer (`ch16_slam2d::localize`), whose
//! search is shown at some of its steps.
//!
//! # Numbers
//!
//! Spots and pieces of the search: `crates/chapter/ch16_lab/src/relocalization.rs`; the localizer: `LocalizeConfig`.
//!
//! # Simplified
//!
//! The map comes from a lap and has that lap's errors. Between the days at most one wardrobe has moved.

mod interaction;
mod known;
mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::relocalization::{LocalizationRun, Moment};
use pr_geom::SE2;
use widget_kit::model::{Activity, Handle, Model, Table, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_9_relocalization::spec::{HEADING, MOMENT, PARAMS, PLAN_M, SPEC, START_X, START_Y};
use known::{Known, Work};

/// Names of the panels.
pub mod panel {
    /// The saved map, and the localization on it.
    pub const MAP: &str = "map";
    /// Scores of the best pose and of the next one, scan by scan.
    pub const SCORES: &str = "scores";
}

/// Moments a second at normal speed.
const MOMENTS_PER_S: f64 = 6.0;

/// The model of the widget.
pub struct Relocalization {
    values: Values,
    playback: PlaybackParam,
    /// The work under way; `None` once the run is over.
    work: Option<Work>,
    /// The last saved map.
    known: Option<Known>,
    /// The last finished run.
    run: Option<LocalizationRun>,
}

impl Default for Relocalization {
    /// The default start, before the map is driven.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        Self {
            work: Some(Work::map(&values)),
            playback: PlaybackParam::along(&MOMENT),
            known: None,
            run: None,
            values,
        }
    }
}

impl Relocalization {
    fn has_wardrobe(&self) -> bool {
        settings::laps_config(&self.values).wardrobe.is_some()
    }

    /// The moment at which the robot is found, or the last one.
    fn decided(&self, run: &LocalizationRun) -> usize {
        let moments = run.moments();
        let found = run.found();
        found.map_or(moments.len(), |found| {
            moments.partition_point(|moment| moment.tick <= found)
        }) - 1
    }

    fn start(&self) -> SE2 {
        settings::start(&self.values)
    }

    /// The finished run on screen, whose map and start are those of the values.
    fn finished(&self) -> Option<(&Known, &LocalizationRun)> {
        if self.work.is_some() {
            return None;
        }
        self.known.as_ref().zip(self.run.as_ref())
    }

    fn last(&self) -> usize {
        let finished = self.run.as_ref();
        finished.map_or(0, |run| run.moments().len() - 1)
    }

    fn place(&self) -> usize {
        self.playback.place(&self.values, self.last() as f64) as usize
    }

    fn moment(&self) -> Option<&Moment> {
        let (_, run) = self.finished()?;
        run.moments().get(self.place())
    }

    /// Moves the robot, rounded, which keeps links short.
    fn put(&mut self, pose: SE2) {
        let tenth = |value: f64, most: f64| ((value * 10.0).round() / 10.0).clamp(0.0, most);
        let heading_deg = (pose.theta().to_degrees() / 5.0).round() * 5.0;
        self.playback.pause();
        self.values.put(&START_X, tenth(pose.x(), PLAN_M[0]));
        self.values.put(&START_Y, tenth(pose.y(), PLAN_M[1]));
        self.values.put(&HEADING, heading_deg.clamp(-180.0, 180.0));
        self.follow(None);
    }
}

impl Model for Relocalization {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: self.work.is_none().then_some(self.last() as f64),
            values: &mut self.values,
            playback: &mut self.playback,
            steps_per_s: MOMENTS_PER_S,
        })
    }

    /// Drives another map, or switches the robot on elsewhere on the known one.
    fn follow(&mut self, changed: Option<&str>) {
        if changed == Some(MOMENT.id) {
            return;
        }
        let known = self
            .known
            .as_ref()
            .filter(|known| known.is_of(&self.values));
        self.work = Some(match known {
            Some(known) => Work::run(known, &self.values),
            None => Work::map(&self.values),
        });
    }

    fn work(&mut self) -> Activity {
        let Some(work) = self.work.take() else {
            return Activity::Idle;
        };
        match work.step(&self.values) {
            known::Step::Continue(work) => {
                self.work = Some(work);
                return Activity::BusyUnchanged;
            }
            known::Step::Saved(known) => {
                self.work = Some(Work::run(&known, &self.values));
                self.known = Some(*known);
                self.run = None;
            }
            known::Step::Over(run) => self.run = Some(*run),
        }
        Activity::Busy
    }

    fn timeline(&self) -> Option<Timeline> {
        let mut marks = Vec::new();
        if let Some((_, run)) = self.finished()
            && run.found().is_some()
        {
            let ending = texts::ending(run);
            marks.push(TimelineMark {
                at: self.decided(run) as f64,
                label: texts::verdict(ending).to_owned(),
                standing: texts::standing(ending),
            });
        }
        Some(self.playback.timeline(self.last() as f64, marks))
    }

    fn shown_tables(&self) -> Vec<Table> {
        Vec::new()
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
}
