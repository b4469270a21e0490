//! The widget's texts and its list of parameters.

use ch16_lab::lap;
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::run::{LOOPS, NOISE, seed};
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Ticks of a lap.
const LAP_TICKS: f64 = lap::LAP_TICKS as f64;

/// The last tick before the first loop of the canonical lap.
const BEFORE_THE_LOOP: f64 = 91.0;

/// Goes to the next event of the log.
const NEXT_EVENT: ButtonSpec = ButtonSpec {
    id: "next-event",
    label: "Next event",
    help: "Go to the next keyframe, loop test or waypoint, and from the last one back to the first.",
};

params! {
    use NOISE;
    use LOOPS;

    pub(super) static SEED: Param<u32> = seed(lap::CANONICAL_SEED);

    pub(super) static PART: OneOf<usize> = one_of!(
        usize,
        "lane",
        "part",
        &[
            (0, "predict", "predict"),
            (1, "register", "register"),
            (2, "keyframe", "keyframe"),
            (3, "candidate", "candidate"),
            (4, "fit", "fit"),
            (5, "gate", "gate"),
            (6, "optimize", "optimize"),
            (7, "repaint", "repaint"),
        ],
    )
    .default("register")
    .help("The operation described at this tick. To select another, press its mark below the map.");

    pub(super) static TICK: Param<f64> = Param::timeline("t", "tick", LAP_TICKS)
        .default(BEFORE_THE_LOOP)
        .help("The moment shown. A tick is a quarter of a second, and each mark is a loop.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.4",
    name: "Control room",
    title: "Which part works when, and what happens at a loop?",
    claim: "The back end works only at loops.",
    gesture: "Press Play, or press a part below the map.",
    awaits: Awaits::Nothing,
    notice: &[
        "The front end runs at every tick. It predicts from odometry and corrects with one registration. The threshold τ follows how wrong the predictions were.",
        "The grid stores no poses. After an accepted loop it is discarded and redrawn from every keyframe's sweep.",
        "Cells that are likely occupied have the colour of this text, and free cells the colour of the page. Tinted cells were never seen.",
        "Each mark below the map is one part, filled while it works. Predict and register work at every tick on one sweep; optimize and repaint go through every keyframe, and so cost more the longer the robot drives.",
        "Walls blur where two passes disagree. At the first loop they sharpen, and the number of cells more than 90% likely to be occupied rises from 110 to 156.",
    ],
    opening: Opening {
        panels: &["map", "parts"],
        params: &[],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, NEXT_EVENT, DEFAULTS],
    presets: &[
        Preset {
            id: "watch",
            label: "Watch the whole run",
            help: "From the first sweep to the end of the lap, with three loops on the way.",
            set: &[TICK.to(0.0)],
            then: &["play"],
        },
        Preset {
            id: "blurred",
            label: "Just before the first loop",
            help: "The corridor has been mapped twice, and the two passes disagree by 0.12 m.",
            set: &[TICK.to(BEFORE_THE_LOOP)],
            then: &[],
        },
        Preset {
            id: "rebuilt",
            label: "The grid redrawn",
            help: "One tick and one loop later the passes disagree by 0.08 m, and the walls are sharper.",
            set: &[TICK.to(92.0)],
            then: &[],
        },
        Preset {
            id: "noisy",
            label: "Four times the noise",
            help: "The threshold τ opens up from 0.77 m to 1.51 m. Predictions are worse, so matches are sought further away.",
            set: &[NOISE.to(4.0), TICK.to(60.0)],
            then: &[],
        },
        Preset {
            id: "wrong-loop",
            label: "A false loop gets in",
            help: "With seed 6 at twice the noise, the first loop passes every test and is 0.36 m out. No test of the robot shows it, because the loop is a near miss.",
            set: &[SEED.to(6), NOISE.to(2.0), TICK.to(92.0)],
            then: &[],
        },
        Preset {
            id: "open",
            label: "No loops",
            help: "Without loops, no pose ever moves again. The two passes end 0.24 m apart instead of 0.08 m, and 104 cells are clearly occupied instead of 175.",
            set: &[LOOPS.to(false), TICK.to(LAP_TICKS)],
            then: &[],
        },
    ],
};
