//! What a widget says of itself: title, words, parameters, buttons, presets.

use crate::layers::Opening;
use crate::param::ParamSpec;

/// Everything about a widget that never changes.
#[derive(Clone, Copy, Debug)]
pub struct WidgetSpec {
    /// Number in the chapter and name in links: `w16.1`.
    pub id: &'static str,
    /// Title on screen: `Basin explorer`.
    pub title: &'static str,
    /// One sentence on the misconception that the widget removes.
    pub misconception: &'static str,
    /// "What to notice", a sentence each.
    pub notice: &'static [&'static str],
    /// What it shows until the reader asks for more.
    pub opening: Opening,
    /// The parameters, in the order of their controls.
    pub params: &'static [&'static ParamSpec],
    /// The buttons, in their order: transport first.
    pub buttons: &'static [ButtonSpec],
    /// "What to try": buttons that set the state.
    pub presets: &'static [Preset],
}

/// A button that does something once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ButtonSpec {
    /// Name in JavaScript and for [`crate::model::Model::press`]: `step`.
    pub id: &'static str,
    /// Name on screen.
    pub label: &'static str,
    /// One sentence on what it does.
    pub help: &'static str,
}

/// "What to try": a named state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Name for [`crate::model::Model::press`]: `quarter-turn`.
    pub id: &'static str,
    /// The invitation on the button: `Start 60° off`.
    pub label: &'static str,
    /// What the reader will see.
    pub help: &'static str,
    /// Parameters to set; all others go back to their defaults.
    pub set: &'static [(&'static str, f64)],
    /// Buttons pressed afterwards, such as `play`.
    pub then: &'static [&'static str],
}

/// Starts and pauses the playback; shown as pressed while it plays.
pub const PLAY: ButtonSpec = ButtonSpec {
    id: "play",
    label: "Play",
    help: "Play the run from here, or pause it.",
};

/// One step of the timeline.
pub const STEP: ButtonSpec = ButtonSpec {
    id: "step",
    label: "Step",
    help: "Go one step forward.",
};

/// Back to the start of the timeline; the parameters stay.
pub const RESET: ButtonSpec = ButtonSpec {
    id: "reset",
    label: "Reset",
    help: "Go back to the start of the run; the settings stay.",
};

/// Every parameter back to its default.
pub const DEFAULTS: ButtonSpec = ButtonSpec {
    id: "defaults",
    label: "Defaults",
    help: "Put every setting back to where it started.",
};
