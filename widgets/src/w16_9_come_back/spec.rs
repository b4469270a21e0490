//! The widget's words and its one list of parameters.

use ch16_lab::lap::CANONICAL_SEED;
use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::run;
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};

/// Sides of the plan, m: no world is larger.
pub const PLAN_M: [f64; 2] = [12.0, 9.0];

/// More moments than any morning has.
pub const MOST_MOMENTS: f64 = 4000.0;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        id: "laps",
        label: "laps since the wardrobe moved",
        unit: "",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 2.0,
            step: 1.0,
        },
        default: 0.0,
        help: "The map is of one lap before that night, and of so many after it.",
    },
    place("x", "switched on at x", PLAN_M[0], 4.4),
    place("y", "switched on at y", PLAN_M[1], 4.4),
    ParamSpec {
        id: "heading",
        label: "heading there",
        unit: "°",
        kind: ParamKind::Slider {
            min: -180.0,
            max: 180.0,
            step: 5.0,
        },
        default: 0.0,
        help: "Where the robot looks when it is switched on. Nobody tells it.",
    },
    ParamSpec {
        id: "world",
        label: "world",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "apartment",
                    label: "the Apartment",
                },
                Choice {
                    id: "ring",
                    label: "a ring of corridors",
                },
                Choice {
                    id: "twins",
                    label: "two rooms alike",
                },
            ],
        },
        default: 0.0,
        help: "Where it all happens. The wardrobe stands in the Apartment alone.",
    },
    run::seed(CANONICAL_SEED),
    ParamSpec {
        id: "moment",
        label: "moment",
        unit: "",
        kind: ParamKind::Timeline { max: MOST_MOMENTS },
        default: MOST_MOMENTS,
        help: "Which moment of the morning is shown: boxes of a search, and scans.",
    },
    SPEED,
    MORE,
];

const fn place(id: &'static str, label: &'static str, max: f64, default: f64) -> ParamSpec {
    ParamSpec {
        id,
        label,
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.0,
            max,
            step: 0.1,
        },
        default,
        help: "Where the robot is put overnight, on the plan. Nobody tells it.",
    }
}

/// One moment, under the name that it has here.
const ONE_MOMENT: ButtonSpec = ButtonSpec {
    label: "Next moment",
    help: "On to more boxes of the search, or to the next scan.",
    ..STEP
};

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.9",
    title: "Come back tomorrow",
    misconception: "A saved map does not say where the robot is. It has to be looked for everywhere, and \
                    an honest robot says when two places look alike.",
    notice: &[
        "Orange boxes are places that are not ruled out yet. What is left of them is where the robot may be.",
        "Where the map was driven, one scan is enough. In a room that it never saw, or in one of two rooms alike, no pose is told before the robot is out of the door.",
        "Once it is found, each scan is registered on the map around it, and nothing is searched any more.",
        "The wardrobe was moved overnight. The map still shows it where it stood; after another lap it is gone from there.",
    ],
    opening: Opening {
        panels: &["map", "scores"],
        params: &["laps"],
        buttons: &["play", "step", "reset"],
    },
    params: PARAMS,
    buttons: &[PLAY, ONE_MOMENT, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "room",
            label: "Switched on in a room",
            help: "The lap never entered it, so the robot says that it does not know, and drives out of the door.",
            set: &[
                ("world", 0.0),
                ("x", 2.6),
                ("y", 2.2),
                ("heading", 120.0),
                ("moment", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "corridor",
            label: "Switched on in the corridor",
            help: "Here the map was driven: one scan is enough, among millions of poses.",
            set: &[
                ("world", 0.0),
                ("x", 4.4),
                ("y", 4.4),
                ("heading", 0.0),
                ("moment", 0.0),
            ],
            then: &["play"],
        },
        Preset {
            id: "forget",
            label: "One more lap",
            help: "The wardrobe is gone from where it stood: newer scans have looked through it.",
            set: &[("world", 0.0), ("laps", 1.0)],
            then: &[],
        },
        Preset {
            id: "twins",
            label: "In one of two rooms alike",
            help: "Both rooms fit to the millimetre: no pose is told before the robot is out of the door.",
            set: &[
                ("world", 2.0),
                ("x", 6.2),
                ("y", 3.7),
                ("heading", 180.0),
                ("moment", 0.0),
            ],
            then: &["play"],
        },
    ],
};
