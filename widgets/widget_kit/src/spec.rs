//! The description of a widget: title, texts, parameters, buttons, presets.

use crate::disclosure::Opening;
use crate::param::ParamSpec;

/// The constant description of a widget.
#[derive(Clone, Copy, Debug)]
pub struct WidgetSpec {
    /// Number in the chapter and name in links: `w16.1`.
    pub id: &'static str,
    /// Short name, of which the types of programs are named: `Basin explorer`.
    pub name: &'static str,
    /// Title on screen: the question that the reader answers by a gesture.
    pub title: &'static str,
    /// One sentence on what the answer shows: it comes with the verdict.
    pub claim: &'static str,
    /// The gesture that answers: it stands where the verdict comes, see [`crate::shell::Shell::asks`].
    pub gesture: &'static str,
    /// What of a run the verdict waits for.
    pub awaits: Awaits,
    /// "What to notice", a sentence each.
    pub notice: &'static [&'static str],
    /// The parts that are shown until the reader opens the rest.
    pub opening: Opening,
    /// The parameters, in the order of their controls.
    pub params: &'static [&'static ParamSpec],
    /// The buttons, in their order: transport first.
    pub buttons: &'static [ButtonSpec],
    /// "What to try": buttons that set the state.
    pub presets: &'static [Preset],
}

/// What of a run a verdict waits for; until then the gesture stands in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Awaits {
    /// Nothing: it judges the shown moment.
    Nothing,
    /// That none plays: the picture of any other moment shows what it judges.
    Rest,
    /// Its end: only there the picture shows what it judges.
    End,
}

/// A button with a single action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ButtonSpec {
    /// Name in JavaScript and for [`crate::model::Model::press`]: `step`.
    pub id: &'static str,
    /// Name on screen.
    pub label: &'static str,
    /// One sentence on its effect.
    pub help: &'static str,
}

impl ButtonSpec {
    /// A button from its name, its name on screen and its effect.
    #[must_use]
    pub const fn new(id: &'static str, label: &'static str, help: &'static str) -> Self {
        Self { id, label, help }
    }
}

/// The number of buttons of several groups.
#[must_use]
pub const fn count(groups: &[&[ButtonSpec]]) -> usize {
    let (mut count, mut group) = (0, 0);
    while group < groups.len() {
        count += groups[group].len();
        group += 1;
    }
    count
}

/// The buttons of several groups in one list, `N` of them: their [`count`].
///
/// # Panics
/// If they are not `N`: in a constant at compile time.
#[must_use]
pub const fn buttons<const N: usize>(groups: &[&[ButtonSpec]]) -> [ButtonSpec; N] {
    let mut all = [PLAY; N];
    let (mut group, mut next) = (0, 0);
    while group < groups.len() {
        let mut index = 0;
        while index < groups[group].len() {
            all[next] = groups[group][index];
            next += 1;
            index += 1;
        }
        group += 1;
    }
    assert!(next == N, "another number of buttons");
    all
}

/// "What to try": a preset state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Name for [`crate::model::Model::press`]: `quarter-turn`.
    pub id: &'static str,
    /// The text on the button: `Start 60° off`.
    pub label: &'static str,
    /// The expected result.
    pub help: &'static str,
    /// Parameters to set; all others go back to their defaults.
    pub set: &'static [(&'static str, f64)],
    /// Buttons to press afterwards, such as `play`.
    pub then: &'static [&'static str],
}

/// Starts and pauses the playback; drawn as pressed while it plays.
pub const PLAY: ButtonSpec = ButtonSpec {
    id: "play",
    label: "Play",
    help: "Play the run from here, or pause it.",
};

/// Advances by one step of the timeline.
pub const STEP: ButtonSpec = ButtonSpec {
    id: "step",
    label: "Step",
    help: "Go one step forward.",
};

/// Returns to the start of the timeline; the other parameters do not change.
pub const RESET: ButtonSpec = ButtonSpec {
    id: "reset",
    label: "Reset",
    help: "Go back to the start of the run; the settings stay.",
};

/// Resets every parameter to its default.
pub const DEFAULTS: ButtonSpec = ButtonSpec {
    id: "defaults",
    label: "Defaults",
    help: "Reset every setting to its default.",
};
