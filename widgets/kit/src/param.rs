//! Parameters: one declaration yields the control, the link, the JavaScript interface and the tables of the
//! docs.
//!
//! A widget declares each one as a [`Param`] or a [`OneOf`], which carry the type of its value: a model reads
//! `values.get(&VARIANT)` and gets an `IcpVariant`. Code that handles all parameters alike, such as the
//! controls, uses [`ParamSpec`] and numbers: the index of an option, 0 or 1 for a switch. Links contain the
//! names of options and switches.

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
    /// An option from its name in links and its name on screen.
    #[must_use]
    pub const fn new(id: &'static str, label: &'static str) -> Self {
        Self { id, label }
    }
}

/// The kind of a parameter: its control and its valid values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// A number in `[min, max]`, moved in steps of `step` by keys and pointer.
    Slider {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// Difference of neighbouring values; fine steps are a tenth of it.
        step: f64,
    },
    /// A position on the widget's timeline, from 0 to the length that the model currently reports; `max`
    /// bounds the values in links.
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
    /// Letters, digits, `-` and `_`, such as an encoded world; set by [`crate::model::Model::set_text`].
    Text {
        /// Largest number of characters.
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
    /// Its control and its valid values.
    pub kind: ParamKind,
    /// Value at the start and after "defaults".
    pub default: f64,
    /// One sentence on its effect.
    pub help: &'static str,
}

/// A declaration with the type of its value: [`Param`] or [`OneOf`].
pub trait Typed {
    /// The type that a model reads.
    type Value;

    /// The untyped declaration.
    fn spec(&self) -> &ParamSpec;

    /// Converts a number of the list to the value.
    fn read(&self, number: f64) -> Self::Value;

    /// Converts a value to its number in the list.
    fn number(&self, value: Self::Value) -> f64;
}

/// A type that the value of a [`Param`] may have.
pub trait Number: Copy {
    /// Converts a number of the list to the value.
    fn read(number: f64) -> Self;

    /// Converts the value to its number in the list.
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

/// A parameter whose value is a number or a switch.
#[derive(Clone, Copy, Debug)]
pub struct Param<T> {
    /// The untyped declaration.
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

    /// A number between two limits, moved in steps.
    #[must_use]
    pub const fn slider(
        id: &'static str,
        label: &'static str,
        [min, max]: [f64; 2],
        step: f64,
    ) -> Self {
        Self::new(id, label, ParamKind::Slider { min, max, step })
    }

    /// A position on the widget's timeline.
    #[must_use]
    pub const fn timeline(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Timeline { max })
    }

    /// A whole number that is typed.
    #[must_use]
    pub const fn typed(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Seed { max })
    }

    /// Sets the unit.
    #[must_use]
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.spec.unit = unit;
        self
    }

    /// Sets a default other than 0.
    #[must_use]
    pub const fn default(mut self, default: f64) -> Self {
        self.spec.default = default;
        self
    }

    /// Sets the sentence on its effect.
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

/// A parameter with a few named values.
#[derive(Clone, Copy, Debug)]
pub struct OneOf<T: 'static> {
    /// The untyped declaration.
    pub spec: ParamSpec,
    values: &'static [T],
}

impl<T> OneOf<T> {
    /// A choice between options for these values, in the same order; the first one is the default.
    ///
    /// # Panics
    /// If the numbers of options and values differ: in a `static` at compile time.
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

    /// Sets a default other than the first option.
    #[must_use]
    pub const fn default(mut self, option: &str) -> Self {
        self.spec.default = self.to(option).1;
        self
    }

    /// Sets the sentence on its effect.
    #[must_use]
    pub const fn help(mut self, help: &'static str) -> Self {
        self.spec.help = help;
        self
    }

    /// The value for a preset, by its option.
    ///
    /// # Panics
    /// If there is no such option: in a `const` at compile time.
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
        index.expect("the value is one of the options") as f64
    }
}

impl<T> Deref for OneOf<T> {
    type Target = ParamSpec;

    fn deref(&self) -> &ParamSpec {
        &self.spec
    }
}

/// Whether everything is shown. A widget with layers lists it as its last parameter.
pub static MORE: Param<bool> =
    Param::switch("more", "more").help("Shows all settings, presets, numbers, tables and plots.");

/// Why a value was rejected. The old value remains.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParamError {
    /// No parameter of that name.
    #[error("{widget} has no parameter `{id}`; it has {known}")]
    UnknownParam {
        /// Name of the widget.
        widget: &'static str,
        /// The unknown name.
        id: String,
        /// The valid names.
        known: String,
    },
    /// No button of that name.
    #[error("{widget} has no button `{id}`; it has {known}")]
    UnknownButton {
        /// Name of the widget.
        widget: &'static str,
        /// The unknown name.
        id: String,
        /// The valid names.
        known: String,
    },
    /// A number outside the range.
    #[error("`{id}` takes {min} to {max}, not {value}")]
    OutOfRange {
        /// Parameter.
        id: &'static str,
        /// The given value.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A text that is invalid for this parameter.
    #[error("`{id}` takes {expected}, not `{text}`")]
    Unreadable {
        /// Parameter.
        id: &'static str,
        /// The given text, shortened for display.
        text: String,
        /// The valid texts.
        expected: String,
    },
    /// A text with valid characters and invalid content.
    #[error("`{id}` is invalid: {problem}")]
    Refused {
        /// Parameter.
        id: &'static str,
        /// What is wrong, and how to fix it.
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
            // A text has no number; 0 stands for it.
            ParamKind::Text { .. } => (0.0, 0.0),
        }
    }

    /// Difference of neighbouring values.
    #[must_use]
    pub fn step(&self) -> f64 {
        match self.kind {
            ParamKind::Slider { step, .. } => step,
            _ => 1.0,
        }
    }

    /// Checks a value against the range, and rounds it if it must be whole.
    ///
    /// # Errors
    /// [`ParamError::OutOfRange`] if the value is not a number of the range.
    pub fn check(&self, value: f64) -> Result<f64, ParamError> {
        let (min, max) = self.range();
        // Rounding of a sum of steps may exceed the range.
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

    /// Digits after the point that the step needs, plus one for fine steps.
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

    /// The value in the form of a link: `60`, `point-to-plane`, `on`.
    #[must_use]
    pub fn to_text(&self, value: f64) -> String {
        match self.kind {
            ParamKind::Choice { options } => options
                .get(value as usize)
                .map_or_else(|| value.to_string(), |choice| choice.id.to_owned()),
            ParamKind::Switch => if value == 0.0 { "off" } else { "on" }.to_owned(),
            // A text has no number: see `Values::to_text`.
            ParamKind::Text { .. } => String::new(),
            // Display of an f64 is the shortest text that parses to the same bits.
            _ => format!("{value}"),
        }
    }

    /// Parses the output of [`ParamSpec::to_text`] and checks it against the range; 0 for a valid text.
    ///
    /// # Errors
    /// [`ParamError::Unreadable`] or [`ParamError::OutOfRange`], each with the valid values.
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

/// Largest number of characters of an external text that a message quotes.
const MAX_REPEATED: usize = 60;

/// Shortens an external text for a message and removes its control characters.
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
    fn the_text_in_a_link_parses_to_the_same_bits() {
        for value in [0.1 + 0.2, -179.999_999_9, 25.0] {
            let text = SPECS[0].to_text(value);
            assert_eq!(SPECS[0].parse(&text).unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(SPECS[1].parse("point-to-plane"), Ok(1.0));
        assert_eq!(SPECS[1].to_text(1.0), "point-to-plane");
    }

    #[test]
    fn an_unknown_option_is_an_error_that_lists_the_valid_ones() {
        let error = SPECS[1].parse("plane").unwrap_err();
        assert_eq!(
            error.to_string(),
            "`variant` takes point-to-point or point-to-plane, not `plane`"
        );
    }

    #[test]
    fn a_quoted_text_is_short_and_without_control_characters() {
        assert_eq!(printable("point-to-plane"), "point-to-plane");
        assert_eq!(printable("a\u{1b}[2Jb"), "a\\u{1b}[2Jb");
        assert_eq!(printable(&"é".repeat(61)), format!("{}…", "é".repeat(60)));
        let escaped = printable(&"\u{1b}".repeat(61));
        assert_eq!(escaped, format!("{}…", "\\u{1b}".repeat(10)));
    }
}
