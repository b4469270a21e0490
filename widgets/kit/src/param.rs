//! Parameters: declared once, and from that one list come the sliders, the link form, the
//! JavaScript interface and the tables of the docs.
//!
//! Every value is an `f64`: a choice is the index of its option, a switch is 0 or 1, a seed is a
//! whole number below 2³². A link writes choices and switches by name. A text is kept beside its
//! value, which is a whole number that tells texts apart.

use thiserror::Error;

/// One option of a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Name in links and in JavaScript: `point-to-plane`.
    pub id: &'static str,
    /// Name on screen: `point to plane`.
    pub label: &'static str,
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

/// Whether everything is shown. A widget with layers lists it last.
pub const MORE: ParamSpec = ParamSpec {
    id: "more",
    label: "more",
    unit: "",
    kind: ParamKind::Switch,
    default: 0.0,
    help: "Shows all settings, presets, numbers, tables and plots.",
};

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
        if matches!(self.kind, ParamKind::Text { .. }) && is_fingerprint(value) {
            return Ok(value);
        }
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
            // The number tells texts apart, but not what they are: see `Values::to_text`.
            ParamKind::Text { .. } => String::new(),
            // Display of an f64 is the shortest text that reads back to the same bits.
            _ => format!("{value}"),
        }
    }

    /// Reads what [`ParamSpec::to_text`] writes, checked against the range.
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
                Ok(fingerprint(text))
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

/// The number that stands for a text: 0 for none, else FNV-1a, folded to what an `f64` holds.
fn fingerprint(text: &str) -> f64 {
    if text.is_empty() {
        return 0.0;
    }
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    ((hash >> 12 ^ hash) % MOST_FINGERPRINT + 1) as f64
}

/// Below 2⁵³ every whole number is an `f64`.
const MOST_FINGERPRINT: u64 = 1 << 52;

fn is_fingerprint(value: f64) -> bool {
    (0.0..=MOST_FINGERPRINT as f64).contains(&value) && value.fract() == 0.0
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

    pub(crate) const SPECS: &[ParamSpec] = &[
        ParamSpec {
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
        ParamSpec {
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
