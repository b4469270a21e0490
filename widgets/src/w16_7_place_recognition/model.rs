//! The state of the comparison and its logic.
//!
//! # Computed
//!
//! Every pair of keyframes of a lap that are far apart in time: the distance of their descriptors
//! (`ch16_slam2d::places`), and whether the truth calls them the same place. Precision and recall count all pairs.
//!
//! # Numbers
//!
//! The radius of a place and the graded descriptors: `crates/chapter/ch16_lab/src/places.rs`.
//!
//! # Simplified
//!
//! "The same place" is a radius about the true position, walls or not. Nothing changes between two visits.

mod interaction;
mod lap;
mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::lap::LapConfig;
use widget_kit::model::{Activity, Handle, Model, Table, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_7_place_recognition::spec::{
    CALLED, LAST_OLD, MOST_ALIKE, NEWEST, OLDER, PARAMS, SPEC, TURN,
};
use lap::{GradingTask, Places};

/// Names of the panels.
pub mod panel {
    /// The two robots with their views.
    pub const FLAT: &str = "flat";
    /// The distances of all pairs, and the threshold.
    pub const SCORES: &str = "scores";
    /// The descriptors of the two views.
    pub const LOOKS: &str = "looks";
    /// All pairs.
    pub const MATRIX: &str = "matrix";
    /// Precision over recall.
    pub const CURVES: &str = "curves";
}

/// Keyframes a second at normal speed.
const KEYFRAMES_PER_S: f64 = 2.5;

/// While it plays, the newer view turns from here to its best fit at each keyframe, degrees.
const TURNS_FROM_DEG: f64 = -90.0;
/// Part of a keyframe's time in which it turns.
const TURNING_PART: f64 = 0.6;

/// The model of the widget.
pub struct PlaceRecognition {
    values: Values,
    playback: PlaybackParam,
    config: LapConfig,
    /// The lap under way; `None` once it is graded.
    work: Option<GradingTask>,
    /// The last graded lap.
    places: Option<Places>,
    /// Number of graded laps so far.
    laps: u64,
    /// Whether the picture holds back which pairs are the same place.
    asks: bool,
}

impl Default for PlaceRecognition {
    /// The chapter's lap, before its drive.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let config = settings::config(&values);
        Self {
            work: Some(GradingTask::new(&config)),
            playback: PlaybackParam::along(&NEWEST),
            config,
            values,
            places: None,
            laps: 0,
            asks: true,
        }
    }
}

impl PlaceRecognition {
    fn detector(&self) -> usize {
        settings::detector(&self.values)
    }

    fn last(&self) -> usize {
        self.places.as_ref().map_or(0, Places::last)
    }

    /// The newest keyframe on screen.
    fn newest(&self) -> usize {
        self.playback.place(&self.values, self.last() as f64) as usize
    }

    /// The selected pair: an older keyframe, and the newest one.
    fn pair(&self) -> Option<[usize; 2]> {
        let places = self.places.as_ref()?;
        let new = self.newest();
        let asked = self.values.get(&OLDER);
        // At each keyframe of a run the robot looks for it among all earlier ones.
        let old = if asked == MOST_ALIKE || self.playback.is_playing() {
            places
                .most_alike(self.detector(), new)
                .or_else(|| new.checked_sub(1))?
        } else {
            (asked as usize).min(new.checked_sub(1)?)
        };
        Some([old, new])
    }

    /// How far the newer view is turned away from its best fit on screen, degrees.
    fn turned_away_deg(&self) -> f64 {
        let part = (self.playback.part() / TURNING_PART).min(1.0);
        let is_turning = self.playback.is_playing() && part < 1.0;
        let still = self.values.get(&TURN);
        if is_turning {
            still + TURNS_FROM_DEG * (1.0 - part)
        } else {
            still
        }
    }

    /// Selects a pair.
    fn select(&mut self, [old, new]: [usize; 2]) {
        self.playback.pause();
        self.values.put(&NEWEST, new as f64);
        self.values
            .put(&OLDER, (old.min(new - 1) as f64).min(LAST_OLD));
    }

    /// The newest keyframe whose pairs are on screen: while it plays, those of later ones are unknown.
    fn known(&self) -> usize {
        if self.playback.is_playing() {
            self.newest()
        } else {
            self.last()
        }
    }

    /// The threshold of a detector.
    fn threshold(&self, detector: usize) -> f64 {
        let called = self.values.get(&CALLED);
        self.places
            .as_ref()
            .map_or(f64::NAN, |places| places.threshold(detector, called))
    }
}

impl Model for PlaceRecognition {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: self.work.is_none().then_some(self.last() as f64),
            values: &mut self.values,
            playback: &mut self.playback,
            steps_per_s: KEYFRAMES_PER_S,
        })
    }

    /// Drives another lap if the settings require it.
    fn follow(&mut self, _changed: Option<&str>) {
        let config = settings::config(&self.values);
        if config != self.config {
            self.work = Some(GradingTask::new(&config));
            self.config = config;
        }
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

    fn timeline(&self) -> Option<Timeline> {
        let last = self.last() as f64;
        Some(self.playback.timeline(
            last,
            vec![TimelineMark {
                at: last,
                label: texts::verdict(self).to_owned(),
                standing: texts::standing(self),
            }],
        ))
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

    fn tap(&mut self, panel: &str, at: [f64; 2], reach: [f64; 2]) {
        interaction::tap(self, panel, at, reach);
    }

    fn reveal(&mut self) {
        self.asks = false;
    }
}
