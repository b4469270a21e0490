//! Parameters: declared once, and from that one list come the sliders, the link form, the
//! JavaScript interface and the tables of the docs.
//!
//! A widget declares each as a [`Param`] or a [`OneOf`], which know the type of its value: a model
//! reads `values.get(&VARIANT)` and gets an `IcpVariant`. What goes over a list without knowing
//! types, such as the controls, sees [`ParamSpec`] and numbers: the index of an option, 0 or 1 of a
//! switch. A link writes choices and switches by name.

use core::marker::PhantomData;
use core::ops::Deref;

use thiserror::Error;

/// One option of a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Name in links and in JavaScript: `point-to-plane`.
    pub id: &'static str,
    /// Name on screen: `point to plane`.
    pub label: &'static str,
}

impl Choice {
    /// An option by its name in links and its name on screen.
    #[must_use]
    pub const fn new(id: &'static str, label: &'static str) -> Self {
        Self { id, label }
    }
}

/// How a parameter is shown, and which values it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// A number in `[min, max]`, moved in steps of `step` by keys and pointer alike.
    Slider {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Distance of neighbouring values; fine steps are a tenth of it.
        step: f64,
    },
    /// A position on the widget's timeline, from 0 to the length that the model reports at the
    /// moment; `max` bounds what a link may ask for.
    Timeline {
        /// Largest value that a link may carry.
        max: f64,
    },
    /// A whole number that is typed, such as a seed, from 0 to `max`.
    Seed {
        /// Largest value.
        max: f64,
    },
    /// One of a few named options; the value is the index.
    Choice {
        /// The options in order.
        options: &'static [Choice],
    },
    /// On (1) or off (0).
    Switch,
    /// Letters, digits, `-` and `_`, such as a world: set by [`crate::model::Model::set_text`].
    Text {
        /// Most characters.
        most: usize,
    },
}

/// One parameter of a widget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamSpec {
    /// Name in links and in JavaScript: `heading`.
    pub id: &'static str,
    /// Name on screen: `heading error`.
    pub label: &'static str,
    /// Unit on screen: `°`, `m`, or empty.
    pub unit: &'static str,
    /// How it is shown and which values it takes.
    pub kind: ParamKind,
    /// Value at the start and after "defaults".
    pub default: f64,
    /// One sentence on what it does.
    pub help: &'static str,
}

/// A declaration that knows the type of its value: [`Param`] or [`OneOf`].
pub trait Typed {
    /// What a model reads.
    type Value;

    /// The declaration as the list has it.
    fn spec(&self) -> &ParamSpec;

    /// The value that a number of the list stands for.
    fn read(&self, number: f64) -> Self::Value;

    /// The number that stands for a value.
    fn number(&self, value: Self::Value) -> f64;
}

/// What the value of a [`Param`] may be.
pub trait Number: Copy {
    /// The value that a number of the list stands for.
    fn read(number: f64) -> Self;

    /// The number that stands for it.
    fn number(self) -> f64;
}

impl Number for f64 {
    fn read(number: f64) -> Self {
        number
    }

    fn number(self) -> f64 {
        self
    }
}

impl Number for usize {
    fn read(number: f64) -> Self {
        number as Self
    }

    fn number(self) -> f64 {
        self as f64
    }
}

impl Number for u32 {
    fn read(number: f64) -> Self {
        number as Self
    }

    fn number(self) -> f64 {
        f64::from(self)
    }
}

impl Number for bool {
    fn read(number: f64) -> Self {
        number != 0.0
    }

    fn number(self) -> f64 {
        f64::from(u8::from(self))
    }
}

/// A parameter whose value is a number, whole or not, or a switch.
#[derive(Clone, Copy, Debug)]
pub struct Param<T> {
    /// The declaration as the list has it.
    pub spec: ParamSpec,
    value: PhantomData<T>,
}

impl<T> Param<T> {
    const fn new(id: &'static str, label: &'static str, kind: ParamKind) -> Self {
        let spec = ParamSpec {
            id,
            label,
            unit: "",
            kind,
            default: 0.0,
            help: "",
        };
        Self {
            spec,
            value: PhantomData,
        }
    }

    /// A number between both ends, moved in steps.
    #[must_use]
    pub const fn slider(
        id: &'static str,
        label: &'static str,
        [min, max]: [f64; 2],
        step: f64,
    ) -> Self {
        Self::new(id, label, ParamKind::Slider { min, max, step })
    }

    /// A place on the widget's timeline.
    #[must_use]
    pub const fn timeline(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Timeline { max })
    }

    /// A whole number that is typed.
    #[must_use]
    pub const fn typed(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Seed { max })
    }

    /// With a unit.
    #[must_use]
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.spec.unit = unit;
        self
    }

    /// With another default than 0.
    #[must_use]
    pub const fn default(mut self, default: f64) -> Self {
        self.spec.default = default;
        self
    }

    /// With one sentence on what it does.
    #[must_use]
    pub const fn help(mut self, help: &'static str) -> Self {
        self.spec.help = help;
        self
    }
}

impl Param<u32> {
    /// A seed of the core's generator.
    #[must_use]
    pub const fn seed(label: &'static str, default: u32) -> Self {
        Self::new("seed", label, ParamKind::SEED).default(default as f64)
    }

    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: u32) -> (&'static str, f64) {
        (self.spec.id, value as f64)
    }
}

impl Param<usize> {
    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: usize) -> (&'static str, f64) {
        (self.spec.id, value as f64)
    }
}

impl Param<f64> {
    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: f64) -> (&'static str, f64) {
        (self.spec.id, value)
    }
}

impl Param<bool> {
    /// A switch that is off.
    #[must_use]
    pub const fn switch(id: &'static str, label: &'static str) -> Self {
        Self::new(id, label, ParamKind::Switch)
    }

    /// A switch that is on at the start.
    #[must_use]
    pub const fn on(self) -> Self {
        self.default(1.0)
    }

    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: bool) -> (&'static str, f64) {
        (self.spec.id, value as u8 as f64)
    }
}

impl<T: Number> Typed for Param<T> {
    type Value = T;

    fn spec(&self) -> &ParamSpec {
        &self.spec
    }

    fn read(&self, number: f64) -> T {
        T::read(number)
    }

    fn number(&self, value: T) -> f64 {
        value.number()
    }
}

impl<T> Deref for Param<T> {
    type Target = ParamSpec;

    fn deref(&self) -> &ParamSpec {
        &self.spec
    }
}

/// A parameter whose value is one of a few.
#[derive(Clone, Copy, Debug)]
pub struct OneOf<T: 'static> {
    /// The declaration as the list has it.
    pub spec: ParamSpec,
    values: &'static [T],
}

impl<T> OneOf<T> {
    /// A choice between options that stand for these values, in the same order; the first is the default.
    ///
    /// # Panics
    /// If their numbers differ: in a `static` the compiler says so.
    #[must_use]
    pub const fn new(
        id: &'static str,
        label: &'static str,
        options: &'static [Choice],
        values: &'static [T],
    ) -> Self {
        assert!(options.len() == values.len(), "an option without a value");
        let spec = Param::<T>::new(id, label, ParamKind::Choice { options }).spec;
        Self { spec, values }
    }

    /// With another default than the first option.
    #[must_use]
    pub const fn default(mut self, option: &str) -> Self {
        self.spec.default = self.to(option).1;
        self
    }

    /// With one sentence on what it does.
    #[must_use]
    pub const fn help(mut self, help: &'static str) -> Self {
        self.spec.help = help;
        self
    }

    /// The value for a preset, by its option.
    ///
    /// # Panics
    /// If there is no such option: in a `const` the compiler says so.
    #[must_use]
    pub const fn to(&self, option: &str) -> (&'static str, f64) {
        let ParamKind::Choice { options } = self.spec.kind else {
            panic!("made by `new`");
        };
        let mut index = 0;
        while index < options.len() {
            if is_same(options[index].id.as_bytes(), option.as_bytes()) {
                return (self.spec.id, index as f64);
            }
            index += 1;
        }
        panic!("no such option");
    }
}

/// `a == b`, for constants.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut index = 0;
    while index < a.len() && index < b.len() && a[index] == b[index] {
        index += 1;
    }
    index == a.len() && index == b.len()
}

impl<T: Copy + PartialEq> Typed for OneOf<T> {
    type Value = T;

    fn spec(&self) -> &ParamSpec {
        &self.spec
    }

    fn read(&self, number: f64) -> T {
        self.values[number as usize]
    }

    fn number(&self, value: T) -> f64 {
        let index = self.values.iter().position(|known| *known == value);
        index.expect("a value of the options") as f64
    }
}

impl<T> Deref for OneOf<T> {
    type Target = ParamSpec;

    fn deref(&self) -> &ParamSpec {
        &self.spec
    }
}

/// Whether everything is shown. A widget with layers lists it last.
pub static MORE: Param<bool> =
    Param::switch("more", "more").help("Shows all settings, presets, numbers, tables and plots.");

/// Why a value was refused. The old value stands.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParamError {
    /// No parameter of that name.
    #[error("{widget} has no parameter `{id}`; it has {known}")]
    UnknownParam {
        /// Widget that was asked.
        widget: &'static str,
        /// The name that was given.
        id: String,
        /// The names there are.
        known: String,
    },
    /// No button of that name.
    #[error("{widget} has no button `{id}`; it has {known}")]
    UnknownButton {
        /// Widget that was asked.
        widget: &'static str,
        /// The name that was given.
        id: String,
        /// The names there are.
        known: String,
    },
    /// A number outside the range.
    #[error("`{id}` takes {min} to {max}, not {value}")]
    OutOfRange {
        /// Parameter.
        id: &'static str,
        /// Value that was given.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// Text that is no value of this parameter.
    #[error("`{id}` takes {expected}, not `{text}`")]
    Unreadable {
        /// Parameter.
        id: &'static str,
        /// Text that was given, fit to be shown.
        text: String,
        /// What would have been right.
        expected: String,
    },
    /// Text whose letters are right, and what it says is not.
    #[error("`{id}` cannot be taken: {problem}")]
    Refused {
        /// Parameter.
        id: &'static str,
        /// What is wrong, and what to do.
        problem: String,
    },
}

impl ParamKind {
    /// A seed of the core's generator: any 32-bit number.
    pub const SEED: Self = Self::Seed {
        max: u32::MAX as f64,
    };
}

impl ParamSpec {
    /// Smallest and largest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match self.kind {
            ParamKind::Slider { min, max, .. } => (min, max),
            ParamKind::Timeline { max } | ParamKind::Seed { max } => (0.0, max),
            ParamKind::Choice { options } => (0.0, options.len() as f64 - 1.0),
            ParamKind::Switch => (0.0, 1.0),
            // No number is a text; 0 is none.
            ParamKind::Text { .. } => (0.0, 0.0),
        }
    }

    /// Distance of neighbouring values.
    #[must_use]
    pub fn step(&self) -> f64 {
        match self.kind {
            ParamKind::Slider { step, .. } => step,
            _ => 1.0,
        }
    }

    /// The value as it is kept: checked against the range, whole where it must be.
    ///
    /// # Errors
    /// [`ParamError::OutOfRange`] where the value is not a number of the range.
    pub fn check(&self, value: f64) -> Result<f64, ParamError> {
        let (min, max) = self.range();
        // A sum of steps may end a few last bits beyond the range.
        let slack = 1e-6 * self.step();
        if !value.is_finite() || value < min - slack || value > max + slack {
            return Err(ParamError::OutOfRange {
                id: self.id,
                value,
                min,
                max,
            });
        }
        let value = value.clamp(min, max);
        Ok(match self.kind {
            ParamKind::Slider { .. } => value,
            _ => value.round(),
        })
    }

    /// Digits after the point that the step needs, one more for fine steps.
    #[must_use]
    pub fn decimals(&self) -> usize {
        match self.kind {
            ParamKind::Slider { step, .. } => {
                let mut decimals = 0;
                let mut scaled = step;
                while decimals < 6 && (scaled - scaled.round()).abs() > 1e-9 {
                    scaled *= 10.0;
                    decimals += 1;
                }
                decimals
            }
            _ => 0,
        }
    }

    /// The value as a link writes it: `60`, `point-to-plane`, `on`.
    #[must_use]
    pub fn to_text(&self, value: f64) -> String {
        match self.kind {
            ParamKind::Choice { options } => options
                .get(value as usize)
                .map_or_else(|| value.to_string(), |choice| choice.id.to_owned()),
            ParamKind::Switch => if value == 0.0 { "off" } else { "on" }.to_owned(),
            // No number is a text: see `Values::to_text`.
            ParamKind::Text { .. } => String::new(),
            // Display of an f64 is the shortest text that reads back to the same bits.
            _ => format!("{value}"),
        }
    }

    /// Reads what [`ParamSpec::to_text`] writes, checked against the range; of a text that can be kept, 0.
    ///
    /// # Errors
    /// [`ParamError::Unreadable`] or [`ParamError::OutOfRange`], each naming what would be right.
    pub fn parse(&self, text: &str) -> Result<f64, ParamError> {
        let text = text.trim();
        let unreadable = |expected: String| ParamError::Unreadable {
            id: self.id,
            text: printable(text),
            expected,
        };
        match self.kind {
            ParamKind::Choice { options } => options
                .iter()
                .position(|choice| choice.id == text)
                .map(|index| index as f64)
                .ok_or_else(|| {
                    let ids: Vec<_> = options.iter().map(|choice| choice.id).collect();
                    unreadable(ids.join(" or "))
                }),
            ParamKind::Switch => match text {
                "on" | "1" | "true" => Ok(1.0),
                "off" | "0" | "false" => Ok(0.0),
                _ => Err(unreadable("on or off".to_owned())),
            },
            ParamKind::Text { most } => {
                let fits = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
                if text.len() > most || !text.bytes().all(fits) {
                    let expected = format!("at most {most} letters, digits, - and _");
                    return Err(unreadable(expected));
                }
                Ok(0.0)
            }
            _ => {
                let value = text
                    .parse()
                    .map_err(|_| unreadable("a number".to_owned()))?;
                self.check(value)
            }
        }
    }
}

/// Most characters of a text from outside that a message repeats.
const MAX_REPEATED: usize = 60;

/// A text from outside as a message repeats it: without control characters, and not for ever.
#[must_use]
pub fn printable(text: &str) -> String {
    let mut shown = String::new();
    let mut room = MAX_REPEATED;
    for character in text.chars() {
        let escaped = character.escape_debug();
        let length = if character.is_control() {
            escaped.len()
        } else {
            1
        };
        if length > room {
            shown.push('…');
            break;
        }
        room -= length;
        if character.is_control() {
            shown.extend(escaped);
        } else {
            shown.push(character);
        }
    }
    shown
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const SPECS: &[&ParamSpec] = &[
        &ParamSpec {
            id: "heading",
            label: "heading error",
            unit: "°",
            kind: ParamKind::Slider {
                min: -180.0,
                max: 180.0,
                step: 1.0,
            },
            default: 25.0,
            help: "",
        },
        &ParamSpec {
            id: "variant",
            label: "variant",
            unit: "",
            kind: ParamKind::Choice {
                options: &[
                    Choice {
                        id: "point-to-point",
                        label: "point to point",
                    },
                    Choice {
                        id: "point-to-plane",
                        label: "point to plane",
                    },
                ],
            },
            default: 0.0,
            help: "",
        },
    ];

    #[test]
    fn what_a_link_writes_reads_back_to_the_same_bits() {
        for value in [0.1 + 0.2, -179.999_999_9, 25.0] {
            let text = SPECS[0].to_text(value);
            assert_eq!(SPECS[0].parse(&text).unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(SPECS[1].parse("point-to-plane"), Ok(1.0));
        assert_eq!(SPECS[1].to_text(1.0), "point-to-plane");
    }

    #[test]
    fn a_choice_that_is_not_there_is_refused_with_those_that_are() {
        let error = SPECS[1].parse("plane").unwrap_err();
        assert_eq!(
            error.to_string(),
            "`variant` takes point-to-point or point-to-plane, not `plane`"
        );
    }

    #[test]
    fn what_a_message_repeats_has_no_control_characters_and_ends() {
        assert_eq!(printable("point-to-plane"), "point-to-plane");
        assert_eq!(printable("a\u{1b}[2Jb"), "a\\u{1b}[2Jb");
        assert_eq!(printable(&"é".repeat(61)), format!("{}…", "é".repeat(60)));
        let escaped = printable(&"\u{1b}".repeat(61));
        assert_eq!(escaped, format!("{}…", "\\u{1b}".repeat(10)));
    }
}
