//! The widget's words and its one list of parameters.

use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Largest share of the box, %.
pub const MOST_SHARE: f64 = 60.0;

/// Iterations at which a registration ends in any case.
pub const MOST_ITERATIONS: f64 = 30.0;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        id: "share",
        label: "points on the box",
        unit: "%",
        kind: ParamKind::Slider {
            min: 0.0,
            max: MOST_SHARE,
            step: 1.0,
        },
        default: 20.0,
        help: "Which share of the points of both sweeps lies on the box that was moved.",
    },
    ParamSpec {
        id: "moved",
        label: "box moved by",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 0.8,
            step: 0.05,
        },
        default: 0.3,
        help: "How far the box was moved between the sweeps, away from the sensor along x.",
    },
    ParamSpec {
        id: "dropped",
        label: "trimmed: pairs dropped",
        unit: "%",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 70.0,
            step: 5.0,
        },
        default: 25.0,
        help: "Which share of the pairs trimming drops in each iteration, the longest first.",
    },
    ParamSpec {
        id: "huber",
        label: "Huber width",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.01,
            max: 0.3,
            step: 0.01,
        },
        default: 0.05,
        help: "Pairs longer than this pull with the same force, however long they are.",
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
        help: "A point farther than this from the target has no pair: a gate is a kernel, too.",
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
        id: "seed",
        label: "seed of the sweeps",
        unit: "",
        kind: ParamKind::SEED,
        default: 1.0,
        help: "Where the range noise of the sweeps above starts; the curves go over their own hundred seeds.",
    },
    ParamSpec {
        id: "iteration",
        label: "iteration",
        unit: "",
        kind: ParamKind::Timeline {
            max: MOST_ITERATIONS,
        },
        default: MOST_ITERATIONS,
        help: "Which iteration is shown of all three; past its last one a registration rests.",
    },
    SPEED,
    MORE,
];

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.8",
    title: "The moving box",
    misconception: "Least squares has no majority: a few points that moved together pull the answer after \
                    them, and the rmse does not say so.",
    notice: &[
        "The walls do not quite meet where the box pulls. A few centimetres look like noise, and are none: they do not average out.",
        "Trimming drops the longest pairs, and the longest are mostly those of the box. It gives way last, and slowly.",
        "Huber's kernel never drops a pair. It holds a small box back; one with half of the points leads it farther away than plain.",
        "A short τ does the same work as trimming, until the start is farther off than τ.",
    ],
    opening: Opening {
        panels: &["plain", "trimmed", "huber", "bias"],
        params: &["share"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "fifth",
            label: "A fifth of the points",
            help: "The exercise: plain is pulled after the box, trimmed and Huber hardly.",
            set: &[("iteration", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "most",
            label: "More than trimming drops",
            help: "At half of the points the box has more pairs than a quarter: who degrades most gracefully?",
            set: &[("share", 50.0), ("iteration", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "none",
            label: "No box",
            help: "Without a box all three agree, and trimming has thrown good pairs away.",
            set: &[("share", 0.0), ("iteration", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "gate",
            label: "A short τ",
            help: "With τ of 0.2 m the box has few partners, and plain is as good as the others.",
            set: &[("tau", 0.2), ("iteration", 0.0)],
            then: &["play"],
        },
    ],
};
