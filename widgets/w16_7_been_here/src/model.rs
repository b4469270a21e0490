//! The state of the comparison and every rule that changes it.

mod lap;
mod picture;
mod settings;
mod tables;
mod words;

use ch16_lab::lap::LapConfig;
use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::Scene;
use kit::spec::{DEFAULTS, WidgetSpec};

use crate::spec::{LAST_OLD, MOST_ALIKE, PARAMS, SPEC};
use lap::{Places, Work};

/// Names of the panels.
pub mod panel {
    /// All pairs.
    pub const MATRIX: &str = "matrix";
    /// The two scans of a pair.
    pub const SCANS: &str = "scans";
    /// Their descriptors.
    pub const LOOKS: &str = "looks";
    /// Precision over recall.
    pub const CURVES: &str = "curves";
    /// Where the two keyframes are.
    pub const MAP: &str = "map";
}

/// Keyframes a second at normal speed.
const KEYFRAMES_PER_S: f64 = 5.0;

/// Have I been here, without its picture.
pub struct BeenHere {
    values: Values,
    playback: Playback,
    config: LapConfig,
    /// The lap under way; none once it is graded.
    work: Option<Work>,
    /// The last lap that was graded.
    places: Option<Places>,
    /// Laps graded so far.
    laps: u64,
}

impl Default for BeenHere {
    fn default() -> Self {
        Self::new()
    }
}

impl BeenHere {
    /// The chapter's lap, not yet driven.
    #[must_use]
    pub fn new() -> Self {
        let values = Values::defaults(PARAMS);
        let config = settings::config(&values);
        Self {
            work: Some(Work::new(&config)),
            playback: Playback::default(),
            config,
            values,
            places: None,
            laps: 0,
        }
    }

    /// Drives anew where the settings ask for another lap.
    fn follow(&mut self) {
        let config = settings::config(&self.values);
        if config != self.config {
            self.work = Some(Work::new(&config));
            self.config = config;
        }
    }

    fn detector(&self) -> usize {
        settings::detector(&self.values)
    }

    fn last(&self) -> usize {
        self.places.as_ref().map_or(0, Places::last)
    }

    /// The newest keyframe that is shown.
    fn newest(&self) -> usize {
        (self.values.get("new") as usize).min(self.last())
    }

    /// The pair that is looked at: an older keyframe, and the newest one.
    fn pair(&self) -> Option<[usize; 2]> {
        let places = self.places.as_ref()?;
        let new = self.newest();
        let asked = self.values.get("old");
        let old = if asked == MOST_ALIKE {
            places
                .most_alike(self.detector(), new)
                .or_else(|| new.checked_sub(1))?
        } else {
            (asked as usize).min(new.checked_sub(1)?)
        };
        Some([old, new])
    }

    /// The threshold of a detector.
    fn threshold(&self, detector: usize) -> f64 {
        let called = self.values.get("called");
        self.places
            .as_ref()
            .map_or(f64::NAN, |places| places.threshold(detector, called))
    }

    /// Keeps a value that lies in its range by construction.
    fn store(&mut self, id: &str, value: f64) {
        if let Err(error) = self.values.set(SPEC.id, id, value) {
            panic!("a value of our own was refused: {error}");
        }
    }
}

impl Model for BeenHere {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes {
            self.follow();
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let (here, last) = (self.newest() as f64, self.last() as f64);
        if let Some(position) = self.playback.press(id, here, last) {
            self.store("new", position);
            return Ok(());
        }
        if id != DEFAULTS.id {
            return press_preset(self, id);
        }
        self.playback.pause();
        self.values.reset();
        self.follow();
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        if self.work.is_some() {
            // The lap is ahead of its playback: it ends in a few frames.
            return Activity::Busy;
        }
        let rate = KEYFRAMES_PER_S * speed_factor(self.values.get("speed"));
        let (here, last) = (self.newest() as f64, self.last() as f64);
        let next = self.playback.advance(here, last, elapsed_s, rate);
        self.store("new", next);
        Activity::Busy
    }

    fn work(&mut self) -> Activity {
        let Some(work) = self.work.take() else {
            return Activity::Idle;
        };
        match work.step(&self.config) {
            Ok(places) => {
                self.places = Some(places);
                self.laps += 1;
            }
            Err(work) => self.work = Some(work),
        }
        Activity::Busy
    }

    fn settle(&mut self) -> Activity {
        let had_work = self.work.is_some();
        while self.work.is_some() {
            self.work();
        }
        if had_work {
            Activity::Busy
        } else {
            Activity::Idle
        }
    }

    fn scene(&self) -> Scene {
        picture::scene(self)
    }

    fn outcome(&self) -> Outcome {
        words::outcome(self)
    }

    fn summary(&self) -> String {
        words::summary(self)
    }

    fn timeline(&self) -> Option<Timeline> {
        let last = self.last() as f64;
        Some(Timeline {
            param: "new",
            last,
            playing: self.playback.is_playing(),
            marks: vec![TimelineMark {
                at: last,
                label: words::verdict(self).to_owned(),
                standing: words::standing(self),
            }],
        })
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(self)
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(self)
    }

    fn grab(&self, panel: &str, at: [f64; 2], _reach: [f64; 2]) -> Option<Handle> {
        // Every spot of the matrix is a pair.
        let pair = picture::pair_at(self, at)?;
        (panel == panel::MATRIX && pair[1] > 0).then_some(Handle {
            panel: panel::MATRIX,
            id: "pair",
            offset: [0.0, 0.0],
        })
    }

    fn drag(&mut self, _handle: Handle, at: [f64; 2]) {
        let Some([old, new]) = picture::pair_at(self, at) else {
            return;
        };
        if new == 0 {
            return;
        }
        self.playback.pause();
        self.store("new", new as f64);
        self.store("old", (old.min(new - 1) as f64).min(LAST_OLD));
    }

    fn set_motion(&mut self, motion: Motion) {
        let last = self.last() as f64;
        if let Some(end) = self.playback.set_motion(motion, last) {
            self.store("new", end);
        }
    }
}
