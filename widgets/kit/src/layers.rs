//! What a widget opens with, and the rest, which stands under "More".
//!
//! Whether the rest is shown is a parameter like any other: links, attributes and programs have it.
//! A widget that does not list it shows everything.

use crate::param::MORE;
use crate::values::Values;

/// What a widget opens with, beside its title, its timeline and its verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opening {
    /// The panels that are the scene.
    pub panels: &'static [&'static str],
    /// The controls that the widget's section is about.
    pub params: &'static [&'static str],
    /// The buttons: Play, and what goes with it.
    pub buttons: &'static [&'static str],
}

impl Opening {
    /// Of a widget without layers.
    pub const ALL: Self = Self {
        panels: &[],
        params: &[],
        buttons: &[],
    };
}

/// What is shown of a widget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// What it opens with.
    First(Opening),
    /// Everything.
    All,
    /// Everything but the controls of something that the reader is not at.
    AllBut(&'static [&'static str]),
}

impl Layer {
    /// The layer that the values ask for.
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
