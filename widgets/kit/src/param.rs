//! Parameters: declared once, and from that one list come the sliders, the link form, the
//! JavaScript interface and the tables of the docs.
//!
//! Every value is an `f64`: a choice is the index of its option, a switch is 0 or 1, a seed is a
//! whole number below 2³². A link writes choices and switches by name. A text is kept beside its
//! value, which is a whole number that tells texts apart.

use thiserror::Error;

use crate::layers::MORE;

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

/// The current value of every parameter of a list, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    specs: &'static [ParamSpec],
    values: Vec<f64>,
    /// Of the same index; empty where the parameter is no text.
    texts: Vec<String>,
}

impl Values {
    /// Every parameter at its default.
    #[must_use]
    pub fn defaults(specs: &'static [ParamSpec]) -> Self {
        Self {
            specs,
            values: specs.iter().map(|spec| spec.default).collect(),
            texts: vec![String::new(); specs.len()],
        }
    }

    /// Puts every parameter back to its default, but for [`MORE`]: what the reader has opened stays
    /// open.
    pub fn reset(&mut self) {
        for (spec, value) in self.specs.iter().zip(&mut self.values) {
            if spec.id != MORE.id {
                *value = spec.default;
            }
        }
        self.texts.fill(String::new());
    }

    /// The list these values belong to.
    #[must_use]
    pub fn specs(&self) -> &'static [ParamSpec] {
        self.specs
    }

    /// The parameter of that name with its value.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<(&'static ParamSpec, f64)> {
        let index = self.specs.iter().position(|spec| spec.id == id)?;
        Some((&self.specs[index], self.values[index]))
    }

    /// The parameter of that name with its value, or words that name what there is.
    ///
    /// # Errors
    /// [`ParamError::UnknownParam`].
    pub fn find_for(
        &self,
        widget: &'static str,
        id: &str,
    ) -> Result<(&'static ParamSpec, f64), ParamError> {
        self.find(id).ok_or_else(|| self.unknown(widget, id))
    }

    fn unknown(&self, widget: &'static str, id: &str) -> ParamError {
        let known: Vec<_> = self.specs.iter().map(|spec| spec.id).collect();
        ParamError::UnknownParam {
            widget,
            id: printable(id),
            known: known.join(", "),
        }
    }

    /// The value of a parameter that the widget itself declares.
    ///
    /// # Panics
    /// Where the list has no such name: a bug of the widget.
    #[must_use]
    pub fn get(&self, id: &str) -> f64 {
        match self.find(id) {
            Some((_, value)) => value,
            None => panic!("no parameter `{id}` in the list"),
        }
    }

    /// Sets a parameter after checking name and range; says whether the value changed.
    ///
    /// # Errors
    /// [`ParamError::UnknownParam`] or [`ParamError::OutOfRange`]; nothing changes then.
    pub fn set(
        &mut self,
        widget: &'static str,
        id: &str,
        value: f64,
    ) -> Result<Changed, ParamError> {
        let Some(index) = self.specs.iter().position(|spec| spec.id == id) else {
            return Err(self.unknown(widget, id));
        };
        let spec = &self.specs[index];
        let value = spec.check(value)?;
        if value.to_bits() == self.values[index].to_bits() {
            return Ok(Changed::No);
        }
        if matches!(spec.kind, ParamKind::Text { .. }) {
            // A number can only take a text away.
            if value != 0.0 {
                return Err(ParamError::OutOfRange {
                    id: spec.id,
                    value,
                    min: 0.0,
                    max: 0.0,
                });
            }
            self.texts[index].clear();
        }
        self.values[index] = value;
        Ok(Changed::Yes)
    }

    /// Keeps a value of the widget's own, that lies in its range by construction.
    ///
    /// # Panics
    /// Where the list refuses it: a bug of the widget.
    pub fn store(&mut self, id: &str, value: f64) -> Changed {
        match self.set("the widget", id, value) {
            Ok(changed) => changed,
            Err(error) => panic!("a value of our own was refused: {error}"),
        }
    }

    /// Sets a parameter to what [`Values::to_text`] writes; says whether it changed.
    ///
    /// # Errors
    /// [`ParamError`]; nothing changes then.
    pub fn set_text(
        &mut self,
        widget: &'static str,
        id: &str,
        text: &str,
    ) -> Result<Changed, ParamError> {
        let Some(index) = self.specs.iter().position(|spec| spec.id == id) else {
            return Err(self.unknown(widget, id));
        };
        let value = self.specs[index].parse(text)?;
        if !matches!(self.specs[index].kind, ParamKind::Text { .. }) {
            return self.set(widget, id, value);
        }
        let text = text.trim();
        if self.texts[index] == text {
            return Ok(Changed::No);
        }
        text.clone_into(&mut self.texts[index]);
        self.values[index] = value;
        Ok(Changed::Yes)
    }

    /// The value of a parameter as a link writes it.
    ///
    /// # Panics
    /// Where the list has no such parameter: a bug of the widget.
    #[must_use]
    pub fn to_text(&self, id: &str) -> String {
        let index = self.specs.iter().position(|spec| spec.id == id);
        let Some(index) = index else {
            panic!("no parameter `{id}` in the list");
        };
        match self.specs[index].kind {
            ParamKind::Text { .. } => self.texts[index].clone(),
            _ => self.specs[index].to_text(self.values[index]),
        }
    }

    /// Every parameter with its value, in the list's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, f64)> {
        self.specs.iter().zip(self.values.iter().copied())
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

/// Whether a call changed anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changed {
    /// Something is new: compute again.
    Yes,
    /// All is as it was.
    No,
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECS: &[ParamSpec] = &[
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
    fn a_refused_value_changes_nothing_and_names_the_remedy() {
        let mut values = Values::defaults(SPECS);
        for bad in [f64::NAN, f64::INFINITY, 181.0, -1e300] {
            assert!(values.set("w", "heading", bad).is_err(), "{bad} was taken");
        }
        let error = values.set("w", "headin", 3.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "w has no parameter `headin`; it has heading, variant"
        );
        assert_eq!(values, Values::defaults(SPECS));
        let error = values.find_for("w", "headin").unwrap_err();
        assert!(error.to_string().starts_with("w has no parameter `headin`"));
        let error = SPECS[1].parse("plane").unwrap_err();
        assert_eq!(
            error.to_string(),
            "`variant` takes point-to-point or point-to-plane, not `plane`"
        );
    }

    #[test]
    fn a_text_is_kept_beside_a_number_that_tells_texts_apart() {
        const TEXTS: &[ParamSpec] = &[ParamSpec {
            id: "flat",
            label: "flat",
            unit: "",
            kind: ParamKind::Text { most: 8 },
            default: 0.0,
            help: "",
        }];
        let mut values = Values::defaults(TEXTS);
        assert_eq!(values.set_text("w", "flat", " Aa0-_ "), Ok(Changed::Yes));
        assert_eq!(values.to_text("flat"), "Aa0-_");
        let before = values.clone();
        for bad in ["123456789", "a b", "é", "a+b"] {
            let error = values.set_text("w", "flat", bad).unwrap_err().to_string();
            assert!(
                error.starts_with("`flat` takes at most 8 letters"),
                "{error}"
            );
        }
        assert!(values.set("w", "flat", 1.0).is_err());
        assert_eq!(values, before);
        assert_eq!(values.set_text("w", "flat", "Aa0-A"), Ok(Changed::Yes));
        assert_ne!(values.get("flat"), before.get("flat"));
        assert_eq!(values.set("w", "flat", 0.0), Ok(Changed::Yes));
        assert_eq!(values, Values::defaults(TEXTS));
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
