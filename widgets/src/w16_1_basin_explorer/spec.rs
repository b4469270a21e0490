//! The widget's texts and its list of parameters.

use ch16_lab::basin::BasinScene;
use ch16_lab::basin::{BasinPlace, OffsetAxis};
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

pub(super) use crate::icp_variant::VARIANT;

/// Largest offset of a start, m.
pub const OFFSET_SPAN_M: f64 = 1.5;

/// The Huber width at which every pair has full weight: no pair is longer than the largest τ.
pub const HUBER_OFF_M: f64 = 1.6;

/// Choices for the largest number of iterations of a registration: the chapter's, and one that no start of
/// the basin reaches.
pub const ITERATION_LIMITS: [usize; 2] = [BasinScene::MAX_ITERS, BasinScene::PATIENT_ITERS];

/// Computes the edge and compares it with the marks.
pub const SWEEP: ButtonSpec = ButtonSpec {
    id: "sweep",
    label: "Sweep the edge",
    help: "Register at every heading, working outwards from the truth, and compare the edge of the basin with your marks.",
};

/// The state of the question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Off.
    Off,
    /// The reader marks both edges; the maps are covered.
    Marking,
    /// The edges are computed, and everything is shown.
    Swept,
}

/// The reader's marks of the edge of the basin, for both errors.
pub(super) static EDGES: [Param<f64>; 2] = [
    edge("edge-p2p", "your edge, point-to-point"),
    edge("edge-p2l", "your edge, point-to-plane"),
];

const fn edge(id: &'static str, label: &'static str) -> Param<f64> {
    Param::slider(id, label, [0.0, 180.0], 1.0)
        .unit("°")
        .help("Your mark for the edge, on either side of the truth; 0 means no mark.")
}

const fn offset(id: &'static str, label: &'static str, default: f64) -> Param<f64> {
    Param::slider(id, label, [-OFFSET_SPAN_M, OFFSET_SPAN_M], 0.05)
        .unit("m")
        .default(default)
        .help("How far the first guess is from the truth.")
}

params! {
    pub(super) static HEADING: Param<f64> =
        Param::slider("heading", "heading error", [-180.0, 180.0], 1.0)
            .unit("°")
            .default(25.0)
            .help("How far the first guess is turned from the truth.");

    pub(super) static DX: Param<f64> = offset("dx", "Δx of the guess", 0.55);

    pub(super) static DY: Param<f64> = offset("dy", "Δy of the guess", 0.45);

    pub(super) static SCENE: OneOf<BasinPlace> = one_of!(
        BasinPlace,
        "scene",
        "scene",
        &[
            (BasinPlace::Room, "room", "room"),
            (BasinPlace::Fence, "fence", "picket fence"),
        ],
    )
    .help("What the two sweeps see: room A, which is almost square, or a row of equal posts 0.5 m apart.");

    use VARIANT;

    pub(super) static TAU: Param<f64> = Param::slider("tau", "pairing distance τ", [0.1, 1.6], 0.05)
        .unit("m")
        .default(0.7)
        .help("A point further than this from the target is unmatched.");

    pub(super) static LIMIT: OneOf<usize> = one_of!(
        usize,
        "limit",
        "iterations at most",
        &[
            (ITERATION_LIMITS[0], "30", "30"),
            (ITERATION_LIMITS[1], "200", "200"),
        ],
    )
    .help("After this many iterations a registration stops, converged or not.");

    pub(super) static TRIM: Param<f64> =
        Param::slider("trim", "share of pairs dropped", [0.0, 0.7], 0.05).help(
            "Trimming drops this share of the pairs in each iteration, longest first; 0 keeps them all.",
        );

    pub(super) static HUBER: Param<f64> =
        Param::slider("huber", "Huber width", [0.02, HUBER_OFF_M], 0.02)
            .unit("m")
            .default(HUBER_OFF_M)
            .help("Pairs longer than this have less weight; at 1.6 m, all pairs have equal weight.");

    pub(super) static AXIS: OneOf<OffsetAxis> = one_of!(
        OffsetAxis,
        "axis",
        "basin map shows heading and",
        &[
            (OffsetAxis::Dx, "dx", "Δx"),
            (OffsetAxis::Dy, "dy", "Δy"),
        ],
    )
    .help("The offset on the vertical axis of the basin maps; the other offset keeps the value of its slider.");

    pub(super) static PATHS: Param<bool> = Param::switch("paths", "paths of other starts")
        .help("Draws paths from starts all over the basin map, iteration by iteration.");

    pub(super) static EDGE: OneOf<Phase> = one_of!(
        Phase,
        "edge",
        "the basin's edge",
        &[
            (Phase::Off, "off", "off"),
            (Phase::Marking, "mark", "mark it yourself"),
            (Phase::Swept, "swept", "swept"),
        ],
    )
    .help("Asks how far a guess at the right position can be turned and still converge to the truth. The maps stay covered until you have marked it.");

    use EDGES[0];
    use EDGES[1];

    pub(super) static SEED: Param<u32> = Param::seed("seed of the sweeps", BasinScene::SEED)
        .help("Seed of the range noise in both sweeps; the chapter uses 457.");

    pub(super) static ITERATION: Param<f64> =
        Param::timeline("iteration", "iteration", ITERATION_LIMITS[1] as f64).help(
            "The iteration shown; 0 is the first guess, and values past the last iteration show the end.",
        );

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.1",
    name: "Basin explorer",
    title: "How far can you turn a sweep before it settles in a false minimum?",
    claim: "Only starts on the arc get home.",
    gesture: "Drag the sweep, then let it go.",
    awaits: Awaits::Rest,
    notice: &[
        "The room is almost square, so the quarter turn is a minimum as well, with an rmse of 0.13 m against 0.03 m at the truth. At the half turn, point-to-plane fits better than at the truth.",
        "Between the correct basin and the quarter turn, point-to-point settles on a third answer.",
        "A row of equal posts has a minimum at every spacing, which shows as bands on the map. No residual tells them apart.",
        "Point-to-plane needs fewer iterations. With no offset, its correct basin is also wider.",
        "The verdict uses the truth. A robot has only the rmse and the pairs, and a wrong pose can have the smaller rmse.",
        "A run that stops at its iteration limit has not reached a minimum. With 200 iterations, the correct basin is a little wider.",
    ],
    opening: Opening {
        panels: &["sweeps", "basin-point-to-point", "basin-point-to-plane"],
        params: &[],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, SWEEP, DEFAULTS],
    presets: &[
        Preset {
            id: "near",
            label: "Start 25° off",
            help: "Inside the correct basin, the sweeps come together.",
            set: &[ITERATION.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "quarter-turn",
            label: "Start 60° off",
            help: "The same room. ICP runs out of iterations on the way to the quarter turn.",
            set: &[HEADING.to(60.0), DX.to(0.0), DY.to(0.0), ITERATION.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "between",
            label: "Start 45° off",
            help: "From between the two basins, ICP finds neither the truth nor the quarter turn.",
            set: &[HEADING.to(45.0), DX.to(0.0), DY.to(0.0), ITERATION.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "between-plane",
            label: "45°, point-to-plane",
            help: "The same start with the other residual. Now ICP finds the truth.",
            set: &[
                HEADING.to(45.0),
                DX.to(0.0),
                DY.to(0.0),
                VARIANT.to("point-to-plane"),
                ITERATION.to(0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "half-turn",
            label: "Start upside down",
            help: "The half turn fits too, and better than the quarter turn.",
            set: &[HEADING.to(180.0), DX.to(0.0), DY.to(0.0), ITERATION.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "fence",
            label: "Face a picket fence",
            help: "Equal posts fit again after each spacing. The sweep settles one post off and fits as well as at the truth. Each post has its own band on the map.",
            set: &[
                SCENE.to("fence"),
                HEADING.to(0.0),
                DX.to(0.4),
                DY.to(0.0),
                ITERATION.to(0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "mark-edge",
            label: "Where is the edge?",
            help: "The maps are covered. Mark on each how far a guess can be turned and still converge to the truth, then sweep the edge.",
            set: &[
                HEADING.to(0.0),
                DX.to(0.0),
                DY.to(0.0),
                ITERATION.to(0.0),
                EDGE.to("mark"),
            ],
            then: &[],
        },
        Preset {
            id: "short-sighted",
            label: "Short-sighted τ",
            help: "With a τ of 0.2 m most points are unmatched, and the cloud barely moves.",
            set: &[TAU.to(0.2), ITERATION.to(0.0)],
            then: &["play"],
        },
    ],
};
