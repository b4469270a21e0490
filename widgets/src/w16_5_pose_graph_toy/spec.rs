//! The widget's texts and its list of parameters.

use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Poses of the largest graph.
pub const MAX_POSES: usize = 6;

/// Largest displacement of a pose from odometry, m.
pub const REACH_M: f64 = 3.0;

/// Largest number of solver steps.
pub const MAX_STEPS: usize = 20;

/// By how much the loop of the chapter's three poses exceeds odometry, m.
const CHAPTER_GAP_M: f64 = 0.6;

/// The shape of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphShape {
    /// The chapter's three poses on a line.
    Line,
    /// Four poses around a square.
    Square,
    /// Six poses around a ring.
    Ring,
}

/// The parameters that move a pose: along x, along y, and its heading.
macro_rules! pose {
    ($number:literal) => {
        [
            along(
                concat!("x", $number),
                concat!("pose ", $number, ": moved in x"),
            ),
            along(
                concat!("y", $number),
                concat!("pose ", $number, ": moved in y"),
            ),
            turn(
                concat!("turn", $number),
                concat!("pose ", $number, ": turned"),
            ),
        ]
    };
}

/// The parameters of each pose.
pub(super) static MOVED: [[Param<f64>; 3]; MAX_POSES] =
    [pose!(1), pose!(2), pose!(3), pose!(4), pose!(5), pose!(6)];

/// Their names in order.
pub(super) const MOVED_IDS: [&str; 3 * MAX_POSES] = {
    let mut ids = [""; 3 * MAX_POSES];
    let mut k = 0;
    while k < ids.len() {
        ids[k] = MOVED[k / 3][k % 3].spec.id;
        k += 1;
    }
    ids
};

const fn along(id: &'static str, label: &'static str) -> Param<f64> {
    Param::slider(id, label, [-REACH_M, REACH_M], 0.05)
        .unit("m")
        .help("How far the pose is moved from its odometry position before the first step.")
}

const fn turn(id: &'static str, label: &'static str) -> Param<f64> {
    Param::slider(id, label, [-180.0, 180.0], 1.0)
        .unit("°")
        .help("How far the pose is turned from its odometry heading before the first step.")
}

/// The step button: one iteration of the solver.
const ONE_STEP: ButtonSpec = ButtonSpec {
    label: "One step",
    help: "One Gauss–Newton step: every pose moves at once.",
    ..STEP
};

params! {
    pub(super) static STIFFNESS: Param<f64> = Param::slider(
        "stiffness",
        "stiffness of the loop",
        [0.1, 10.0],
        0.1,
    )
    .unit("×")
    .default(1.0)
    .help(
        "The information of the loop. A stiffer spring gives way less.",
    );

    pub(super) static GRAPH: OneOf<GraphShape> = one_of!(
        GraphShape,
        "graph",
        "graph",
        &[
            (GraphShape::Line, "line", "three poses"),
            (GraphShape::Square, "square", "a square"),
            (GraphShape::Ring, "ring", "a ring of six"),
        ],
    )
    .default("ring")
    .help("The chapter's three poses on a line, four around a square, or a ring of six whose ends do not meet.");

    pub(super) static GAP: Param<f64> = Param::slider(
        "gap",
        "the loop disagrees by",
        [-1.5, 1.5],
        0.05,
    )
    .unit("m")
    .default(CHAPTER_GAP_M)
    .help("How much further ahead the loop puts the last pose, seen from the first, than odometry does.");

    pub(super) static ODOMETRY: Param<f64> =
        Param::slider("odometry", "stiffness of odometry", [0.1, 10.0], 0.1)
            .unit("×")
            .default(1.0)
            .help("The information of each odometry edge.");

    pub(super) static PINNED: Param<bool> = Param::switch("pinned", "pin the first pose")
        .on()
        .help("Measurements are relative. Unless a pose is fixed, the whole graph can be anywhere.");

    use MOVED[0 1 2 3 4 5][0 1 2];

    pub(super) static STEPS: Param<f64> = Param::timeline("steps", "steps done", MAX_STEPS as f64)
        .help("How many steps the solver has taken; 0 is the graph before the first step.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.5",
    name: "Pose-graph toy",
    title: "Which measurement gives way when the springs disagree?",
    claim: "Each measurement gives way a little.",
    gesture: "Drag a pose, and let it go.",
    awaits: Awaits::Nothing,
    notice: &[
        "Each edge is a spring, at rest when its measurement is met. The dotted line shows how far it is from rest, and the number shows the cost.",
        "Pull a pose and let go. Each beat is one Gauss–Newton step. A stiffer loop has a thicker, tighter spring.",
        "On a line the problem is linear, and one step from anywhere is enough. Headings make it nonlinear, so it takes a few steps.",
        "The disagreement does not vanish. The springs share it, and a stiff one takes less.",
        "Without a pin the whole graph floats, because χ² depends only on differences.",
    ],
    opening: Opening {
        panels: &["graph", "bars"],
        params: &[],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, ONE_STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "three-poses",
            label: "The chapter's three poses",
            help: "One step takes χ² from 0.36 to 0.12. Each of the three edges gives way by 0.2 m.",
            set: &[GRAPH.to("line")],
            then: &["step"],
        },
        Preset {
            id: "stiff",
            label: "A confident loop",
            help: "A loop ten times as stiff keeps nearly all of its length, and it is odometry that gives way.",
            set: &[GRAPH.to("line"), STIFFNESS.to(10.0)],
            then: &["step"],
        },
        Preset {
            id: "unpinned",
            label: "Unpin the gauge",
            help: "The last pose starts 1 m too far out, and no pose is pinned. χ² still falls to 0.12, but every pose ends somewhere else.",
            set: &[GRAPH.to("line"), PINNED.to(false), MOVED[2][0].to(1.0)],
            then: &["step"],
        },
        Preset {
            id: "square",
            label: "A square that does not close",
            help: "Four sides, and a loop that puts their end somewhere else. The whole square gives way a little.",
            set: &[GRAPH.to("square"), STEPS.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "tangled",
            label: "A tangled ring",
            help: "One pose starts far out and rotated. Headings make the problem nonlinear, so convergence takes several steps.",
            set: &[
                GRAPH.to("ring"),
                MOVED[3][0].to(1.5),
                MOVED[3][1].to(1.0),
                MOVED[3][2].to(60.0),
                STEPS.to(0.0),
            ],
            then: &["play"],
        },
    ],
};
