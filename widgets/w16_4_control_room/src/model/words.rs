//! What the widget says of itself: its words, parameters, buttons and presets.

use ch16_slam2d::slam::CANONICAL_SEED;
use kit::param::{ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// The longest run that a link may point into; a lap of the Apartment takes 129 ticks.
const MAX_TICKS: f64 = 2000.0;

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        id: "noise",
        label: "odometry noise ×",
        unit: "",
        kind: ParamKind::Slider {
            min: 0.25,
            max: 4.0,
            step: 0.05,
        },
        default: 1.0,
        help: "Multiplies the variances of the wheel odometry: 1 is the chapter's robot.",
    },
    ParamSpec {
        id: "loops",
        label: "loop closure",
        unit: "",
        kind: ParamKind::Switch,
        default: 1.0,
        help: "Whether the back end looks for loops.",
    },
    ParamSpec {
        id: "seed",
        label: "seed",
        unit: "",
        kind: ParamKind::SEED,
        default: CANONICAL_SEED as f64,
        help: "Another seed is another lap with the same robot; 12648430 is the chapter's.",
    },
    ParamSpec {
        id: "t",
        label: "tick",
        unit: "",
        kind: ParamKind::Timeline { max: MAX_TICKS },
        default: 60.0,
        help: "The moment shown; a tick is a quarter of a second, and the marks are loops.",
    },
    SPEED,
];

/// On to the next event of the log.
pub const NEXT_EVENT: ButtonSpec = ButtonSpec {
    id: "next-event",
    label: "Next event",
    help: "On to the next keyframe, loop test or way point; after the last one, to the first.",
};

/// Everything about the widget that never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.4",
    title: "Control room",
    misconception: "A SLAM system is not one algorithm that runs: a fast front end and a slow back end pass poses and constraints to each other, and the map is only drawn from them.",
    notice: &[
        "The front end works at every tick: it predicts by odometry and corrects by one registration. The threshold τ follows how wrong the predictions were.",
        "The back end works only at keyframes, and its big moment is a loop: then old poses move.",
        "The grid stores no poses. After an accepted loop it is thrown away and drawn again from every keyframe's sweep.",
        "Walls blur where two passes disagree, and sharpen when a loop brings them together.",
    ],
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, NEXT_EVENT, DEFAULTS],
    presets: &[
        Preset {
            id: "watch",
            label: "Watch the whole run",
            help: "From the first sweep to the last loop.",
            set: &[("t", 0.0)],
            then: &["play"],
        },
        Preset {
            id: "blurred",
            label: "Just before the first loop",
            help: "The corridor has been mapped twice, and the two passes do not agree.",
            set: &[("t", 91.0)],
            then: &[],
        },
        Preset {
            id: "rebuilt",
            label: "The grid drawn again",
            help: "One loop later the same sweeps give sharper walls.",
            set: &[("t", 92.0)],
            then: &[],
        },
        Preset {
            id: "noisy",
            label: "Four times the noise",
            help: "The threshold τ opens up: predictions are worse, so pairs are looked for farther away.",
            set: &[("noise", 4.0), ("t", 60.0)],
            then: &[],
        },
        Preset {
            id: "open",
            label: "No back end",
            help: "Without loops nothing ever moves a pose again, and the walls stay double.",
            set: &[("loops", 0.0), ("t", 129.0)],
            then: &[],
        },
    ],
};
