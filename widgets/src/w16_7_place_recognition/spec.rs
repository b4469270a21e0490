//! The widget's texts and its list of parameters.

use ch16_lab::lap::CANONICAL_SEED;
use ch16_lab::lap::{BuiltInWorld, NamedChoice as _};
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::run;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// An upper bound of the keyframes of a lap.
pub const MAX_KEYFRAMES: f64 = 400.0;

/// The last keyframe that can be selected for comparison: a lap of the ring has about a hundred.
pub const LAST_OLD: f64 = 120.0;

/// Width of a sector of Scan Context.
pub const SECTOR_DEG: f64 = 6.0;

/// The value of `old` that selects the most similar keyframe.
pub const MOST_ALIKE: f64 = -1.0;

/// The step button: one keyframe.
const ONE_KEYFRAME: ButtonSpec = ButtonSpec {
    label: "Next keyframe",
    help: "Drive to the next keyframe and compare it with all older ones.",
    ..STEP
};

params! {
    pub(super) static CALLED: Param<f64> = Param::slider(
        "called",
        "pairs called the same place",
        [0.0, 60.0],
        1.0,
    )
    .unit("%")
    .default(15.0)
    .help(
        "The share of pairs, most similar first, that are called the same place: one threshold for every detector.",
    );

    pub(super) static DETECTOR: OneOf<usize> = one_of!(
        usize,
        "detector",
        "compared by",
        &[
            (0, "nearby", "nearness"),
            (1, "histogram", "ranges"),
            (2, "context", "Scan Context"),
        ],
    )
    .default("context")
    .help("What the detector compares: estimated poses, range histograms, or rings and sectors.");

    pub(super) static WORLD: OneOf<BuiltInWorld> = one_of!(
        BuiltInWorld,
        "world",
        "world",
        BuiltInWorld::NAMED.split_at(2).0,
    )
    .help("The world in which the lap is driven.");

    pub(super) static OLDER: Param<f64> = Param::slider(
        "old",
        "older keyframe of the pair",
        [MOST_ALIKE, LAST_OLD],
        1.0,
    )
    .default(18.0)
    .help("The older keyframe compared with the newest one; −1 selects the most similar one.");

    pub(super) static TURN: Param<f64> = Param::slider(
        "turn",
        "turned away from the best fit",
        [-180.0, 180.0],
        SECTOR_DEG,
    )
    .unit("°")
    .help("How far the newer view is turned from the heading at which Scan Context fits best.");

    pub(super) static SEED: Param<u32> = run::seed(CANONICAL_SEED);

    use run::NOISE;

    pub(super) static NEWEST: Param<f64> = Param::timeline("new", "keyframe", MAX_KEYFRAMES)
        .default(MAX_KEYFRAMES)
        .help("The newest keyframe so far; values past the last keyframe show the whole lap.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.7",
    name: "Have I been here?",
    title: "Do look-alike views show the same place?",
    claim: "Places that look alike may be different.",
    gesture: "Drag the line in the plot.",
    awaits: Awaits::Rest,
    notice: &[
        "Each dot is a pair of places. Pairs left of the line are called the same place, rightly or wrongly.",
        "In the matrix, dark means alike. The stripe down to the right is the return leg, which revisits the places in reverse order.",
        "In the corridor all histograms look alike, because a range has no direction.",
        "Scan Context keeps directions. Slide one view over the other: they differ least at the rotation between them.",
        "A looser threshold finds more true pairs but also admits more false ones. No point on the curve comes free.",
    ],
    opening: Opening {
        panels: &["flat", "scores"],
        params: &[],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, ONE_KEYFRAME, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "lap",
            label: "Drive the lap",
            help: "Each new keyframe is compared with all older ones, which adds a column to the matrix.",
            set: &[OLDER.to(MOST_ALIKE), NEWEST.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "ring",
            label: "A ring of corridors",
            help: "Four corridors look alike, and each is a trap for the others.",
            set: &[WORLD.to("ring"), OLDER.to(MOST_ALIKE)],
            then: &[],
        },
    ],
};
