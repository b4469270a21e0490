//! The widget's texts and its list of parameters.

use ch16_lab::lap::CANONICAL_SEED;
use ch16_lab::lap::{BuiltInWorld, NamedChoice as _};
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::run;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Sides of the plan, m: no world is larger.
pub const PLAN_M: [f64; 2] = [12.0, 9.0];

/// An upper bound of the moments of a run.
pub const MAX_MOMENTS: f64 = 4000.0;

const fn place(id: &'static str, label: &'static str, max: f64, default: f64) -> Param<f64> {
    Param::slider(id, label, [0.0, max], 0.1)
        .unit("m")
        .default(default)
        .help("Where on the plan the robot is moved to overnight. The robot is not told.")
}

/// The step button: one moment.
const ONE_MOMENT: ButtonSpec = ButtonSpec {
    label: "Next moment",
    help: "Go on to more boxes of the search, or to the next scan.",
    ..STEP
};

params! {
    pub(super) static LAPS: Param<usize> =
        Param::slider("laps", "laps since the wardrobe moved", [0.0, 2.0], 1.0)
            .help("The map was made from one lap before that night, and from this many laps after it.");

    pub(super) static START_X: Param<f64> = place("x", "switched on at x", PLAN_M[0], 2.6);

    pub(super) static START_Y: Param<f64> = place("y", "switched on at y", PLAN_M[1], 2.2);

    pub(super) static HEADING: Param<f64> =
        Param::slider("heading", "heading there", [-180.0, 180.0], 5.0)
            .unit("°")
            .default(120.0)
            .help("The robot's heading when it is switched on, which the robot does not know.");

    pub(super) static WORLD: OneOf<BuiltInWorld> = one_of!(
        BuiltInWorld,
        "world",
        "world",
        BuiltInWorld::NAMED.split_at(3).0,
    )
    .help("The world the robot wakes up in. Only the Apartment has the wardrobe.");

    pub(super) static SEED: Param<u32> = run::seed(CANONICAL_SEED);

    pub(super) static MOMENT: Param<f64> = Param::timeline("moment", "moment", MAX_MOMENTS)
        .help("The moment shown, counted in boxes of the search and in scans.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.9",
    name: "Come back tomorrow",
    title: "Where can the robot work out where it is?",
    claim: "It needs a scan that fits only one place.",
    gesture: "Drag the robot anywhere, then let it go.",
    awaits: Awaits::Nothing,
    notice: &[
        "A ring is a place not yet ruled out; the better it may still fit, the larger it is. The robots mark the two places that fit best.",
        "Where the mapping robot drove, one scan is enough. In a room it never entered, or in one of two identical rooms, no pose is called reliable until the robot is out of the door.",
        "The wardrobe was moved overnight. The map still shows it in the old place; after another lap it is gone from there.",
    ],
    opening: Opening {
        panels: &["map", "scores"],
        params: &[],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, ONE_MOMENT, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "room",
            label: "Switched on in a room",
            help: "The lap never entered it, so the robot reports that it is unsure, and drives out of the door.",
            set: &[
                WORLD.to("apartment"),
                START_X.to(2.6),
                START_Y.to(2.2),
                HEADING.to(120.0),
                MOMENT.to(0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "corridor",
            label: "Switched on in the corridor",
            help: "The mapping lap came through here. One scan is enough, among millions of poses.",
            set: &[
                WORLD.to("apartment"),
                START_X.to(4.4),
                START_Y.to(4.4),
                HEADING.to(0.0),
                MOMENT.to(0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "forget",
            label: "One more lap",
            help: "The wardrobe is gone from its old place, because newer scans looked through it.",
            set: &[WORLD.to("apartment"), LAPS.to(1)],
            then: &[],
        },
        Preset {
            id: "twins",
            label: "In one of two identical rooms",
            help: "Both rooms fit to the millimetre. No pose is called reliable until the robot is out of the door.",
            set: &[
                WORLD.to("twins"),
                START_X.to(6.2),
                START_Y.to(3.7),
                HEADING.to(180.0),
                MOMENT.to(0.0),
            ],
            then: &["play"],
        },
    ],
};
