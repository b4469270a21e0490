//! The parameters of one lap of the robot, alike in every widget that runs it.

use crate::param::{ParamKind, ParamSpec};

/// How noisy the wheels are.
pub const NOISE: ParamSpec = ParamSpec {
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
};

/// Whether loops are closed.
pub const LOOPS: ParamSpec = ParamSpec {
    id: "loops",
    label: "loop closure",
    unit: "",
    kind: ParamKind::Switch,
    default: 1.0,
    help: "Whether a keyframe near an old one is matched against it.",
};

/// Where the lap's random numbers start; the core knows the chapter's seed, and this half of the
/// project does not know the core.
#[must_use]
pub const fn seed(chapters: u32) -> ParamSpec {
    ParamSpec {
        id: "seed",
        label: "seed",
        unit: "",
        kind: ParamKind::SEED,
        default: chapters as f64,
        help: "Another seed is another lap with the same robot; the default is the chapter's.",
    }
}
