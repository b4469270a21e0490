//! The widget's words and its one list of parameters.

use ch16_lab::basin::BasinScene;
use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Largest offset of a start, m.
pub const OFFSET_SPAN_M: f64 = 1.5;

/// The Huber width at which no pair is weighed down: no pair is longer than the largest τ.
pub const HUBER_OFF_M: f64 = 1.6;

/// Iterations at which a registration ends in any case.
pub const MAX_ITERS: f64 = BasinScene::MAX_ITERS as f64;

/// The parameters that hold the reader's marks of the edge: point to point, then point to plane.
pub const EDGES: [&str; 2] = ["edge-p2p", "edge-p2l"];

/// Sweeps the edge and compares it with the marks.
pub const SWEEP: ButtonSpec = ButtonSpec {
    id: "sweep",
    label: "Sweep the edge",
    help: "Register from every heading outwards from the truth, and compare the edge with your marks.",
};

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
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
        help: "How far the first guess is turned away from the truth.",
    },
    offset("dx", "Δx of the guess", 0.55),
    offset("dy", "Δy of the guess", 0.45),
    ParamSpec {
        id: "scene",
        label: "scene",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "room",
                    label: "room",
                },
                Choice {
                    id: "fence",
                    label: "picket fence",
                },
            ],
        },
        default: 0.0,
        help: "What the two sweeps see: room A, almost a square, or a row of equal posts 0.5 m apart.",
    },
    ParamSpec {
        id: "variant",
        label: "error that ICP reduces",
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
        help: "Distance between paired points, or distance along the wall's normal.",
    },
    ParamSpec {
        id: "tau",
        label: "pairing distance τ",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.1,
            max: 1.6,
            step: 0.05,
        },
        default: 0.7,
        help: "A point farther than this from the target has no pair.",
    },
    ParamSpec {
        id: "trim",
        label: "share of pairs dropped",
        unit: "",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 0.7,
            step: 0.05,
        },
        default: 0.0,
        help: "Trimming drops this share of the pairs in each iteration, the longest first; 0 keeps all.",
    },
    ParamSpec {
        id: "huber",
        label: "Huber width",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.02,
            max: HUBER_OFF_M,
            step: 0.02,
        },
        default: HUBER_OFF_M,
        help: "Longer pairs pull less; at 1.6 m all pairs pull alike.",
    },
    ParamSpec {
        id: "axis",
        label: "basin map shows heading and",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "dx",
                    label: "Δx",
                },
                Choice {
                    id: "dy",
                    label: "Δy",
                },
            ],
        },
        default: 0.0,
        help: "The vertical axis of the basin maps; the other offset comes from its slider.",
    },
    ParamSpec {
        id: "paths",
        label: "ways of other starts",
        unit: "",
        kind: ParamKind::Switch,
        default: 0.0,
        help: "Draws over the basin map which way starts all over it go, iteration by iteration.",
    },
    ParamSpec {
        id: "edge",
        label: "the basin's edge",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "off",
                    label: "is not asked for",
                },
                Choice {
                    id: "mark",
                    label: "is for you to mark",
                },
                Choice {
                    id: "swept",
                    label: "is swept",
                },
            ],
        },
        default: 0.0,
        help: "Asks from how far a guess at the right place may be turned and still comes home; while you mark it, the maps are covered.",
    },
    edge(EDGES[0], "your edge, point to point"),
    edge(EDGES[1], "your edge, point to plane"),
    ParamSpec {
        id: "seed",
        label: "seed of the sweeps",
        unit: "",
        kind: ParamKind::SEED,
        default: BasinScene::SEED as f64,
        help: "Where the range noise of both sweeps starts; 457 is the chapter's.",
    },
    ParamSpec {
        id: "iteration",
        label: "iteration",
        unit: "",
        kind: ParamKind::Timeline { max: MAX_ITERS },
        default: 0.0,
        help: "Which iteration is shown; 0 is the first guess, and past the last one is the end.",
    },
    SPEED,
    MORE,
];

const fn edge(id: &'static str, label: &'static str) -> ParamSpec {
    ParamSpec {
        id,
        label,
        unit: "°",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 180.0,
            step: 1.0,
        },
        default: 0.0,
        help: "Your mark of the edge, to either side of the truth; 0 is none.",
    }
}

const fn offset(id: &'static str, label: &'static str, default: f64) -> ParamSpec {
    ParamSpec {
        id,
        label,
        unit: "m",
        kind: ParamKind::Slider {
            min: -OFFSET_SPAN_M,
            max: OFFSET_SPAN_M,
            step: 0.05,
        },
        default,
        help: "How far the first guess is moved away from the truth.",
    }
}

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.1",
    title: "Basin explorer",
    misconception: "A small residual proves nothing: registration ends in the minimum whose basin \
                    it starts in, and a false one can fit almost as well as the right one.",
    notice: &[
        "The room is almost square, so a quarter turn fits too: rmse 0.13 m there, 0.03 m at the truth.",
        "Between the right basin and the quarter turn, point to point settles on a third answer.",
        "A row of equal posts has a minimum at each spacing: bands on the map, and no residual tells them apart.",
        "Point to plane needs fewer iterations, and its right basin is wider with no offset.",
        "The verdict uses the truth. A robot has only rmse and pairs, and both look fine when it is wrong.",
    ],
    opening: Opening {
        panels: &["sweeps", "basin-point-to-point", "basin-point-to-plane"],
        params: &["heading"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, SWEEP, DEFAULTS],
    presets: &[
        Preset {
            id: "near",
            label: "Start 25° off",
            help: "Inside the right basin: the sweeps come together.",
            set: &[("iteration", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "quarter-turn",
            label: "Start 60° off",
            help: "The same room: on its way to the quarter turn its iterations run out.",
            set: &[
                ("heading", 60.0),
                ("dx", 0.0),
                ("dy", 0.0),
                ("iteration", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "between",
            label: "Start 45° off",
            help: "Between the two basins: neither the truth nor the quarter turn.",
            set: &[
                ("heading", 45.0),
                ("dx", 0.0),
                ("dy", 0.0),
                ("iteration", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "between-plane",
            label: "45°, point to plane",
            help: "The same start with the other error: now it finds the truth.",
            set: &[
                ("heading", 45.0),
                ("dx", 0.0),
                ("dy", 0.0),
                ("variant", 1.0),
                ("iteration", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "half-turn",
            label: "Start upside down",
            help: "Half a turn fits as well, and better than the quarter turn.",
            set: &[
                ("heading", 180.0),
                ("dx", 0.0),
                ("dy", 0.0),
                ("iteration", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "fence",
            label: "Stand before a picket fence",
            help: "Equal posts fit again after each spacing: it settles one post off, and fits as well as at home. The map has a band for each.",
            set: &[
                ("scene", 1.0),
                ("heading", 0.0),
                ("dx", 0.4),
                ("dy", 0.0),
                ("iteration", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "mark-edge",
            label: "Where is the edge?",
            help: "The maps are covered: mark on each how far a guess may be turned and still comes home, then sweep the edge.",
            set: &[
                ("heading", 0.0),
                ("dx", 0.0),
                ("dy", 0.0),
                ("iteration", 0.0),
                ("edge", 1.0),
            ],
            then: &[],
        },
        Preset {
            id: "short-sighted",
            label: "Short-sighted τ",
            help: "With τ of 0.2 m most points find no pair, and the cloud hardly moves.",
            set: &[("tau", 0.2), ("iteration", 0.0)],
            then: &["play"],
        },
    ],
};
