//! Errors about parameters, and external text in messages.

use thiserror::Error;

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
    Rejected {
        /// Parameter.
        id: &'static str,
        /// What is wrong, and how to fix it.
        problem: String,
    },
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
