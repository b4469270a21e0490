//! The untyped declaration of a parameter: valid values, and their form in links.

use super::error::{ParamError, printable};

/// One option of a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Name in links and in JavaScript: `point-to-plane`.
    pub id: &'static str,
    /// Name on screen: `point-to-plane`.
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
