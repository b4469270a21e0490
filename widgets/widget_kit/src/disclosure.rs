//! What a widget shows at the start, and the rest, which "More" opens.
//!
//! Whether the rest is shown is a parameter like any other: links, attributes and programs can set it. A
//! widget without this parameter shows everything.

use crate::param::MORE;
use crate::values::Values;

/// The parts that a widget shows at the start, besides its title, timeline and verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opening {
    /// The panels of the scene.
    pub panels: &'static [&'static str],
    /// The controls that the widget's section is about.
    pub params: &'static [&'static str],
    /// The buttons: Play and related ones.
    pub buttons: &'static [&'static str],
}

impl Opening {
    /// For a widget that shows everything.
    pub const ALL: Self = Self {
        panels: &[],
        params: &[],
        buttons: &[],
    };
}

/// The visible parts of a widget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disclosure {
    /// The parts shown at the start.
    First(Opening),
    /// Everything.
    All,
    /// Everything except controls that are irrelevant in the current state.
    AllBut(&'static [&'static str]),
}

impl Disclosure {
    /// What the values select.
    #[must_use]
    pub fn visible(opening: Opening, values: &Values) -> Self {
        match values.find(MORE.id) {
            Some((_, 0.0)) => Self::First(opening),
            _ => Self::All,
        }
    }

    /// Whether everything is shown.
    #[must_use]
    pub fn is_all(&self) -> bool {
        matches!(self, Self::All | Self::AllBut(_))
    }

    /// Whether a panel is shown.
    #[must_use]
    pub fn has_panel(&self, id: &str) -> bool {
        self.has(id, |opening| opening.panels)
    }

    /// Whether the control of a parameter is shown.
    #[must_use]
    pub fn has_param(&self, id: &str) -> bool {
        self.has(id, |opening| opening.params)
    }

    /// Whether a button is shown.
    #[must_use]
    pub fn has_button(&self, id: &str) -> bool {
        self.has(id, |opening| opening.buttons)
    }

    fn has(&self, id: &str, of: fn(&Opening) -> &'static [&'static str]) -> bool {
        match self {
            Self::First(opening) => of(opening).contains(&id),
            Self::All => true,
            Self::AllBut(hidden) => !hidden.contains(&id),
        }
    }
}
