//! The widget's texts and its list of parameters.

use ch16_lab::lap;
use ch16_lab::lap::{BuiltInWorld, Claim, LapMatcher, NamedChoice as _, OwnKernel};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::chi_squared::CHAPTER_QUANTILE;
use ch16_slam2d::loops::GateModel;
use pr_sim::sketch::limits;
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param, optional};
use widget_kit::playback::SPEED;
use widget_kit::run::{LOOPS, NOISE, seed};
use widget_kit::spec::{
    Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec, buttons, count,
};
use widget_kit::{one_of, params};

/// Ticks of a lap of the Apartment.
pub const LAP_TICKS: f64 = lap::LAP_TICKS as f64;

/// Ticks of a lap elsewhere, which do not depend on the noise, either.
const RING_TICKS: f64 = 290.0;
const TWINS_TICKS: f64 = 469.0;
const CORRIDOR_TICKS: f64 = 287.0;
const HALL_TICKS: f64 = 154.0;

/// The latest tick that a link may contain: a drive is cut off there.
pub const MAX_TICKS: f64 = 2000.0;

/// Largest number of a keyframe that a link may contain.
const MAX_NODES: f64 = 999.0;

/// The initial tick: that of the canonical run's first loop.
const FIRST_LOOP_TICK: f64 = 92.0;

/// Largest number of characters of a flat in a link: four digits of base 64 for each number of the largest
/// flat.
const MAX_FLAT: usize = 33_000;

/// Largest number of a wall, counted from 1.
const MAX_PIECES: f64 = limits::WALLS as f64;

/// The effect of a press on the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Moves a wall, an end, a waypoint or the start.
    Move,
    /// Draws a wall.
    Wall,
    /// Places a waypoint.
    Way,
    /// Removes the piece under it.
    Remove,
    /// Sets the robot down, or moves a waypoint; walls stay.
    Robot,
}

/// The layers of the map: one idea at a time, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layers {
    /// Where odometry and the truth put the robot.
    Wheels,
    /// The walls that the sweeps saw.
    Map,
    /// The map, and the graph with its loops.
    Loops,
    /// Those, and the truth.
    Truth,
    /// All, with odometry and the front end alone.
    All,
}

/// The kind of the selected part of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picked {
    /// No part.
    Nothing,
    /// A keyframe.
    Keyframe,
    /// An edge of odometry.
    Edge,
    /// A loop.
    Loop,
}

/// The buttons that go from loop to loop.
pub const LOOP_BUTTONS: &[ButtonSpec] = &[
    ButtonSpec::new(
        "before",
        "Before the loop",
        "Goes to the tick before the loop is tried.",
    ),
    ButtonSpec::new(
        "at",
        "At the loop",
        "Goes to the tick of the loop. Watch the history move.",
    ),
    ButtonSpec::new(
        "after",
        "After the loop",
        "Goes to the tick after the loop was tried.",
    ),
    ButtonSpec::new(
        "next",
        "Next loop",
        "Goes to the next loop, and from the last one back to the first.",
    ),
];

/// The buttons that select a part of the graph and tie two keyframes.
const GRAPH_BUTTONS: &[ButtonSpec] = &[
    ButtonSpec::new(
        "one-back",
        "Previous",
        "Selects the previous keyframe, edge or loop; without a selection, the newest keyframe.",
    ),
    ButtonSpec::new(
        "one-on",
        "Next",
        "Selects the next keyframe, edge or loop; without a selection, the first keyframe.",
    ),
    ButtonSpec::new(
        "tie",
        "Tie",
        "Starts your own loop at the selected keyframe; select another one and press Tie again.",
    ),
    ButtonSpec::new("undo", "Undo", "Undoes the last change to your own loop."),
];

/// Starts and ends the editing of the flat.
pub const EDIT_FLAT: ButtonSpec = ButtonSpec::new(
    "edit-flat",
    "Edit the flat",
    "Starts or ends editing. While you edit, a drag on the map draws a wall.",
);

/// The buttons that edit the flat, which are shown only during editing.
const FLAT_BUTTONS: &[ButtonSpec] = &[
    ButtonSpec::new(
        "piece-back",
        "Previous piece",
        "Selects the previous wall, end or waypoint, as Page Up does.",
    ),
    ButtonSpec::new(
        "piece-on",
        "Next piece",
        "Selects the next wall, end or waypoint, as Page Down does.",
    ),
    ButtonSpec::new(
        "west",
        "Left",
        "Moves the selection 5 cm to the left, or turns the starting heading clockwise, as the arrow key does.",
    ),
    ButtonSpec::new(
        "east",
        "Right",
        "Moves the selection 5 cm to the right, or turns the starting heading anticlockwise, as the arrow key does.",
    ),
    ButtonSpec::new(
        "north",
        "Up",
        "Moves the selection 5 cm up, or turns the starting heading anticlockwise, as the arrow key does.",
    ),
    ButtonSpec::new(
        "south",
        "Down",
        "Moves the selection 5 cm down, or turns the starting heading clockwise, as the arrow key does.",
    ),
    ButtonSpec::new(
        "remove",
        "Remove",
        "Removes the selected wall or waypoint, as Delete does.",
    ),
    ButtonSpec::new(
        "add-wall",
        "Add a wall",
        "Adds a wall one metre long in the middle, and selects it.",
    ),
    ButtonSpec::new(
        "add-way-point",
        "Add a waypoint",
        "Adds a waypoint after the selected one, or at the end, and selects it.",
    ),
    ButtonSpec::new(
        "turn-here",
        "Revisit starts here",
        "From the selected waypoint on, the robot revisits known places. The map from there on is compared with the map up to there.",
    ),
    ButtonSpec::new(
        "take-back",
        "Undo edit",
        "Undoes the last change to the floor plan, as Ctrl+Z does.",
    ),
    ButtonSpec::new(
        "do-again",
        "Redo edit",
        "Redoes the last undone change, as Ctrl+Y does.",
    ),
    ButtonSpec::new(
        "open-flat",
        "Open a flat",
        "Opens a world from a JSON file that slam2d --world reads.",
    ),
    ButtonSpec::new(
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

/// Controls that are shown only during editing.
pub const FLAT_CONTROLS: [&str; FLAT_BUTTONS.len() + 2] = {
    let mut ids = [PIECE.spec.id; FLAT_BUTTONS.len() + 2];
    ids[1] = PIECE_NUMBER.spec.id;
    let mut index = 0;
    while index < FLAT_BUTTONS.len() {
        ids[index + 2] = FLAT_BUTTONS[index].id;
        index += 1;
    }
    ids
};

/// The parts shown during editing: the map as large as it gets, the tools, and a way back.
pub const EDITING: Opening = Opening {
    panels: &["map"],
    params: &["edit"],
    buttons: &["play", "edit-flat", "take-back"],
};

params! {
    pub(super) static WORLD: OneOf<Option<BuiltInWorld>> = one_of!(
        Option<BuiltInWorld>,
        "world",
        "world",
        &optional::<_, { BuiltInWorld::NAMED.len() + 1 }>(
            BuiltInWorld::NAMED,
            BuiltInWorld::NAMED.len(),
            ["own", "your own flat"],
        ),
    )
    .help("The world the robot drives through. The Apartment uses the chapter's estimator; every other world uses the default one.");

    pub(super) static EDIT: OneOf<Option<Tool>> = one_of!(
        Option<Tool>,
        "edit",
        "tool on the map",
        &[
            (None, "off", "off"),
            (Some(Tool::Move), "move", "hand"),
            (Some(Tool::Wall), "wall", "pencil"),
            (Some(Tool::Way), "way", "way"),
            (Some(Tool::Remove), "remove", "eraser"),
            (Some(Tool::Robot), "robot", "robot"),
        ],
    )
    .help("What a press on the map does. The hand moves a wall, an end, a waypoint or the robot; the pencil draws a wall; the others place a waypoint after the selected one, remove something, or set the robot down. Everything snaps to a grid of 5 cm.");

    pub(super) static PIECE: OneOf<Option<usize>> = one_of!(
        Option<usize>,
        "piece",
        "piece of the flat",
        &[
            (None, "nothing", "nothing"),
            (Some(0), "wall", "a wall"),
            (Some(1), "first-end", "its first end"),
            (Some(2), "second-end", "its second end"),
            (Some(3), "way-point", "a waypoint"),
            (Some(4), "start", "the start"),
            (Some(5), "heading", "its heading"),
        ],
    )
    .help("The piece that the arrows move and Remove deletes. Press a piece on the map to select it.");

    pub(super) static PIECE_NUMBER: Param<usize> =
        Param::typed("piece-number", "number of the piece", MAX_PIECES)
            .default(1.0)
            .help("The number of the selected wall or waypoint, counted from 1.");

    pub(super) static FLAT: Param<String> = Param::text("flat", "your flat as text", MAX_FLAT)
        .help("The walls, start and waypoints of your own floor plan, to the centimetre, in the form used in links. Setting it makes that plan the world.");

    use NOISE;
    use LOOPS;

    pub(super) static SEED: Param<u32> = seed(lap::CANONICAL_SEED);

    pub(super) static GATE: Param<f64> = Param::slider("gate", "gate quantile", [0.90, 0.999], 0.001)
        .default(CHAPTER_QUANTILE)
        .help("Quantile of χ² with 3 degrees of freedom; 0.95 means χ² up to 7.815. This share of true loops passes if the robot stands still; after a drive, a smaller share passes.");

    pub(super) static GATE_MODEL: OneOf<GateModel> = one_of!(
        GateModel,
        "gate-model",
        "drift in the gate",
        &[
            (GateModel::PathApproximation, "path", "path"),
            (GateModel::ExactMarginal, "exact", "exact"),
        ],
    )
    .help("Path: the chapter's gate, which grows with the number of nodes between the two ends. Exact: the covariance of their relative pose in the graph. The outline shows which positions pass at the registered heading.");

    pub(super) static MATCHER: OneOf<LapMatcher> = one_of!(
        LapMatcher,
        "matcher",
        "matcher",
        LapMatcher::NAMED,
    )
    .help("What registers each sweep, in the front end and for loops: the chapter's ICP, point-to-point or point-to-plane, or the normal distributions transform.");

    pub(super) static INFORMATION: OneOf<InformationFrame> = one_of!(
        InformationFrame,
        "information",
        "information",
        InformationFrame::NAMED,
    )
    .help("The frame in which an edge's information is expressed. For the chapter's figures, it is rotated by a world heading; the exact frame is the frame of the edge's target, its newer end.");

    pub(super) static NORMALS: Param<f64> = Param::slider("normals", "radius of the normals", [0.0, 8.0], 0.1)
        .unit("cells")
        .help("A point's normal comes from its neighbours within this radius, in cells of 12 cm. 0 is the matcher's default: 2.5, or 4.2 for point-to-plane.");

    pub(super) static CAP: Param<bool> = Param::switch("cap", "cap on the information")
        .on()
        .help("Whether the information of an edge is capped at 2500, which corresponds to a standard deviation of 2 cm or 0.02 rad.");

    pub(super) static MISSES: Param<bool> = Param::switch("misses", "keep beams that hit no wall")
        .help("A beam that hits no wall reports the maximum range. Keeping these as points is a common mistake. They form a wall that moves with the robot.");

    pub(super) static PICK: OneOf<Picked> = one_of!(
        Picked,
        "pick",
        "look at",
        &[
            (Picked::Nothing, "nothing", "nothing"),
            (Picked::Keyframe, "keyframe", "a keyframe"),
            (Picked::Edge, "edge", "an edge"),
            (Picked::Loop, "loop", "a loop"),
        ],
    )
    .help("The part of the graph whose numbers are shown. Click or tap it on the map to select it, or an empty spot to select none.");

    pub(super) static NUMBER: Param<usize> = Param::typed("number", "number", MAX_NODES)
        .help("The number of the keyframe, of the edge's first keyframe, or of the loop's newer keyframe.");

    pub(super) static OWN: OneOf<Option<Claim>> = one_of!(
        Option<Claim>,
        "own",
        "your own loop",
        &optional::<_, { Claim::NAMED.len() + 1 }>(Claim::NAMED, 0, ["none", "none"]),
    )
    .help("A loop between any two keyframes. Registered: found by registering their sweeps, starting from their poses in the graph. The truth: their true relative pose, which no robot knows. “The same place”: the claim, right or wrong, that both are at one position.");

    pub(super) static OWN_FROM: Param<usize> =
        Param::typed("own-from", "your loop: from keyframe", MAX_NODES)
            .default(40.0)
            .help(
                "One end of your own loop. On the map, drag from the selected keyframe to any other.",
            );

    pub(super) static OWN_TO: Param<usize> =
        Param::typed("own-to", "your loop: to keyframe", MAX_NODES)
            .default(12.0)
            .help("The other end of your own loop.");

    pub(super) static OWN_GATE: Param<bool> =
        Param::switch("own-gate", "your loop must pass the gate")
            .on()
            .help("Whether the tests may reject your own loop: the fit, the pairs and the gate if it is registered, but only the gate if it is asserted.");

    pub(super) static KERNEL: OneOf<OwnKernel> = one_of!(
        OwnKernel,
        "kernel",
        "kernel of your loop",
        OwnKernel::NAMED,
    )
    .help("The kernel for your own loop: plain least squares, Huber's kernel, which acts beyond 1.345 standard deviations, or dynamic covariance scaling, which acts beyond a χ² of 10.");

    pub(super) static WIPE: Param<f64> = Param::slider("wipe", "before and after", [0.0, 1.0], 0.01)
        .default(0.45)
        .help("At a closed loop, the map before it is shown left of the line, and the map after it right of the line. The line's position is a share of the map's width.");

    pub(super) static TICK: Param<f64> = Param::timeline("t", "tick", MAX_TICKS)
        .default(FIRST_LOOP_TICK)
        .help("The moment shown. A tick is a quarter of a second, each mark is a loop, and values past the end show the end.");

    pub(super) static SHOW: OneOf<Layers> = one_of!(
        Layers,
        "show",
        "show",
        &[
            (Layers::Wheels, "wheels", "wheels alone"),
            (Layers::Map, "map", "the map"),
            (Layers::Loops, "loops", "map and loops"),
            (Layers::Truth, "truth", "what is left"),
            (Layers::All, "all", "everything"),
        ],
    )
    .default("loops")
    .help("The layers of the map. Wheels alone: where odometry and the truth put the robot. The map: the walls that the sweeps saw. Map and loops: the graph with its loops as well. What is left: the truth as well. Everything: also odometry, and the front end alone.");

    pub(super) static FUTURE: Param<bool> = Param::switch("future", "show what is to come")
        .help("Plots the whole lap, including what comes after the moment shown.");

    use SPEED;
    use MORE;
}

/// All buttons.
const BUTTONS: &[&[ButtonSpec]] = &[
    &[PLAY, STEP, RESET],
    LOOP_BUTTONS,
    GRAPH_BUTTONS,
    &[EDIT_FLAT],
    FLAT_BUTTONS,
    &[DEFAULTS],
];

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.2",
    name: "The full lap",
    title: "How far off is a lap’s map at the end, and what do loops correct?",
    claim: "A loop does not correct every pose.",
    gesture: "Press Play, or drag the timeline.",
    awaits: Awaits::Nothing,
    notice: &[
        "The walls seen on the outbound and return legs are apart, and one loop brings them together. Over the lap, the map's disagreement falls to about a third.",
        "The typical error over the keyframes barely changes, and the largest even grows a little. The corridor comes out almost a metre too short, and no loop can see that.",
        "A loop moves poses that the robot left long ago. A filter that keeps only the newest pose could not do that.",
        "Click a keyframe, and drag from it to another to add your own loop. If it is wrong, every edge between its ends pays a little. A kernel gives it little weight.",
        "A small χ² is not enough: the sweep must also fit the old walls to 0.16 m, with at least 25 pairs.",
        "The exact gate adds up the covariances of the edges, and discriminates no better. Over seeds 1 to 50 at four times the noise, the chapter's gate accepts 75 of 131 true loops and 3 of 8 false ones, the exact gate 116 of 129 and 7 of 8. False means more than 0.3 m or 5° from the truth.",
    ],
    opening: Opening {
        panels: &["map"],
        params: &["show"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &buttons::<{ count(BUTTONS) }>(BUTTONS),
    presets: &[
        Preset {
            id: "first-loop",
            label: "Watch the first loop",
            help: "Node 29 recognizes the corridor at node 7. The robot's own error falls; the error over all keyframes rises.",
            set: &[TICK.to(FIRST_LOOP_TICK)],
            then: &["at"],
        },
        Preset {
            id: "rejected",
            label: "Seed 6: a loop is rejected",
            help: "The χ² is below the threshold, but the sweep fits the old walls badly. Four keyframes later a better match passes.",
            set: &[SEED.to(6), TICK.to(90.0)],
            then: &[],
        },
        Preset {
            id: "no-loops",
            label: "Switch the loops off",
            help: "The front end alone, with the same sweeps. The map's two passes end 0.24 m apart instead of 0.08 m.",
            set: &[LOOPS.to(false), TICK.to(LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "noisy",
            label: "Four times the noise",
            help: "Odometry ends almost 5 m out, the front end holds, and the last loop closes at the last tick.",
            set: &[NOISE.to(4.0), TICK.to(LAP_TICKS), SHOW.to("all")],
            then: &[],
        },
        Preset {
            id: "tight-gate",
            label: "A tight gate on a noisy lap",
            help: "At the 0.90 quantile the gate rejects a loop that the chapter's gate accepts.",
            set: &[NOISE.to(4.0), GATE.to(0.90), TICK.to(116.0)],
            then: &[],
        },
        Preset {
            id: "locked-out",
            label: "True loops, locked out",
            help: "Seed 2 at three times the noise drifts more than the gate allows for. The gate rejects three true loops, and the drift goes on.",
            set: &[SEED.to(2), NOISE.to(3.0), TICK.to(LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "let-in",
            label: "The same lap, exact gate",
            help: "The chapter's gate rejects the first loop for its heading alone. The edges are less sure of the heading, so the exact gate accepts all three loops, and the lap ends more than a metre closer to the truth.",
            set: &[
                SEED.to(2),
                NOISE.to(3.0),
                GATE_MODEL.to("exact"),
                TICK.to(94.0),
            ],
            then: &[],
        },
        Preset {
            id: "wrong-loop",
            label: "A false loop, forced in",
            help: "“Keyframes 40 and 12 are the same place” is a lie of 6 m. Without the gate, it folds the map. The history moves by up to 3.8 m, and every edge between the two is strained.",
            set: &[
                OWN.to("same-place"),
                OWN_FROM.to(40),
                OWN_TO.to(12),
                OWN_GATE.to(false),
                WIPE.to(0.2),
                TICK.to(LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "tamed-loop",
            label: "The same lie, tamed",
            help: "Dynamic covariance scaling gives almost no weight to a loop that is far out. No pose moves.",
            set: &[
                OWN.to("same-place"),
                OWN_FROM.to(40),
                OWN_TO.to(12),
                OWN_GATE.to(false),
                KERNEL.to("dcs"),
                TICK.to(LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "true-loop",
            label: "A true loop that the gate rejects",
            help: "A loop with the true relative pose, from keyframe 25 on the return leg to the start. The typical error over the keyframes falls from 0.59 m to 0.14 m. At a χ² of 13.0 the gate rejects it, because drift does not explain it.",
            set: &[
                OWN.to("truth"),
                OWN_FROM.to(25),
                OWN_TO.to(0),
                OWN_GATE.to(false),
                TICK.to(LAP_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "ring",
            label: "A ring that closes",
            help: "The robot drives around a block, back to the start from the other side, and registers point-to-plane. The chain is held at both ends.",
            set: &[
                WORLD.to("ring"),
                MATCHER.to("p2l"),
                INFORMATION.to("exact"),
                TICK.to(RING_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "twins",
            label: "Two rooms alike",
            help: "The second room looks like the first, and after so long a path, the gate is wide enough to let it pass. The robot closes a false loop, and the two rooms become one.",
            set: &[
                WORLD.to("twins"),
                INFORMATION.to("exact"),
                TICK.to(TWINS_TICKS),
            ],
            then: &[],
        },
        Preset {
            id: "corridor",
            label: "A bare corridor",
            help: "Along the corridor, the laser measures nothing, and point-to-point drags each sweep back. The map agrees with itself, but the corridor is a fraction of its true length.",
            set: &[
                WORLD.to("corridor"),
                INFORMATION.to("exact"),
                TICK.to(CORRIDOR_TICKS),
                SHOW.to("truth"),
            ],
            then: &[],
        },
        Preset {
            id: "hall",
            label: "A round hall",
            help: "The wall fixes the position but not the heading. With point-to-plane, the robot ends on the far side of the hall, yet the map agrees with itself to three centimetres.",
            set: &[
                WORLD.to("hall"),
                MATCHER.to("p2l"),
                INFORMATION.to("exact"),
                TICK.to(HALL_TICKS),
                SHOW.to("truth"),
            ],
            then: &[],
        },
        Preset {
            id: "phantom-wall",
            label: "Keep beams that hit no wall",
            help: "The most common mistake. Readings at the maximum range become points, which travel with the robot and drag it back. The typical error over the keyframes grows from 0.59 m to 0.89 m, even though the lap ends closer to the truth and the map agrees with itself.",
            set: &[MISSES.to(true), TICK.to(LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "bells",
            label: "The same lap with NDT",
            help: "The same sweeps, matched to Gaussians instead of points. The lap ends 0.04 m out instead of 0.24 m.",
            set: &[MATCHER.to("ndt"), TICK.to(LAP_TICKS)],
            then: &[],
        },
        Preset {
            id: "sliding",
            label: "The same lap, point-to-plane",
            help: "The same sweeps, with each point free to slide along its wall. The lap ends 0.05 m out instead of 0.24 m.",
            set: &[MATCHER.to("p2l"), TICK.to(LAP_TICKS)],
            then: &[],
        },
    ],
};
