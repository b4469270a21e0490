//! The widget's words and its one list of parameters.

use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Pairs of the largest scene.
pub const MOST_PAIRS: usize = 5;

/// A point of the target is dragged at most so far, m.
pub const REACH_M: f64 = 3.0;

/// A whole turn, °.
pub const WHOLE_TURN_DEG: f64 = 360.0;

/// The parameters that move the points of the target: along x and along y.
pub const MOVED: [[&str; 2]; MOST_PAIRS] = [
    ["x1", "y1"],
    ["x2", "y2"],
    ["x3", "y3"],
    ["x4", "y4"],
    ["x5", "y5"],
];

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        id: "shape",
        label: "what is seen twice",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "corners",
                    label: "four corners",
                },
                Choice {
                    id: "two",
                    label: "two points",
                },
                Choice {
                    id: "wall",
                    label: "a bare wall",
                },
                Choice {
                    id: "upside-down",
                    label: "corners, upside down",
                },
            ],
        },
        default: 0.0,
        help: "Points of two sweeps in pairs; the last is what a sensor sees that hangs upside down the second time.",
    },
    ParamSpec {
        id: "tried",
        label: "matrices tried",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "turns",
                    label: "turns",
                },
                Choice {
                    id: "mirrors",
                    label: "mirror images",
                },
            ],
        },
        default: 0.0,
        help: "The source is moved by turns, or mirrored first and turned then: together these are all orthogonal matrices.",
    },
    ParamSpec {
        id: "seed",
        label: "seed of the noise",
        unit: "",
        kind: ParamKind::SEED,
        default: 1.0,
        help: "Where the range noise of both sweeps starts, 12 mm along each axis.",
    },
    moved("x1", "target 1: moved in x"),
    moved("y1", "target 1: moved in y"),
    moved("x2", "target 2: moved in x"),
    moved("y2", "target 2: moved in y"),
    moved("x3", "target 3: moved in x"),
    moved("y3", "target 3: moved in y"),
    moved("x4", "target 4: moved in x"),
    moved("y4", "target 4: moved in y"),
    moved("x5", "target 5: moved in x"),
    moved("y5", "target 5: moved in y"),
    ParamSpec {
        id: "turn",
        label: "angle tried",
        unit: "°",
        kind: ParamKind::Timeline {
            max: WHOLE_TURN_DEG,
        },
        default: 0.0,
        help: "By how much the source is turned, after the mirror where there is one.",
    },
    SPEED,
    MORE,
];

const fn moved(id: &'static str, label: &'static str) -> ParamSpec {
    ParamSpec {
        id,
        label,
        unit: "m",
        kind: ParamKind::Slider {
            min: -REACH_M,
            max: REACH_M,
            step: 0.05,
        },
        default: 0.0,
        help: "How far the point is dragged from where it was seen; only points of the scene count.",
    }
}

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.11",
    title: "Turn or mirror image",
    misconception: "A decomposition knows nothing of left and right: the best orthogonal matrix may be a mirror image, and no robot moves like that.",
    notice: &[
        "Over a whole turn the trace is one sinusoid: it has one top, and the alignment knows its place in closed form.",
        "Mirror images have a sinusoid of their own. The higher top of the two is the sum of the singular values, and nothing passes it.",
        "On two points, and on a straight line, both tops are equally high. Along a bare wall noise decides between them.",
        "A mirrored map fits its points as well as any. It has its doors on the wrong side.",
    ],
    opening: Opening {
        panels: &["points", "trace", "map-turn", "map-unchecked"],
        params: &["shape"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "corners",
            label: "Turn four corners",
            help: "The trace climbs to its bound at one angle, and falls again: the mirror images stay far below.",
            set: &[],
            then: &["play"],
        },
        Preset {
            id: "two-points",
            label: "Two points only",
            help: "Turn and mirror image reach the same bound: two points cannot tell left from right.",
            set: &[("shape", 1.0)],
            then: &["play"],
        },
        Preset {
            id: "bare-wall",
            label: "A bare wall",
            help: "The wall fixes the line, and noise decides the side: here the mirror image fits a little better.",
            set: &[("shape", 2.0), ("seed", 2.0), ("tried", 1.0)],
            then: &["play"],
        },
        Preset {
            id: "upside-down",
            label: "Hang the sensor upside down",
            help: "A mirror image fits without a rest, and hides the mistake. The best turn leaves a cost that shows it.",
            set: &[("shape", 3.0), ("tried", 1.0)],
            then: &["play"],
        },
    ],
};
