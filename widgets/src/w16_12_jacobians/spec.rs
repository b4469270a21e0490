//! The widget's texts and its list of parameters.

use ch16_lab::jacobians::WrongJacobian;
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Largest number of steps.
pub const MAX_STEPS: usize = 40;

/// Largest contradiction of an edge, °.
pub const MAX_BIAS_DEG: f64 = 10.0;

/// Least contradiction of an edge, °: without one all solvers agree, and there is nothing to see.
pub const LEAST_BIAS_DEG: f64 = 2.0;

/// Step of the contradiction, °.
pub const BIAS_STEP_DEG: f64 = 0.5;

/// The quantity of the curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// Largest distance of a pose from its optimum.
    Distance,
    /// Difference of χ² from its minimum.
    Chi2,
}

params! {
    pub(super) static BIAS: Param<f64> = Param::slider(
        "bias",
        "missing rotation per edge",
        [LEAST_BIAS_DEG, MAX_BIAS_DEG],
        BIAS_STEP_DEG,
    )
    .unit("°")
    .default(6.0)
    .help("How far odometry contradicts the loop: the rotation missing from each edge.");

    pub(super) static WRONG: OneOf<WrongJacobian> = one_of!(
        WrongJacobian,
        "wrong",
        "the wrong Jacobian is",
        &[
            (WrongJacobian::TwiceTooLong, "twice", "twice as long"),
            (WrongJacobian::LeftForRight, "left", "left for right"),
        ],
    )
    .help("Twice the exact Jacobian, or the Jacobian of a perturbation on the other side of the pose.");

    pub(super) static SCATTER: Param<f64> =
        Param::slider("scatter", "start scattered by", [0.0, 0.3], 0.05)
            .unit("m, rad")
            .default(0.2)
            .help("Standard deviation of the noise added to each pose before the first step.");

    pub(super) static SEED: Param<u32> =
        Param::seed("seed of the scatter", 1).help("Seed of the noise added to each pose.");

    pub(super) static CURVE: OneOf<Curve> = one_of!(
        Curve,
        "curve",
        "curves show",
        &[
            (Curve::Distance, "distance", "distance to the optimum"),
            (Curve::Chi2, "chi2", "χ² above the optimum"),
        ],
    )
    .help("The largest distance of any pose from its optimum, or how far χ² is above its minimum.");

    pub(super) static STEPS: Param<f64> = Param::timeline("steps", "steps done", MAX_STEPS as f64)
        .help("How many steps each solver has taken; one that stops early has converged.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.12",
    name: "One graph, solved in four ways",
    title: "A solver has stopped: is this the minimum of χ²?",
    claim: "Converged does not mean minimum.",
    gesture: "Drag the loose end, then let it go.",
    awaits: Awaits::Rest,
    notice: &[
        "With the exact Jacobian each step cuts the distance by about two powers of ten, until only rounding is left.",
        "With a Jacobian twice as long as it should be, each step goes only halfway. It still ends at the optimum.",
        "With the approximate Jacobian, the error grows with the square of the contradiction. The solver ends a centimetre out; with the wrong residual, it ends 19 cm out.",
        "The less the measurements contradict each other, the closer to the optimum the wrong residual ends. A test on clean data does not find the mistake.",
    ],
    opening: Opening {
        panels: &["graphs"],
        params: &[],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "four",
            label: "Solve it in four ways",
            help: "All four start from the same poses and advance step by step. Watch where each one ends.",
            set: &[],
            then: &["play"],
        },
        Preset {
            id: "left",
            label: "Left for right",
            help: "A Jacobian for the wrong side is correct only where the residual is zero. The solver ends a millimetre or two from the optimum.",
            set: &[WRONG.to("left")],
            then: &["play"],
        },
        Preset {
            id: "half",
            label: "Half the contradiction",
            help: "The wrong residual ends half as far out, and the approximate Jacobian a quarter as far out.",
            set: &[BIAS.to(3.0)],
            then: &["play"],
        },
    ],
};
