//! The widget's words and its one list of parameters.

use ch16_lab::lap;
use ch16_slam2d::chi_squared::CHAPTER_QUANTILE;
use kit::layers::Opening;
use kit::param::{Choice, MORE, ParamKind, ParamSpec};
use kit::playback::SPEED;
use kit::run::{LOOPS, NOISE, seed};
use kit::spec::{ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use pr_sim::sketch::limits;

/// Ticks of a lap of the Apartment.
pub const LAP_TICKS: f64 = lap::LAP_TICKS as f64;

/// Ticks of a lap elsewhere: like those of the Apartment they do not depend on the noise.
const RING_TICKS: f64 = 290.0;
const TWINS_TICKS: f64 = 469.0;
const CORRIDOR_TICKS: f64 = 287.0;
const HALL_TICKS: f64 = 154.0;

/// The latest tick that a link may ask for: a drive that has not ended then is cut off.
pub const MOST_TICKS: f64 = 2000.0;

/// Largest number of a keyframe that a link may ask for.
const MOST_NODES: f64 = 999.0;

/// Where the widget starts: the tick of the canonical run's first loop.
const FIRST_LOOP_TICK: f64 = 92.0;

/// The value of `world` for the reader's own flat, after those that are built in.
pub const OWN_WORLD: f64 = 5.0;

/// Most characters of a flat in a link: four digits of base 64 for each number of the largest.
const MOST_FLAT: usize = 33_000;

/// Largest number of a wall, counted from 1.
const MOST_PIECES: f64 = limits::WALLS as f64;

/// What the reader can change.
pub const PARAMS: &[ParamSpec] = &[
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
                Choice {
                    id: "corridor",
                    label: "a bare corridor",
                },
                Choice {
                    id: "hall",
                    label: "a round hall",
                },
                Choice {
                    id: "own",
                    label: "your own flat",
                },
            ],
        },
        default: 0.0,
        help: "What is driven through. The Apartment by the chapter's estimator, every other world by the default one.",
    },
    ParamSpec {
        id: "edit",
        label: "tool on the map",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "off",
                    label: "off",
                },
                Choice {
                    id: "move",
                    label: "move",
                },
                Choice {
                    id: "wall",
                    label: "draw walls",
                },
                Choice {
                    id: "way",
                    label: "way points",
                },
                Choice {
                    id: "remove",
                    label: "remove",
                },
            ],
        },
        default: 0.0,
        help: "What a press on the map does: moves a wall, an end, a way point or the start; draws a wall; places a way point behind the chosen one; removes what it meets. All on a grid of 5 cm.",
    },
    ParamSpec {
        id: "piece",
        label: "piece of the flat",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "nothing",
                    label: "nothing",
                },
                Choice {
                    id: "wall",
                    label: "a wall",
                },
                Choice {
                    id: "first-end",
                    label: "its first end",
                },
                Choice {
                    id: "second-end",
                    label: "its second end",
                },
                Choice {
                    id: "way-point",
                    label: "a way point",
                },
                Choice {
                    id: "start",
                    label: "the start",
                },
                Choice {
                    id: "heading",
                    label: "its heading",
                },
            ],
        },
        default: 0.0,
        help: "What of the flat the arrows move and Remove takes away. On the map, a press chooses it.",
    },
    ParamSpec {
        id: "piece-number",
        label: "number of the piece",
        unit: "",
        kind: ParamKind::Seed { max: MOST_PIECES },
        default: 1.0,
        help: "The number of the wall or of the way point, from 1.",
    },
    ParamSpec {
        id: "flat",
        label: "your flat as text",
        unit: "",
        kind: ParamKind::Text { most: MOST_FLAT },
        default: 0.0,
        help: "Walls, start and way points of your own flat to the centimetre, as links carry them. It makes the world your own flat.",
    },
    NOISE,
    LOOPS,
    seed(lap::CANONICAL_SEED),
    ParamSpec {
        id: "gate",
        label: "gate quantile",
        unit: "",
        kind: ParamKind::Slider {
            min: 0.90,
            max: 0.999,
            step: 0.001,
        },
        default: CHAPTER_QUANTILE,
        help: "Share of right loops that the χ² gate lets pass, 3 degrees of freedom: 0.95 is χ² up to 7.815.",
    },
    ParamSpec {
        id: "gate-model",
        label: "drift in the gate",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "path",
                    label: "path",
                },
                Choice {
                    id: "exact",
                    label: "exact",
                },
            ],
        },
        default: 0.0,
        help: "Path: the chapter's, which grows with the number of nodes between the two ends. Exact: the covariance of their relative pose in the graph. An outline holds the positions that pass at the registered heading.",
    },
    ParamSpec {
        id: "matcher",
        label: "matcher",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "p2p",
                    label: "point to point",
                },
                Choice {
                    id: "p2l",
                    label: "point to plane",
                },
                Choice {
                    id: "ndt",
                    label: "NDT",
                },
            ],
        },
        default: 0.0,
        help: "What registers each sweep, in the front end and for loops: the chapter's ICP, point to point, or point to plane, or the normal distributions transform.",
    },
    ParamSpec {
        id: "information",
        label: "information",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "chapter",
                    label: "as the chapter's figures",
                },
                Choice {
                    id: "exact",
                    label: "at the edge's target",
                },
            ],
        },
        default: 0.0,
        help: "The frame in which an edge says what it is sure of. As the chapter's figures were computed, it is turned by a heading of the world; exactly, it stands at the edge's target, the newer of its ends.",
    },
    ParamSpec {
        id: "pick",
        label: "look at",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "nothing",
                    label: "nothing",
                },
                Choice {
                    id: "keyframe",
                    label: "a keyframe",
                },
                Choice {
                    id: "edge",
                    label: "an edge",
                },
                Choice {
                    id: "loop",
                    label: "a loop",
                },
            ],
        },
        default: 0.0,
        help: "What of the graph is looked at and told in numbers. On the map, a click or a tap chooses it, and one beside everything chooses nothing.",
    },
    ParamSpec {
        id: "number",
        label: "number",
        unit: "",
        kind: ParamKind::Seed { max: MOST_NODES },
        default: 0.0,
        help: "The number of the keyframe; of the keyframe where the edge begins; of the newer keyframe of the loop.",
    },
    ParamSpec {
        id: "own",
        label: "your own loop",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "none",
                    label: "none",
                },
                Choice {
                    id: "registered",
                    label: "registered",
                },
                Choice {
                    id: "truth",
                    label: "the truth",
                },
                Choice {
                    id: "same-place",
                    label: "“the same place”",
                },
            ],
        },
        default: 0.0,
        help: "A loop between any two keyframes. Registered: what the sweeps say, from where the graph believes them to be. The truth: what no robot knows. “The same place”: that both stand at one spot, right or wrong.",
    },
    ParamSpec {
        id: "own-from",
        label: "your loop: from keyframe",
        unit: "",
        kind: ParamKind::Seed { max: MOST_NODES },
        default: 40.0,
        help: "One end of your own loop. On the map, drag from the keyframe that is looked at to any other.",
    },
    ParamSpec {
        id: "own-to",
        label: "your loop: to keyframe",
        unit: "",
        kind: ParamKind::Seed { max: MOST_NODES },
        default: 12.0,
        help: "The other end of your own loop.",
    },
    ParamSpec {
        id: "own-gate",
        label: "your loop has to pass the gate",
        unit: "",
        kind: ParamKind::Switch,
        default: 1.0,
        help: "Whether the tests may turn your own loop away: fit, pairs and gate where it is registered, the gate where it is asserted.",
    },
    ParamSpec {
        id: "kernel",
        label: "kernel of your loop",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "quadratic",
                    label: "quadratic",
                },
                Choice {
                    id: "huber",
                    label: "Huber",
                },
                Choice {
                    id: "dcs",
                    label: "DCS",
                },
            ],
        },
        default: 0.0,
        help: "What the graph is solved under once your own loop is in it: plain least squares, Huber's kernel from 1.345 standard deviations on, or dynamic covariance scaling from χ² 10 on.",
    },
    ParamSpec {
        id: "t",
        label: "tick",
        unit: "",
        kind: ParamKind::Timeline { max: MOST_TICKS },
        default: FIRST_LOOP_TICK,
        help: "The moment shown; a tick is a quarter of a second, the marks are loops, and past the end means the end.",
    },
    ParamSpec {
        id: "future",
        label: "show what is to come",
        unit: "",
        kind: ParamKind::Switch,
        default: 0.0,
        help: "Draws the whole lap into the plots, also what comes after the moment shown.",
    },
    SPEED,
    MORE,
];

/// One tick before the loop.
const BEFORE: ButtonSpec = ButtonSpec {
    id: "before",
    label: "Before the loop",
    help: "One tick before the loop is tried.",
};

/// The tick of the loop, with its animation.
const AT: ButtonSpec = ButtonSpec {
    id: "at",
    label: "At the loop",
    help: "The tick of the loop: watch the history move.",
};

/// One tick after the loop.
const AFTER: ButtonSpec = ButtonSpec {
    id: "after",
    label: "After the loop",
    help: "One tick after the loop was tried.",
};

/// On to the next loop.
const NEXT: ButtonSpec = ButtonSpec {
    id: "next",
    label: "Next loop",
    help: "On to the next loop; after the last one, to the first.",
};

/// The buttons that go by the loops of the lap.
pub const LOOP_BUTTONS: [ButtonSpec; 4] = [BEFORE, AT, AFTER, NEXT];

/// Back among the keyframes, edges or loops.
const ONE_BACK: ButtonSpec = ButtonSpec {
    id: "one-back",
    label: "One back",
    help: "Looks at the keyframe, edge or loop before; from nothing, at the newest keyframe.",
};

/// On among them.
const ONE_ON: ButtonSpec = ButtonSpec {
    id: "one-on",
    label: "One on",
    help: "Looks at the next keyframe, edge or loop; from nothing, at the first keyframe.",
};

/// One end of a loop, then the other.
const TIE: ButtonSpec = ButtonSpec {
    id: "tie",
    label: "Tie",
    help: "Begins a loop of your own at the keyframe that is looked at; look at another one and press it again.",
};

/// The loop before the last change of it.
const UNDO: ButtonSpec = ButtonSpec {
    id: "undo",
    label: "Undo",
    help: "Takes the last change of your own loop back.",
};

const fn flat_button(id: &'static str, label: &'static str, help: &'static str) -> ButtonSpec {
    ButtonSpec { id, label, help }
}

/// Begins and ends the editing of the flat.
const EDIT: ButtonSpec = flat_button(
    "edit-flat",
    "Edit the flat",
    "Puts a pencil into your hand, with which a drag on the map draws a wall, or puts it away.",
);

/// What edits the flat.
const FLAT_BUTTONS: [ButtonSpec; 14] = [
    flat_button(
        "piece-back",
        "Piece back",
        "Chooses the wall, the end or the way point before; also Page Up.",
    ),
    flat_button(
        "piece-on",
        "Piece on",
        "Chooses the next wall, end or way point; also Page Down.",
    ),
    flat_button(
        "west",
        "Left",
        "Moves what is chosen 5 cm to the left, or turns the start back; also the arrow key.",
    ),
    flat_button(
        "east",
        "Right",
        "Moves what is chosen 5 cm to the right, or turns the start on; also the arrow key.",
    ),
    flat_button(
        "north",
        "Up",
        "Moves what is chosen 5 cm up, or turns the start on; also the arrow key.",
    ),
    flat_button(
        "south",
        "Down",
        "Moves what is chosen 5 cm down, or turns the start back; also the arrow key.",
    ),
    flat_button(
        "remove",
        "Remove",
        "Takes away the wall or the way point that is chosen; also Delete.",
    ),
    flat_button(
        "add-wall",
        "Add a wall",
        "Puts a wall of a metre into the middle and chooses it.",
    ),
    flat_button(
        "add-way-point",
        "Add a way point",
        "Puts a way point behind the chosen one, or at the end, and chooses it.",
    ),
    flat_button(
        "turn-here",
        "Seen again from here",
        "From the chosen way point on, places are seen again: the map from there is compared with the one before.",
    ),
    flat_button(
        "take-back",
        "Take back",
        "Takes the last change of the flat back; also Ctrl+Z.",
    ),
    flat_button(
        "do-again",
        "Do again",
        "Makes the change again that was taken back; also Ctrl+Y.",
    ),
    flat_button(
        "open-flat",
        "Open a flat",
        "Opens a world from a JSON file, as slam2d --world reads it.",
    ),
    flat_button(
        "save-flat",
        "Save the flat",
        "Saves the world as a JSON file that slam2d --world reads.",
    ),
];

/// Keys of those buttons.
pub const FLAT_KEYS: &[(&str, &str)] = &[
    ("ArrowLeft", "west"),
    ("ArrowRight", "east"),
    ("ArrowUp", "north"),
    ("ArrowDown", "south"),
    ("Delete", "remove"),
    ("PageUp", "piece-back"),
    ("PageDown", "piece-on"),
    ("Control+z", "take-back"),
    ("Control+y", "do-again"),
];

/// What waits until the flat is edited.
pub const FLAT_CONTROLS: &[&str] = &[
    "piece",
    "piece-number",
    "piece-back",
    "piece-on",
    "west",
    "east",
    "north",
    "south",
    "remove",
    "add-wall",
    "add-way-point",
    "turn-here",
    "take-back",
    "do-again",
    "open-flat",
    "save-flat",
];

/// What the widget shows while the flat is edited.
pub const EDITING: Opening = Opening {
    panels: &["map", "loop"],
    params: &["edit", "piece", "piece-number"],
    buttons: &[
        "play",
        "edit-flat",
        "piece-back",
        "piece-on",
        "west",
        "east",
        "north",
        "south",
        "remove",
        "add-wall",
        "add-way-point",
        "turn-here",
        "take-back",
        "do-again",
        "open-flat",
        "save-flat",
    ],
};

/// What never changes.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.2",
    title: "The full lap",
    misconception: "Closing a loop does not put the whole path right: it makes the map agree with itself.",
    notice: &[
        "The walls seen on the way out and on the way back stand apart, and one loop brings them together: the map's disagreement falls to about a third over the lap.",
        "The typical error over the keyframes hardly changes, and the largest even grows a little: the corridor comes out almost a metre too short, and no loop sees that.",
        "A loop moves poses that the robot left long ago. A filter that keeps only the newest pose could not.",
        "Click a keyframe, and drag from it to another: a loop of your own. A wrong one is paid for by every edge between its ends, each a little; a kernel gives it little weight.",
        "A small χ² alone does not pass: the sweep must also fit the old walls to 0.16 m, with at least 25 pairs.",
        "The exact gate adds up what the edges say of themselves, and knows the truth no better. Over seeds 1 to 50 at four times the noise the chapter's closes 78 loops, 3 of them wrong; the exact one closes 123, 7 of them wrong. Wrong is more than 0.3 m or 5° off the truth.",
    ],
    opening: Opening {
        panels: &["map", "loop"],
        params: &["loops"],
        buttons: &["play", "edit-flat"],
    },
    params: PARAMS,
    buttons: &[
        PLAY,
        STEP,
        RESET,
        BEFORE,
        AT,
        AFTER,
        NEXT,
        ONE_BACK,
        ONE_ON,
        TIE,
        UNDO,
        EDIT,
        FLAT_BUTTONS[0],
        FLAT_BUTTONS[1],
        FLAT_BUTTONS[2],
        FLAT_BUTTONS[3],
        FLAT_BUTTONS[4],
        FLAT_BUTTONS[5],
        FLAT_BUTTONS[6],
        FLAT_BUTTONS[7],
        FLAT_BUTTONS[8],
        FLAT_BUTTONS[9],
        FLAT_BUTTONS[10],
        FLAT_BUTTONS[11],
        FLAT_BUTTONS[12],
        FLAT_BUTTONS[13],
        DEFAULTS,
    ],
    presets: &[
        Preset {
            id: "first-loop",
            label: "Watch the first loop",
            help: "Node 29 recognises the corridor at node 7. The robot's own error falls, the error over all keyframes rises.",
            set: &[("t", FIRST_LOOP_TICK)],
            then: &["at"],
        },
        Preset {
            id: "rejected",
            label: "Seed 6: a loop is turned away",
            help: "The χ² is below the gate, but the sweep fits the old walls badly; four keyframes later a better match passes.",
            set: &[("seed", 6.0), ("t", 90.0)],
            then: &[],
        },
        Preset {
            id: "no-loops",
            label: "Switch the loops off",
            help: "The front end alone: the same sweeps, and a map whose two passes end 0.24 m apart instead of 0.08 m.",
            set: &[("loops", 0.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "noisy",
            label: "Four times the noise",
            help: "Odometry ends almost 5 m off, the front end holds, and the last loop closes in the last tick.",
            set: &[("noise", 4.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "tight-gate",
            label: "A tight gate on a noisy lap",
            help: "At the 0.90 quantile the gate turns away a loop that the chapter's gate accepts.",
            set: &[("noise", 4.0), ("gate", 0.90), ("t", 116.0)],
            then: &[],
        },
        Preset {
            id: "locked-out",
            label: "Right loops, locked out",
            help: "Seed 2 at three times the noise drifts more than the gate allows for: it turns away three right loops, and the drift goes on.",
            set: &[("seed", 2.0), ("noise", 3.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "let-in",
            label: "The same lap, exact gate",
            help: "The chapter's gate turns the first loop away by its heading alone. The edges are less sure of the heading: the exact gate lets all three loops in, and the lap ends more than a metre closer.",
            set: &[
                ("seed", 2.0),
                ("noise", 3.0),
                ("gate-model", 1.0),
                ("t", 94.0),
            ],
            then: &[],
        },
        Preset {
            id: "wrong-loop",
            label: "A wrong loop, forced in",
            help: "“Keyframes 40 and 12 are the same place” is a lie of 6 m. Past the gate it folds the map: the history moves by up to 3.8 m, and every edge between the two is strained.",
            set: &[
                ("own", 3.0),
                ("own-from", 40.0),
                ("own-to", 12.0),
                ("own-gate", 0.0),
                ("t", LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "tamed-loop",
            label: "The same lie, tamed",
            help: "Dynamic covariance scaling gives a loop that is far off next to no weight: nothing moves.",
            set: &[
                ("own", 3.0),
                ("own-from", 40.0),
                ("own-to", 12.0),
                ("own-gate", 0.0),
                ("kernel", 2.0),
                ("t", LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "true-loop",
            label: "A true loop that the gate refuses",
            help: "From keyframe 25, on the way back, to the start, as it truly is: the typical error over the keyframes falls from 0.59 m to 0.14 m. The gate refuses it, at χ² 13.0: drift does not explain it.",
            set: &[
                ("own", 2.0),
                ("own-from", 25.0),
                ("own-to", 0.0),
                ("own-gate", 0.0),
                ("t", LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "ring",
            label: "A ring that closes",
            help: "Around a block and back to the start from the other side, by point to plane: the chain is held at both ends.",
            set: &[
                ("world", 1.0),
                ("matcher", 1.0),
                ("information", 1.0),
                ("t", RING_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "twins",
            label: "Two rooms alike",
            help: "The second room looks like the first, and after so long a way the gate is wide enough: the robot closes a wrong loop, and the two rooms become one.",
            set: &[("world", 2.0), ("information", 1.0), ("t", TWINS_TICKS)],
            then: &[],
        },
        Preset {
            id: "corridor",
            label: "A bare corridor",
            help: "Nothing is seen along it, so registration says that the robot hardly moves. The map agrees with itself, and the corridor is a fraction of its length.",
            set: &[("world", 3.0), ("information", 1.0), ("t", CORRIDOR_TICKS)],
            then: &[],
        },
        Preset {
            id: "hall",
            label: "A round hall",
            help: "The wall tells where the middle is, and nothing of the heading: by point to plane the robot is on the far side of the hall at the end, and the map agrees with itself to three centimetres.",
            set: &[
                ("world", 4.0),
                ("matcher", 1.0),
                ("information", 1.0),
                ("t", HALL_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "own-flat",
            label: "Draw your own flat",
            help: "The Apartment with a pencil in your hand: each wall that you draw is there at once, and the lap follows.",
            set: &[("edit", 2.0)],
            then: &[],
        },
        Preset {
            id: "bells",
            label: "The same lap by NDT",
            help: "The same sweeps, matched to bells in place of points: the lap ends 0.04 m off instead of 0.24 m.",
            set: &[("matcher", 2.0), ("t", LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "sliding",
            label: "The same lap by planes",
            help: "The same sweeps, each point free to slide along its wall: the lap ends 0.05 m off instead of 0.24 m.",
            set: &[("matcher", 1.0), ("t", LAP_TICKS)],
            then: &[],
        },
    ],
};
