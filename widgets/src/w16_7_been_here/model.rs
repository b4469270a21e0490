//! The state of the comparison and its logic.

mod lap;
mod picture;
mod settings;
mod tables;
mod words;

use ch16_lab::lap::LapConfig;
use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, finish_work,
    press_preset,
};
use kit::param::ParamError;
use kit::played::{Played, Pressed};
use kit::scene::Scene;
use kit::spec::WidgetSpec;
use kit::values::{Changed, Values};

use crate::w16_7_been_here::spec::{
    CALLED, LAST_OLD, MOST_ALIKE, MOST_KEYFRAMES, NEWEST, OLDER, PARAMS, SPEC,
};
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
    /// The positions of the two keyframes.
    pub const MAP: &str = "map";
}

/// Keyframes a second at normal speed.
const KEYFRAMES_PER_S: f64 = 5.0;

/// The model of the widget.
pub struct BeenHere {
    values: Values,
    played: Played,
    config: LapConfig,
    /// The lap under way; `None` once it is graded.
    work: Option<Work>,
    /// The last graded lap.
    places: Option<Places>,
    /// Number of graded laps so far.
    laps: u64,
}

impl Default for BeenHere {
    /// The chapter's lap, before its drive.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let config = settings::config(&values);
        Self {
            work: Some(Work::new(&config)),
            played: Played::along(&NEWEST),
            config,
            values,
            places: None,
            laps: 0,
        }
    }
}

impl BeenHere {
    /// Drives another lap if the settings require it.
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

    /// The end of a run: beyond every position while the lap is being computed.
    fn end(&self) -> f64 {
        match self.work {
            Some(_) => MOST_KEYFRAMES,
            None => self.last() as f64,
        }
    }

    /// The newest keyframe on screen.
    fn newest(&self) -> usize {
        self.played.place(&self.values, self.last() as f64) as usize
    }

    /// The selected pair: an older keyframe, and the newest one.
    fn pair(&self) -> Option<[usize; 2]> {
        let places = self.places.as_ref()?;
        let new = self.newest();
        let asked = self.values.get(&OLDER);
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
        let called = self.values.get(&CALLED);
        self.places
            .as_ref()
            .map_or(f64::NAN, |places| places.threshold(detector, called))
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
        let end = self.end();
        match self.played.press(&mut self.values, id, end) {
            Pressed::Transport => {}
            Pressed::Defaults => self.follow(),
            Pressed::Other => return press_preset(self, id),
        }
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if self.played.is_playing() && self.work.is_some() {
            // The lap is ahead of its playback and ends within a few frames.
            return Activity::Busy;
        }
        let last = self.last() as f64;
        self.played
            .advance(&mut self.values, last, elapsed_s, KEYFRAMES_PER_S)
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

    fn finish_work(&mut self) -> Activity {
        finish_work(self)
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
        Some(self.played.timeline(
            last,
            vec![TimelineMark {
                at: last,
                label: words::verdict(self).to_owned(),
                standing: words::standing(self),
            }],
        ))
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
        self.played.pause();
        self.values.put(&NEWEST, new as f64);
        self.values
            .put(&OLDER, (old.min(new - 1) as f64).min(LAST_OLD));
    }

    fn set_motion(&mut self, motion: Motion) {
        let end = self.end();
        self.played.set_motion(&mut self.values, motion, end);
    }
}
