//! The interface of every widget's `model.rs`: actions in, scene out, no egui, no clock.

use crate::disclosure::Disclosure;
use crate::host_messages::Delivery;
use crate::param::{MORE, ParamError, printable};
use crate::playback::SPEED;
use crate::playback_param::{Moved, PlayedValues};
use crate::scene::Scene;
use crate::spec::{PLAY, Preset, STEP, WidgetSpec};
use crate::ticks::signed;
use crate::values::{Changed, Values};

pub use crate::playback::Motion;
pub use crate::table::{Table, TableCell, TableColumn, TablePlace};
pub use crate::timeline::{Assessment, Timeline, TimelineMark};

/// A widget without its drawing: tested headless, drawn by [`crate`]'s view half.
///
/// Everything that a reader can change is a parameter of the list, including the position on the timeline. So
/// links, sliders, keys and JavaScript all use [`Model::set`] and [`Model::press`].
pub trait Model {
    /// The constant description of the widget.
    fn spec(&self) -> &'static WidgetSpec;

    /// The current value of every parameter.
    fn values(&self) -> &Values;

    /// The visible parts of the widget.
    fn disclosure(&self) -> Disclosure {
        Disclosure::visible(self.spec().opening, self.values())
    }

    /// The values and their playback, if [`Model::follow`] is all that a change of them needs: then `set`, `press`,
    /// `advance` and `set_motion` are given. Another widget implements these.
    fn played(&mut self) -> Option<PlayedValues<'_>> {
        None
    }

    /// Recomputes what depends on a parameter that changed, or on all of them; never called for speed and More.
    fn follow(&mut self, _changed: Option<&str>) {}

    /// Sets one parameter and recomputes what depends on it.
    ///
    /// # Errors
    /// [`ParamError`] if the name is unknown or the value is out of range; the state does not change.
    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        let widget = self.spec().id;
        let changed = self
            .played()
            .map(|played| played.values.set(widget, id, value));
        if changed.transpose()? == Some(Changed::Yes) && ![SPEED.id, MORE.id].contains(&id) {
            self.follow(Some(id));
        }
        Ok(())
    }

    /// Sets one parameter from the text of a link, an attribute or a message.
    ///
    /// # Errors
    /// [`ParamError`] if the name is unknown or the text is invalid; the state does not change.
    fn set_text(&mut self, id: &str, text: &str) -> Result<(), ParamError> {
        let (param, _) = self.values().find_for(self.spec().id, id)?;
        let value = param.parse(text)?;
        self.set(id, value)
    }

    /// Presses a button or a preset.
    ///
    /// # Errors
    /// [`ParamError::UnknownButton`]; the state does not change.
    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let moved = self.played().map(|mut played| played.press(id));
        if follow_moved(self, moved.unwrap_or(Moved::Nothing)) {
            return Ok(());
        }
        press_preset(self, id)
    }

    /// Whether a button has anything to do now; a reader's press of one that has not does nothing.
    fn is_enabled(&self, button: &str) -> bool {
        button != STEP.id || !self.is_at_end()
    }

    /// Whether a run is shown at its end.
    fn is_at_end(&self) -> bool {
        let at_end = |run: Timeline| self.values().number(run.param) >= run.last;
        self.timeline().is_some_and(at_end)
    }

    /// Advances the playback by that many seconds.
    fn advance(&mut self, elapsed_s: f64) -> Activity {
        advance_played(self, elapsed_s)
    }

    /// Does one small piece (well under a millisecond) of progressive work: busy if it did one, unseen if the
    /// picture did not change, idle if no work was left.
    fn work(&mut self) -> Activity {
        Activity::Idle
    }

    /// Does one piece of the [`Model::work`] on which the outcome depends: once idle, numbers and picture match
    /// the values, and purely visual refinement is left.
    fn settle(&mut self) -> Activity {
        self.work()
    }

    /// Settles to the end. Returns whether there was anything to do.
    fn finish_work(&mut self) -> bool {
        let first = self.settle();
        while self.settle().is_busy() {}
        first.is_busy()
    }

    /// The picture.
    fn scene(&self) -> Scene;

    /// The result in words and numbers.
    fn outcome(&self) -> Outcome;

    /// The picture in words, without its result: see [`text_alternative`].
    fn summary(&self) -> String;

    /// The timeline, if the widget has one.
    fn timeline(&self) -> Option<Timeline> {
        None
    }

    /// Whether a button is shown as pressed: Play while the run plays.
    fn is_pressed(&self, button: &str) -> bool {
        button == PLAY.id && self.timeline().is_some_and(|run| run.playing)
    }

    /// The data of every plot, and the tables beside the picture.
    fn tables(&self) -> Vec<Table>;

    /// The tables beside the picture.
    ///
    /// Called at every change of the picture. A widget whose plots hold long series overrides it, so that
    /// they are formatted for the export only.
    fn shown_tables(&self) -> Vec<Table> {
        let mut tables = self.tables();
        tables.retain(|table| table.place == TablePlace::Shown);
        tables
    }

    /// What a press at that point of a panel grabs, within `reach` (units of the axes).
    fn grab(&self, _panel: &str, _at: [f64; 2], _reach: [f64; 2]) -> Option<Handle> {
        None
    }

    /// Moves the grabbed thing so that the grabbed spot is at that point.
    fn drag(&mut self, _handle: Handle, _at: [f64; 2]) {}

    /// Ends the drag.
    fn release(&mut self) {}

    /// Whether letting go of the thing plays the run, if the drag changed a value.
    fn plays_when_let_go(&self, _handle: &Handle) -> bool {
        false
    }

    /// A click or a tap at that point of a panel; `reach` is that of [`Model::grab`].
    fn tap(&mut self, _panel: &str, _at: [f64; 2], _reach: [f64; 2]) {}

    /// The pointer moved over a panel without pressing, or left it.
    fn hover(&mut self, _panel: &str, _at: Option<[f64; 2]>) {}

    /// Whether the widget accepts a file from the reader, for example by drag and drop.
    fn takes_files(&self) -> bool {
        false
    }

    /// Receives a delivery of the host; unknown kinds are ignored.
    fn receive(&mut self, _delivery: &Delivery<'_>) {}

    /// Keys that press a button while one of these buttons has the focus, by the names of browsers:
    /// `("ArrowLeft", "west")`.
    fn keys(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// The widget's requests to its host, each once and in order: `open`, `look 12`.
    fn take_requests(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Shows what the picture holds back while it asks: the reader has acted.
    fn reveal(&mut self) {}

    /// Sets whether animations run or jump to their end.
    fn set_motion(&mut self, motion: Motion) {
        let moved = self.played().map(|mut played| played.set_motion(motion));
        follow_moved(self, moved.unwrap_or(Moved::Nothing));
    }
}

/// Whether there is more work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// No further frame is needed.
    Idle,
    /// Call again.
    Busy,
    /// Call again; the picture did not change.
    BusyUnchanged,
}

impl Activity {
    /// Whether to call again.
    #[must_use]
    pub fn is_busy(self) -> bool {
        self != Self::Idle
    }
}

/// Something grabbed by [`Model::grab`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Handle {
    /// The panel in which it is.
    pub panel: &'static str,
    /// The thing: `source`, `turn`, `cell`.
    pub id: &'static str,
    /// Grabbed spot minus the thing's own position, which avoids a jump.
    pub offset: [f64; 2],
    /// Which one, if there are several of the thing.
    pub index: usize,
    /// Within which distance of another thing a drag ends there, if it draws a line to one.
    pub reach: f64,
}

impl Handle {
    /// The nearest of several things to a press at `at`, each with its name, its index and its position, if one is
    /// within reach.
    #[must_use]
    pub fn nearest(
        panel: &'static str,
        things: impl IntoIterator<Item = (&'static str, usize, [f64; 2])>,
        at: [f64; 2],
        reach: [f64; 2],
    ) -> Option<Self> {
        let share = |handle: &Self| {
            let [x, y] = [0, 1].map(|i| (handle.offset[i] / reach[i]).abs());
            x.max(y)
        };
        let handles = things.into_iter().map(|(id, index, [x, y])| Self {
            panel,
            id,
            offset: [at[0] - x, at[1] - y],
            index,
            reach: 0.0,
        });
        let near = handles.filter(|handle| (0..2).all(|i| handle.offset[i].abs() <= reach[i]));
        near.min_by(|a, b| share(a).total_cmp(&share(b)))
    }

    /// A thing, if a press at `at` is within reach of its position.
    #[must_use]
    pub fn within(
        panel: &'static str,
        id: &'static str,
        spot: [f64; 2],
        at: [f64; 2],
        reach: [f64; 2],
    ) -> Option<Self> {
        Self::nearest(panel, [(id, 0, spot)], at, reach)
    }

    /// Position of the thing with the pointer at `at`; `None` unless it is finite.
    #[must_use]
    pub fn spot(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let spot = [at[0] - self.offset[0], at[1] - self.offset[1]];
        (spot[0].is_finite() && spot[1].is_finite()).then_some(spot)
    }
}

/// The result of the current state.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Good or bad.
    pub standing: Assessment,
    /// One or two words: `quarter turn`.
    pub verdict: String,
    /// One sentence for the live region, with its numbers.
    pub sentence: String,
    /// The numbers, for readouts and for JavaScript.
    pub facts: Vec<Fact>,
}

impl Outcome {
    /// The sentence as it stands alone: with a capital, unless a name such as `hall.log` comes first, and a full stop.
    #[must_use]
    pub fn in_full(&self) -> String {
        let first = self.sentence.split(' ').next().unwrap_or_default();
        let is_word = first.bytes().all(|letter| letter.is_ascii_alphabetic());
        let mut words = self.sentence.trim_end().to_owned();
        if is_word && let Some(letter) = words.get_mut(..1) {
            letter.make_ascii_uppercase();
        }
        if !words.ends_with(['.', '?', '!', '…']) {
            words.push('.');
        }
        words
    }
}

/// One number of an outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// Name in JavaScript: `rmse_m`.
    pub id: &'static str,
    /// Name on screen: `rmse`.
    pub label: &'static str,
    /// The number; not finite if there is none.
    pub value: f64,
    /// Unit on screen.
    pub unit: &'static str,
    /// Digits after the point.
    pub decimals: usize,
}

impl Fact {
    /// The unit of a yes-no answer: 1 is shown as yes, 0 as no.
    pub const YES_OR_NO: &str = "yes or no";

    /// A number with its unit and its significant digits.
    #[must_use]
    pub fn new(
        id: &'static str,
        label: &'static str,
        value: f64,
        unit: &'static str,
        decimals: usize,
    ) -> Self {
        Self {
            id,
            label,
            value,
            unit,
            decimals,
        }
    }

    /// A length, to the millimetre.
    #[must_use]
    pub fn metres(id: &'static str, label: &'static str, value: f64) -> Self {
        Self::new(id, label, value, "m", 3)
    }

    /// A yes-no answer.
    #[must_use]
    pub fn yes_or_no(id: &'static str, label: &'static str, yes: bool) -> Self {
        Self::new(id, label, f64::from(u8::from(yes)), Self::YES_OR_NO, 0)
    }

    /// The value with its unit; a dash if there is none.
    #[must_use]
    pub fn text(&self) -> String {
        if !self.value.is_finite() {
            return "–".to_owned();
        }
        let number = signed(self.value, self.decimals);
        match self.unit {
            Self::YES_OR_NO if self.value == 0.0 => "no".to_owned(),
            Self::YES_OR_NO => "yes".to_owned(),
            "" | "°" | "%" => format!("{number}{}", self.unit),
            unit => format!("{number}\u{202f}{unit}"),
        }
    }

    /// A whole number; not finite if there is none.
    #[must_use]
    pub fn count(id: &'static str, label: &'static str, value: f64) -> Self {
        Self::new(id, label, value, "", 0)
    }
}

/// Recomputes what depends on what a run moved. Returns whether it moved.
fn follow_moved<M: Model + ?Sized>(model: &mut M, moved: Moved) -> bool {
    match moved {
        Moved::Position(param) => model.follow(Some(param)),
        Moved::Everything => model.follow(None),
        Moved::Nothing => return false,
    }
    true
}

/// [`Model::advance`] of the run alone: busy while it plays.
pub fn advance_played<M: Model + ?Sized>(model: &mut M, elapsed_s: f64) -> Activity {
    let Some(mut played) = model.played() else {
        return Activity::Idle;
    };
    let is_playing = played.playback.is_playing();
    let moved = played.advance(elapsed_s);
    follow_moved(model, moved);
    if is_playing {
        Activity::Busy
    } else {
        Activity::Idle
    }
}

/// Sets a model to the state of a preset.
///
/// # Errors
/// [`ParamError`] if the preset names an unknown parameter: a bug that tests catch.
pub fn apply_preset<M: Model + ?Sized>(model: &mut M, preset: &Preset) -> Result<(), ParamError> {
    model.press("defaults")?;
    for (id, value) in preset.set {
        model.set(id, *value)?;
    }
    for button in preset.then {
        model.press(button)?;
    }
    Ok(())
}

/// The panels that a widget shows at present.
#[must_use]
pub fn shown_scene(model: &dyn Model) -> Scene {
    let (mut scene, disclosure) = (model.scene(), model.disclosure());
    scene.panels.retain(|panel| disclosure.has_panel(panel.id));
    scene
}

/// The text alternative of the picture for screen readers: it asks the question or gives the result, like the page.
#[must_use]
pub fn text_alternative(model: &dyn Model, asks: bool) -> String {
    let summary = model.summary();
    if asks {
        let spec = model.spec();
        format!("{summary} {} {}", spec.title, spec.gesture)
    } else {
        format!("{summary} {}", model.outcome().in_full())
    }
}

/// Presses the preset of that name, the fallback of a [`Model::press`].
///
/// # Errors
/// [`ParamError::UnknownButton`] if there is none; the state does not change.
pub fn press_preset<M: Model + ?Sized>(model: &mut M, id: &str) -> Result<(), ParamError> {
    let spec = model.spec();
    match spec.presets.iter().find(|preset| preset.id == id) {
        Some(preset) => apply_preset(model, preset),
        None => Err(unknown_button(spec, id)),
    }
}

/// The error for a button that a widget does not have.
#[must_use]
pub fn unknown_button(spec: &WidgetSpec, id: &str) -> ParamError {
    let buttons = spec.buttons.iter().map(|button| button.id);
    let presets = spec.presets.iter().map(|preset| preset.id);
    let known: Vec<_> = buttons.chain(presets).collect();
    ParamError::UnknownButton {
        widget: spec.id,
        id: printable(id),
        known: known.join(", "),
    }
}
