//! The widget's words and its one list of parameters.

use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Steps at which a descent ends in any case.
pub const MOST_STEPS: usize = 40;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        id: "bias",
        label: "each edge turns too little by",
        unit: "°",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 10.0,
            step: 0.5,
        },
        default: 6.0,
        help: "How far odometry contradicts the loop: at 0 all measurements agree.",
    },
    ParamSpec {
        id: "wrong",
        label: "the wrong Jacobian is",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "twice",
                    label: "twice too long",
                },
                Choice {
                    id: "left",
                    label: "left for right",
                },
            ],
        },
        default: 0.0,
        help: "Twice the exact one, or that of a perturbation on the other side of the pose.",
    },
    ParamSpec {
        id: "scatter",
        label: "start thrown off by",
        unit: "m, rad",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 0.3,
            step: 0.05,
        },
        default: 0.2,
        help: "Standard deviation by which each pose is thrown off odometry before the first step.",
    },
    ParamSpec {
        id: "seed",
        label: "seed of the throw",
        unit: "",
        kind: ParamKind::SEED,
        default: 1.0,
        help: "Where the random numbers of the throw start.",
    },
    ParamSpec {
        id: "curve",
        label: "curves show",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "distance",
                    label: "distance to the optimum",
                },
                Choice {
                    id: "chi2",
                    label: "χ² above the optimum",
                },
            ],
        },
        default: 0.0,
        help: "How far the farthest pose is from its place at the optimum, or by how much χ² is above its minimum.",
    },
    ParamSpec {
        id: "steps",
        label: "steps done",
        unit: "",
        kind: ParamKind::Timeline {
            max: MOST_STEPS as f64,
        },
        default: MOST_STEPS as f64,
        help: "How many steps each solver has done; past its last one it rests.",
    },
    SPEED,
    MORE,
];

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.12",
    title: "Wrong Jacobians, wrong residual",
    misconception: "An approximate Jacobian costs steps, and where residuals remain moves the answer to second order. A wrong residual moves it to first order, and converges as if all were well.",
    notice: &[
        "With the exact Jacobian each step takes the distance down by some two powers of ten, until only rounding is left.",
        "The Jacobian that is twice too long goes half the way each time, and still ends at the optimum.",
        "The approximate one ends beside it by the square of the contradiction: a centimetre, where the wrong residual is two decimetres off.",
        "Without a contradiction all four end at the same place. A test on clean data does not find a wrong residual.",
    ],
    opening: Opening {
        panels: &["exact", "approximate", "jacobian", "residual", "curve"],
        params: &["bias"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "four",
            label: "Solve it in four ways",
            help: "Three end alike, after few steps or many; the wrong residual is among the quick ones, and ends elsewhere.",
            set: &[("steps", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "agree",
            label: "Let all measurements agree",
            help: "Nothing is left at the end, so nothing shows: even the wrong residual ends right.",
            set: &[("bias", 0.0), ("steps", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "left",
            label: "Left for right",
            help: "A Jacobian of the wrong side is right where nothing is left: it ends a millimetre or two beside the optimum.",
            set: &[("wrong", 1.0), ("steps", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "half",
            label: "Half the contradiction",
            help: "The wrong residual is off by half as much, the approximate Jacobian by a quarter.",
            set: &[("bias", 3.0), ("steps", 0.0)],
            then: &["play"],
        },
    ],
};
