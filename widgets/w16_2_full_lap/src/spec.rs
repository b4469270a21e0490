//! The widget's words and its one list of parameters.

use ch16_lab::lap;
use ch16_slam2d::chi_squared::CHAPTER_QUANTILE;
use kit::layers::{MORE, Opening};
use kit::param::{Choice, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::run::{LOOPS, NOISE, seed};
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Ticks of a lap.
pub const LAP_TICKS: f64 = lap::LAP_TICKS as f64;

/// Where the widget starts: the tick of the canonical run's first loop.
const FIRST_LOOP_TICK: f64 = 92.0;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
    NOISE,
    LOOPS,
    seed(lap::CANONICAL_SEED),
    ParamSpec {
        id: "gate",
        label: "gate quantile",
        unit: "",
        kind: ParamKind::Slider {
            min: 0.90,
            max: 0.999,
            step: 0.001,
        },
        default: CHAPTER_QUANTILE,
        help: "Share of right loops that the χ² gate lets pass, 3 degrees of freedom: 0.95 is χ² up to 7.815.",
    },
    ParamSpec {
        id: "gate-model",
        label: "drift in the gate",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "path",
                    label: "path",
                },
                Choice {
                    id: "exact",
                    label: "exact",
                },
            ],
        },
        default: 0.0,
        help: "Path: the chapter's, which grows with the number of nodes between the two ends. Exact: the covariance of their relative pose in the graph. An outline holds the positions that pass at the registered heading.",
    },
    ParamSpec {
        id: "matcher",
        label: "matcher",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "p2p",
                    label: "point to point",
                },
                Choice {
                    id: "p2l",
                    label: "point to plane",
                },
                Choice {
                    id: "ndt",
                    label: "NDT",
                },
            ],
        },
        default: 0.0,
        help: "What registers each sweep, in the front end and for loops: the chapter's ICP, point to point, or point to plane, or the normal distributions transform.",
    },
    ParamSpec {
        id: "information",
        label: "information",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "chapter",
                    label: "as the chapter's figures",
                },
                Choice {
                    id: "exact",
                    label: "at the edge's target",
                },
            ],
        },
        default: 0.0,
        help: "The frame in which an edge says what it is sure of. As the chapter's figures were computed, it is turned by a heading of the world; exactly, it stands at the edge's target, the newer of its ends.",
    },
    ParamSpec {
        id: "t",
        label: "tick",
        unit: "",
        kind: ParamKind::Timeline { max: LAP_TICKS },
        default: FIRST_LOOP_TICK,
        help: "The moment shown; a tick is a quarter of a second, and the marks are loops.",
    },
    ParamSpec {
        id: "future",
        label: "show what is to come",
        unit: "",
        kind: ParamKind::Switch,
        default: 0.0,
        help: "Draws the whole lap into the plots, also what comes after the moment shown.",
    },
    SPEED,
    MORE,
];

/// One tick before the loop.
const BEFORE: ButtonSpec = ButtonSpec {
    id: "before",
    label: "Before the loop",
    help: "One tick before the loop is tried.",
};

/// The tick of the loop, with its animation.
const AT: ButtonSpec = ButtonSpec {
    id: "at",
    label: "At the loop",
    help: "The tick of the loop: watch the history move.",
};

/// One tick after the loop.
const AFTER: ButtonSpec = ButtonSpec {
    id: "after",
    label: "After the loop",
    help: "One tick after the loop was tried.",
};

/// On to the next loop.
const NEXT: ButtonSpec = ButtonSpec {
    id: "next",
    label: "Next loop",
    help: "On to the next loop; after the last one, to the first.",
};

/// The buttons that go by the loops of the lap.
pub const LOOP_BUTTONS: [ButtonSpec; 4] = [BEFORE, AT, AFTER, NEXT];

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.2",
    title: "The full lap",
    misconception: "Closing a loop does not put the whole path right: it makes the map agree with itself.",
    notice: &[
        "The walls seen on the way out and on the way back stand apart, and one loop brings them together: the map's disagreement falls to about a third over the lap.",
        "The typical error over the keyframes hardly changes, and the largest even grows a little: the corridor comes out almost a metre too short, and no loop sees that.",
        "A loop moves poses that the robot left long ago. A filter that keeps only the newest pose could not.",
        "A small χ² alone does not pass: the sweep must also fit the old walls to 0.16 m, with at least 25 pairs.",
        "The exact gate adds up what the edges say of themselves, and knows the truth no better. Over seeds 1 to 50 at four times the noise the chapter's closes 78 loops, 3 of them wrong; the exact one closes 123, 7 of them wrong. Wrong is more than 0.3 m or 5° off the truth.",
    ],
    opening: Opening {
        panels: &["map", "loop"],
        params: &["loops"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, BEFORE, AT, AFTER, NEXT, DEFAULTS],
    presets: &[
        Preset {
            id: "first-loop",
            label: "Watch the first loop",
            help: "Node 29 recognises the corridor at node 7. The robot's own error falls, the error over all keyframes rises.",
            set: &[("t", FIRST_LOOP_TICK)],
            then: &["at"],
        },
        Preset {
            id: "rejected",
            label: "Seed 6: a loop is turned away",
            help: "The χ² is below the gate, but the sweep fits the old walls badly; four keyframes later a better match passes.",
            set: &[("seed", 6.0), ("t", 90.0)],
            then: &[],
        },
        Preset {
            id: "no-loops",
            label: "Switch the loops off",
            help: "The front end alone: the same sweeps, and a map whose two passes end 0.24 m apart instead of 0.08 m.",
            set: &[("loops", 0.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "noisy",
            label: "Four times the noise",
            help: "Odometry ends almost 5 m off, the front end holds, and the last loop closes in the last tick.",
            set: &[("noise", 4.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "tight-gate",
            label: "A tight gate on a noisy lap",
            help: "At the 0.90 quantile the gate turns away a loop that the chapter's gate accepts.",
            set: &[("noise", 4.0), ("gate", 0.90), ("t", 116.0)],
            then: &[],
        },
        Preset {
            id: "locked-out",
            label: "Right loops, locked out",
            help: "Seed 2 at three times the noise drifts more than the gate allows for: it turns away three right loops, and the drift goes on.",
            set: &[("seed", 2.0), ("noise", 3.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "let-in",
            label: "The same lap, exact gate",
            help: "The chapter's gate turns the first loop away by its heading alone. The edges are less sure of the heading: the exact gate lets all three loops in, and the lap ends more than a metre closer.",
            set: &[
                ("seed", 2.0),
                ("noise", 3.0),
                ("gate-model", 1.0),
                ("t", 94.0),
            ],
            then: &[],
        },
        Preset {
            id: "bells",
            label: "The same lap by NDT",
            help: "The same sweeps, matched to bells in place of points: the lap ends 0.04 m off instead of 0.24 m.",
            set: &[("matcher", 2.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "sliding",
            label: "The same lap by planes",
            help: "The same sweeps, each point free to slide along its wall: the lap ends 0.05 m off instead of 0.24 m.",
            set: &[("matcher", 1.0), ("t", LAP_TICKS)],
            then: &[],
        },
    ],
};
