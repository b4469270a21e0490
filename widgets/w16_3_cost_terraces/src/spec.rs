//! The widget's words and its one list of parameters.

use ch16_lab::terrain::TerrainScene;
use kit::layers::{MORE, Opening};
use kit::param::{Choice, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// The maps reach this far from the truth in every direction, m.
pub const HALF_SPAN_M: f64 = 1.3;

/// Fewest and most cells a side; both odd, so that one cell lies on the truth.
const CELLS: (f64, f64) = (49.0, 161.0);

/// Most steps that a ball may take; the timeline never gets longer.
pub const MAX_BALL_STEPS: usize = 400;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
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
                    id: "corridor",
                    label: "corridor",
                },
            ],
        },
        default: 0.0,
        help: "Where the sweep was taken: in room A, or in the corridor.",
    },
    ParamSpec {
        id: "tau",
        label: "pair limit τ",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.1,
            max: 1.6,
            step: 0.05,
        },
        default: 0.6,
        help: "ICP pairs a point with the nearest map point within τ; a point without a pair costs τ².",
    },
    ParamSpec {
        id: "ndt-cell",
        label: "NDT cell",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.3,
            max: 1.2,
            step: 0.05,
        },
        default: TerrainScene::DEFAULT_NDT_CELL_M,
        help: "NDT fits one Gaussian to the map points of each cell of this width.",
    },
    ParamSpec {
        id: "heading",
        label: "heading offset",
        unit: "°",
        kind: ParamKind::Slider {
            min: -180.0,
            max: 180.0,
            step: 1.0,
        },
        default: 0.0,
        help: "The sweep is turned by this much about the sensor before it is shifted.",
    },
    ParamSpec {
        id: "cells",
        label: "cells a side",
        unit: "",
        kind: ParamKind::Slider {
            min: CELLS.0,
            max: CELLS.1,
            step: 8.0,
        },
        default: 49.0,
        help: "Both maps are sampled at this many shifts along each axis.",
    },
    ParamSpec {
        id: "colours",
        label: "colours",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "value",
                    label: "by value",
                },
                Choice {
                    id: "rank",
                    label: "by rank",
                },
            ],
        },
        default: 0.0,
        help: "By rank, every colour covers as many cells: low steps show on high ground.",
    },
    ParamSpec {
        id: "seed",
        label: "seed of the sweep",
        unit: "",
        kind: ParamKind::SEED,
        default: TerrainScene::SEED as f64,
        help: "Where the range noise of the sweep starts; 1472 is the chapter's.",
    },
    ParamSpec {
        id: "probe-x",
        label: "drop at Δx",
        unit: "m",
        kind: ParamKind::Slider {
            min: -HALF_SPAN_M,
            max: HALF_SPAN_M,
            step: 0.05,
        },
        default: 0.3,
        help: "Where the cross hair stands and the balls start, east of the truth.",
    },
    ParamSpec {
        id: "probe-y",
        label: "drop at Δy",
        unit: "m",
        kind: ParamKind::Slider {
            min: -HALF_SPAN_M,
            max: HALF_SPAN_M,
            step: 0.05,
        },
        default: 0.3,
        help: "Where the cross hair stands and the balls start, north of the truth.",
    },
    ParamSpec {
        id: "t",
        label: "step of the balls",
        unit: "",
        kind: ParamKind::Timeline {
            max: MAX_BALL_STEPS as f64,
        },
        // Past the last step means the end: the balls lie where they rest.
        default: MAX_BALL_STEPS as f64,
        help: "How many gradient steps both balls have taken.",
    },
    SPEED,
    MORE,
];

/// Drops both balls from the cross hair.
const DROP: ButtonSpec = ButtonSpec {
    id: "drop",
    label: "Drop a ball",
    help: "Start both balls at the cross hair and let them descend.",
};

/// "What to try".
const PRESETS: &[Preset] = &[
    Preset {
        id: "terraces",
        label: "Shrink τ to 0.15 m",
        help: "ICP's bowl breaks into steps, and its ball stops on one. NDT's ball rolls home.",
        set: &[
            ("tau", 0.15),
            ("colours", 1.0),
            ("probe-x", 0.3),
            ("probe-y", -0.3),
        ],
        then: &["drop"],
    },
    Preset {
        id: "wide-hill",
        label: "Widen the NDT cell to 0.8 m",
        help: "NDT's ball comes home from where ICP's rolls farther away.",
        set: &[("ndt-cell", 0.8), ("probe-x", -0.7), ("probe-y", 0.7)],
        then: &["drop"],
    },
    Preset {
        id: "wide-tau",
        label: "Widen τ to 1.6 m",
        help: "No point is without a pair now. ICP's ball comes home from here, NDT's does not.",
        set: &[("tau", 1.6), ("probe-x", 0.7), ("probe-y", 0.7)],
        then: &["drop"],
    },
    Preset {
        id: "corridor",
        label: "Stand in the corridor",
        help: "Both valleys run along the walls. The ellipse is a needle along x: there the walls say almost nothing.",
        set: &[("scene", 1.0), ("probe-x", 0.6), ("probe-y", 0.0)],
        then: &["drop"],
    },
    Preset {
        id: "wrong-wall",
        label: "Drop it across the corridor",
        help: "From here the south wall looks like the north wall. Both balls settle on the wrong one.",
        set: &[("scene", 1.0), ("probe-x", 0.2), ("probe-y", 1.1)],
        then: &["drop"],
    },
    Preset {
        id: "turned",
        label: "Turn the sweep by 20°",
        help: "No shift undoes a turn. The lowest cost rises, and NDT's lowest cell leaves the truth.",
        set: &[("heading", 20.0)],
        then: &["drop"],
    },
];

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.3",
    title: "Cost terraces",
    misconception: "Where ICP sticks, a better solver would stick too: the terraces are in the cost.",
    notice: &[
        "Both maps hold the same sweep against the same points; only the measure differs. Dark is low, and the balls seek the dark.",
        "A small τ breaks ICP's bowl into terraces and hollows; colours by rank show them. A ball rests in the next one, however good the solver.",
        "NDT has almost no steps: each point feels the whole bell of its cell. But thin walls make thin bells. Its valley is narrow, and the plain around it has dents of its own; wider cells help.",
        "A wide τ lets ICP reach farther than NDT. Neither measure wins everywhere.",
        "In the corridor both valleys run along x. The ellipse shows why: it is a needle along x, where the walls say almost nothing.",
    ],
    opening: Opening {
        panels: &["icp", "ndt"],
        params: &["tau"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[DROP, PLAY, STEP, RESET, DEFAULTS],
    presets: PRESETS,
};
