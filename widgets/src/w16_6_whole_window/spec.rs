//! The widget's texts and its list of parameters.

use ch16_lab::basin::BasinScene;
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, Param};
use widget_kit::params;
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Largest offset of a start, m.
pub const OFFSET_SPAN_M: f64 = 1.5;

/// An upper bound of the boxes of a search plus the iterations of ICP.
const MAX_STEPS: f64 = 200_000.0;

const fn offset(id: &'static str, label: &'static str) -> Param<f64> {
    Param::slider(id, label, [-OFFSET_SPAN_M, OFFSET_SPAN_M], 0.05)
        .unit("m")
        .help("How far the start, the centre of the window, is from the truth.")
}

/// The step button: one box.
const ONE_BOX: ButtonSpec = ButtonSpec {
    label: "One box",
    help: "Expand the most promising box: split it, or drop it.",
    ..STEP
};

params! {
    pub(super) static HEADING: Param<f64> = Param::slider(
        "heading",
        "heading error of the start",
        [-180.0, 180.0],
        1.0,
    )
    .unit("°")
    .default(75.0)
    .help("How far the start is turned from the truth. ICP depends on it; the search does not.");

    pub(super) static DX: Param<f64> = offset("dx", "Δx of the start");

    pub(super) static DY: Param<f64> = offset("dy", "Δy of the start");

    pub(super) static WINDOW: Param<f64> = Param::slider("window", "window ±", [0.5, 3.0], 0.25)
        .unit("m")
        .default(1.5)
        .help("How far from the start the search looks, along x and along y.");

    pub(super) static TURN: Param<f64> = Param::slider("turn", "headings ±", [30.0, 180.0], 15.0)
        .unit("°")
        .default(180.0)
        .help("How far from the start's heading the search looks; 180° covers every heading.");

    pub(super) static CELL: Param<f64> = Param::slider("cell", "cell", [0.05, 0.2], 0.01)
        .unit("m")
        .default(0.05)
        .help("The resolution of the search; the map is blurred accordingly.");

    pub(super) static SEED: Param<u32> = Param::seed("seed of the sweeps", BasinScene::SEED)
        .help("Seed of the range noise in both sweeps; the chapter uses 457.");

    pub(super) static PROGRESS: Param<f64> = Param::timeline("progress", "boxes expanded", MAX_STEPS)
        .help("How many boxes the search has expanded; ICP's iterations follow the last box.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.6",
    name: "The whole window",
    title: "Can every pose be searched without scoring every pose?",
    claim: "One bound rules out a whole box of poses.",
    gesture: "Turn the laser scan with the blue ring, then let it go.",
    awaits: Awaits::End,
    notice: &[
        "Each bar is a box of poses, and its height is a score that no pose in the box can exceed. Point at one to see the true scores of its poses, none of them higher. As boxes split, the bars fall towards them.",
        "ICP races from the same start. It finishes first, in whatever minimum it fell into.",
        "A box whose bound is below the best score so far is dropped unseen, and turns the colour of this text. The bound is never too low, so the search is exact.",
        "The half turn is the runner-up. The quarter turn, which traps ICP, is far behind, because the search counts the points that fit nowhere.",
        "The search is only as fine as its cells. ICP does the rest, from a start it can use.",
    ],
    opening: Opening {
        panels: &["sweeps"],
        params: &[],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, ONE_BOX, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "quarter-turn",
            label: "Start 75° off",
            help: "ICP alone falls into the quarter turn. The search finds the truth.",
            set: &[PROGRESS.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "upside-down",
            label: "Start upside down",
            help: "ICP alone stays upside down, and fits well. For the search, the half turn is only the runner-up.",
            set: &[HEADING.to(180.0), PROGRESS.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "wide",
            label: "Four times the window",
            help: "The window is ±3 m instead of ±1.5 m. It holds four times the poses, but the search does less than twice the work.",
            set: &[WINDOW.to(3.0), PROGRESS.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "without-home",
            label: "A window without the truth",
            help: "The search covers only ±60° around a start that is 75° off. The truth is outside the window, and the search reports that no place fits.",
            set: &[TURN.to(60.0), PROGRESS.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "coarse",
            label: "Coarse cells",
            help: "Cells of 0.2 m blur the room, and the quarter turn fits almost as well as the half turn.",
            set: &[CELL.to(0.2), PROGRESS.to(0.0)],
            then: &["play"],
        },
    ],
};
