//! What every widget's `model.rs` implements: state in, scene out, no egui, no clock.

use crate::layers::Layer;
use crate::outside::Delivery;
use crate::param::{ParamError, printable};
use crate::scene::Scene;
use crate::spec::{Preset, WidgetSpec};
use crate::values::Values;

/// A widget without its picture: tested headless, drawn by [`crate`]'s view half.
///
/// All that a reader can change is a parameter of the list, the place on the timeline included:
/// so a link, a slider, a key and JavaScript all go through [`Model::set`] and [`Model::press`].
pub trait Model {
    /// What never changes.
    fn spec(&self) -> &'static WidgetSpec;

    /// The current value of every parameter.
    fn values(&self) -> &Values;

    /// What is shown of the widget.
    fn layer(&self) -> Layer {
        Layer::of(self.spec().opening, self.values())
    }

    /// Sets one parameter and recomputes what depends on it.
    ///
    /// # Errors
    /// [`ParamError`] for an unknown name or a value out of range; nothing changes then.
    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError>;

    /// Sets one parameter to what a link, an attribute or a message says.
    ///
    /// # Errors
    /// [`ParamError`] for an unknown name or a text that is no value; nothing changes then.
    fn set_text(&mut self, id: &str, text: &str) -> Result<(), ParamError> {
        let (param, _) = self.values().find_for(self.spec().id, id)?;
        let value = param.parse(text)?;
        self.set(id, value)
    }

    /// Presses a button or a preset.
    ///
    /// # Errors
    /// [`ParamError::UnknownButton`]; nothing changes then.
    fn press(&mut self, id: &str) -> Result<(), ParamError>;

    /// Plays on by that many seconds.
    fn advance(&mut self, elapsed_s: f64) -> Activity;

    /// Does one small piece (well under a millisecond) of work that fills in progressively: busy
    /// where it did one, unseen where nothing that is shown changed by it, idle where nothing was left to do.
    fn work(&mut self) -> Activity {
        Activity::Idle
    }

    /// Finishes what [`Model::work`] has begun and the picture waits for, so that figures and picture
    /// are those of the values; what only fills in goes on later. Idle where nothing was to be done.
    fn settle(&mut self) -> Activity {
        Activity::Idle
    }

    /// The picture.
    fn scene(&self) -> Scene;

    /// The result in words and numbers.
    fn outcome(&self) -> Outcome;

    /// A text that stands for the picture, for those who cannot see it.
    fn summary(&self) -> String;

    /// The timeline, where the widget has one.
    fn timeline(&self) -> Option<Timeline> {
        None
    }

    /// The data of every plot, and tables shown beside the picture.
    fn tables(&self) -> Vec<Table>;

    /// The tables that stand beside the picture.
    ///
    /// Asked for at every change of the picture: a widget whose plots hold long series overrides
    /// it, so that those are written out for the export alone.
    fn shown_tables(&self) -> Vec<Table> {
        let mut tables = self.tables();
        tables.retain(|table| table.place == TablePlace::Shown);
        tables
    }

    /// What a press at that point of a panel takes hold of, within `reach` (units of the axes).
    fn grab(&self, _panel: &str, _at: [f64; 2], _reach: [f64; 2]) -> Option<Handle> {
        None
    }

    /// Moves what was grabbed so that the grabbed spot lies at that point.
    fn drag(&mut self, _handle: Handle, _at: [f64; 2]) {}

    /// What was grabbed was let go.
    fn release(&mut self) {}

    /// A click or a tap at that point of a panel; `reach` is that of [`Model::grab`].
    fn tap(&mut self, _panel: &str, _at: [f64; 2], _reach: [f64; 2]) {}

    /// The pointer moved over a panel without pressing, or left it.
    fn hover(&mut self, _panel: &str, _at: Option<[f64; 2]>) {}

    /// Whether a reader may hand it a file, by dropping it on the picture for example.
    fn takes_files(&self) -> bool {
        false
    }

    /// Takes what the host brings from outside; what a widget does not know leaves it as it is.
    fn receive(&mut self, _delivery: &Delivery<'_>) {}

    /// Keys that press a button while one of these buttons has the focus, as browsers name them:
    /// `("ArrowLeft", "west")`.
    fn keys(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// What the widget asks of its host, in words, each once and in order: `open`, `look 12`.
    fn take_orders(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// The reader wants no animation: jump to the end of each instead.
    fn set_motion(&mut self, _motion: Motion) {}
}

/// Whether there is more to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Nothing moves: no further frame is needed.
    Idle,
    /// Call again.
    Busy,
    /// Call again; what is shown is as it was.
    Unseen,
}

impl Activity {
    /// Whether to call again.
    #[must_use]
    pub fn goes_on(self) -> bool {
        self != Self::Idle
    }
}

/// How much may move by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Motion {
    /// Animations run.
    #[default]
    Full,
    /// The system asks for reduced motion: states jump.
    Reduced,
}

/// Something taken hold of by [`Model::grab`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handle {
    /// The panel it lies in.
    pub panel: &'static str,
    /// Which thing: `source`, `turn`, `cell`.
    pub id: &'static str,
    /// Grabbed spot minus the thing's own position, so that it does not jump.
    pub offset: [f64; 2],
}

/// How an outcome is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// What the reader would want.
    Good,
    /// What the reader has to beware of.
    Bad,
    /// Neither.
    Neutral,
}

/// The result of the current state.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Good or bad.
    pub standing: Standing,
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
    /// The number; not finite where there is none.
    pub value: f64,
    /// Unit on screen.
    pub unit: &'static str,
    /// Digits after the point.
    pub decimals: usize,
}

impl Fact {
    /// The unit of an answer: 1 is shown as yes, 0 as no.
    pub const YES_OR_NO: &str = "yes or no";

    /// A number with its unit and the digits that are worth reading.
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

    /// An answer.
    #[must_use]
    pub fn yes_or_no(id: &'static str, label: &'static str, yes: bool) -> Self {
        Self::new(id, label, f64::from(u8::from(yes)), Self::YES_OR_NO, 0)
    }

    /// A whole number; not finite where there is none.
    #[must_use]
    pub fn count(id: &'static str, label: &'static str, value: f64) -> Self {
        Self::new(id, label, value, "", 0)
    }
}

/// A run that can be scrubbed.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    /// The parameter that holds the position; past the last one it means the end.
    pub param: &'static str,
    /// Last position; the first is 0.
    pub last: f64,
    /// Whether it plays.
    pub playing: bool,
    /// What happened on the way.
    pub marks: Vec<TimelineMark>,
}

/// An event on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineMark {
    /// Position.
    pub at: f64,
    /// In words: `loop 29 to 7 accepted`.
    pub label: String,
    /// Good or bad.
    pub standing: Standing,
}

/// A table: one CSV file, one block of readouts.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// File name without ending: `errors-over-time`.
    pub id: &'static str,
    /// Title on screen.
    pub title: String,
    /// Head of every column, with units.
    pub columns: Vec<String>,
    /// The rows; a cell is text or a number already formatted.
    pub rows: Vec<Vec<String>>,
    /// Shown beside the picture, or only given out as CSV.
    pub place: TablePlace,
}

impl Table {
    /// A table beside the picture.
    #[must_use]
    pub fn shown(
        id: &'static str,
        title: impl Into<String>,
        columns: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Self {
        let columns = columns.iter().map(|&head| head.to_owned());
        Self {
            id,
            title: title.into(),
            columns: columns.collect(),
            rows,
            place: TablePlace::Shown,
        }
    }

    /// A table for the export alone.
    #[must_use]
    pub fn exported(
        id: &'static str,
        title: impl Into<String>,
        columns: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Self {
        Self {
            place: TablePlace::ExportOnly,
            ..Self::shown(id, title, columns, rows)
        }
    }
}

/// Where a table stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TablePlace {
    /// Beside the picture.
    Shown,
    /// In the CSV export alone.
    ExportOnly,
}

/// Puts a model into the state that a preset names.
///
/// # Errors
/// [`ParamError`] where the preset names what the widget does not have: a bug that tests catch.
pub fn apply_preset(model: &mut dyn Model, preset: &Preset) -> Result<(), ParamError> {
    model.press("defaults")?;
    for (id, value) in preset.set {
        model.set(id, *value)?;
    }
    for button in preset.then {
        model.press(button)?;
    }
    Ok(())
}

/// Does all the [`Model::work`] that is left: a [`Model::settle`] where the picture waits for all of it.
pub fn finish_work(model: &mut dyn Model) -> Activity {
    let first = model.work();
    while model.work().goes_on() {}
    first
}

/// Presses the preset of that name, the last resort of a [`Model::press`].
///
/// # Errors
/// [`ParamError::UnknownButton`] where there is none; nothing changes then.
pub fn press_preset(model: &mut dyn Model, id: &str) -> Result<(), ParamError> {
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
