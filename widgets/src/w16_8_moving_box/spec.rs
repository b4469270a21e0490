//! The widget's texts and its list of parameters.

use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

pub(super) use crate::icp_variant::VARIANT;

/// Largest share of the box, %.
pub const MAX_SHARE: f64 = 60.0;

/// Range of the displacement of the box along x and y, m: it stays off the walls and the sensor.
pub const MOVED_M: [[f64; 2]; 2] = [[0.0, 0.8], [-1.2, 0.5]];

/// Largest number of iterations of a registration.
pub const MAX_ITERATIONS: f64 = 30.0;

params! {
    pub(super) static METHOD: OneOf<usize> = one_of!(
        usize,
        "method",
        "registration",
        &[
            (0, "plain", "plain"),
            (1, "trimmed", "trimmed"),
            (2, "huber", "with Huber"),
        ],
    )
    .help("Which registration's pairs are drawn: plain ICP uses all pairs, trimming drops the longest, and Huber's kernel gives long pairs less weight.");

    pub(super) static SHARE: Param<f64> =
        Param::slider("share", "points on the box", [0.0, MAX_SHARE], 1.0)
            .unit("%")
            .default(20.0)
            .help("The share of points on the moved box, in both sweeps.");

    pub(super) static MOVED: Param<f64> = Param::slider("moved", "box moved along x", MOVED_M[0], 0.05)
        .unit("m")
        .default(0.3)
        .help("How far the box was moved between the sweeps, away from the sensor along x.");

    pub(super) static MOVED_Y: Param<f64> =
        Param::slider("moved-y", "box moved along y", MOVED_M[1], 0.05)
            .unit("m")
            .help("How far the box was moved between the sweeps along y.");

    pub(super) static DROPPED: Param<f64> =
        Param::slider("dropped", "trimmed: pairs dropped", [0.0, 70.0], 5.0)
            .unit("%")
            .default(25.0)
            .help("The share of the pairs that trimming drops in each iteration, longest first.");

    pub(super) static HUBER: Param<f64> = Param::slider("huber", "Huber width", [0.01, 0.3], 0.01)
        .unit("m")
        .default(0.05)
        .help("Pairs longer than this pull with the same force, however long they are.");

    pub(super) static TAU: Param<f64> = Param::slider("tau", "pairing distance τ", [0.1, 1.6], 0.05)
        .unit("m")
        .default(0.7)
        .help("A point further than this from the target is unmatched. A gate is a kernel, too.");

    use VARIANT;

    pub(super) static SEED: Param<u32> = Param::seed("seed of the sweeps", 1)
        .help("Seed of the range noise of the sweeps above; the curves have their own hundred seeds.");

    pub(super) static ITERATION: Param<f64> = Param::timeline("iteration", "iteration", MAX_ITERATIONS)
        .help(
            "The iteration shown for all three registrations; one that stops early has converged.",
        );

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.8",
    name: "The moving box",
    title: "How far off does one moved box pull the robot?",
    claim: "That depends on the weight its pairs keep.",
    gesture: "Drag the box.",
    awaits: Awaits::Rest,
    notice: &[
        "Drag the box. Its pairs all pull the same way, and the sweep moves until the many short pulls of the walls balance them.",
        "A few centimetres look like noise, but they are a bias and do not average out.",
        "Trimming drops the longest pairs, which are mostly on the box. It gives way last, and slowly.",
        "Huber's kernel never drops a pair. It resists a small box; with half of the points on the box it ends further out than plain ICP.",
    ],
    opening: Opening {
        panels: &["room", "bias"],
        params: &["method"],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "fifth",
            label: "A fifth of the points",
            help: "The exercise's setting. Plain ICP follows the box; with trimming or Huber's kernel, the sweep barely moves.",
            set: &[],
            then: &["play"],
        },
        Preset {
            id: "most",
            label: "More than trimming drops",
            help: "With half of the points on the box, dropping a quarter of the pairs is not enough. Which degrades most gracefully?",
            set: &[SHARE.to(50.0)],
            then: &["play"],
        },
        Preset {
            id: "none",
            label: "No box",
            help: "Without a box all three agree, and trimming has only thrown good pairs away.",
            set: &[SHARE.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "gate",
            label: "A short τ",
            help: "With a τ of 0.2 m the box has few matches, and plain ICP is as good as the others.",
            set: &[TAU.to(0.2)],
            then: &["play"],
        },
    ],
};
