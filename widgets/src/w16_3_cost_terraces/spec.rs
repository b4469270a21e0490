//! The widget's texts and its list of parameters.

use ch16_lab::terrain::TerrainScene;
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Largest shift of the maps from the truth in every direction, m.
pub const HALF_SPAN_M: f64 = 1.3;

/// Smallest and largest number of cells on a side; both odd, so that one cell is at the truth.
const CELLS_OF_A_SIDE: [f64; 2] = [49.0, 161.0];

/// Largest number of steps of a ball.
pub const MAX_BALL_STEPS: usize = 400;

/// Largest number of sweeps that are dropped at once.
pub const MAX_DROPS: f64 = 100.0;

/// Upper end of the slider of rows, which selects all rows of any sweep.
pub const MAX_ROWS: f64 = 120.0;

/// Location of the sweep, and its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepPlace {
    /// Room A: walls in both directions. The sweep is its own map.
    Room,
    /// A corridor without doors: walls along x alone. Map and sweep have independent noise.
    Corridor,
    /// The Apartment's corridor, with its doors. The sweep is its own map.
    OwnCorridor,
}

/// The measure that the relief shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReliefMeasure {
    /// ICP's truncated cost.
    Icp,
    /// NDT's score.
    Ndt,
}

/// What determines a cell's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colors {
    /// Its height, evenly from dark to bright.
    ByHeight,
    /// The share of cells that lie lower.
    ByRank,
}

/// The end of the timeline: a part of the path, because the balls need different numbers of steps.
pub const END_PERCENT: f64 = 100.0;

/// Drops many sweeps, each with independent noise.
const DROP_100: ButtonSpec = ButtonSpec {
    id: "drop-100",
    label: "Drop 100",
    help: "Drop 100 sweeps, each with independent noise, and watch them settle.",
};

/// "What to try".
const PRESETS: &[Preset] = &[
    Preset {
        id: "terraces",
        label: "Shrink τ to 0.15 m",
        help: "ICP's bowl shrinks, creases cross the plain around it, and its ball stops between them. NDT's ball rolls home.",
        set: &[
            ("tau", 0.15),
            ("colours", 1.0),
            ("probe-x", 0.3),
            ("probe-y", -0.3),
        ],
        then: &["play"],
    },
    Preset {
        id: "bowl",
        label: "Widen τ to 0.6 m",
        help: "The steps melt into one bowl, and both balls come home. Beyond 0.6 m, the ground is as flat as before.",
        set: &[("tau", 0.6), ("colours", 0.0)],
        then: &["play"],
    },
    Preset {
        id: "wide-hill",
        label: "Widen the NDT cell to 0.8 m",
        help: "The bells become longer and fewer. From this start, NDT's ball comes home, but ICP's ball rolls further away.",
        set: &[
            ("tau", 0.6),
            ("colours", 0.0),
            ("ndt-cell", 0.8),
            ("probe-x", -0.7),
            ("probe-y", 0.7),
        ],
        then: &["play"],
    },
    Preset {
        id: "wide-tau",
        label: "Widen τ to 1.6 m",
        help: "Every point is matched now. ICP's ball comes home from here; NDT's does not.",
        set: &[
            ("tau", 1.6),
            ("colours", 0.0),
            ("probe-x", 0.7),
            ("probe-y", 0.7),
        ],
        then: &["play"],
    },
    Preset {
        id: "corridor",
        label: "Stand in the corridor",
        help: "Both valleys run along the walls and never end. The balls roll to the middle, but do not move along the wall.",
        set: &[
            ("scene", 1.0),
            ("tau", 0.6),
            ("colours", 0.0),
            ("probe-x", 0.6),
            ("probe-y", 0.05),
        ],
        then: &["play"],
    },
    Preset {
        id: "wrong-wall",
        label: "Drop it across the corridor",
        help: "From here the south wall looks like the north wall, and both balls settle on the wrong one.",
        set: &[
            ("scene", 1.0),
            ("tau", 0.6),
            ("colours", 0.0),
            ("probe-x", 0.2),
            ("probe-y", 1.1),
        ],
        then: &["play"],
    },
    Preset {
        id: "own-corridor",
        label: "Match the corridor with itself",
        help: "The sweep recognizes its own noise and the doors, and the cost is lowest at the truth. A second sweep would not be so sure.",
        set: &[
            ("scene", 2.0),
            ("tau", 0.6),
            ("colours", 0.0),
            ("probe-x", 0.6),
            ("probe-y", 0.0),
        ],
        then: &["play"],
    },
    Preset {
        id: "drop-room",
        label: "Drop 100 sweeps in the room",
        help: "They settle in a round heap with a standard deviation of a millimetre, about what the information predicts.",
        set: &[("tau", 0.6), ("colours", 0.0)],
        then: &["drop-100"],
    },
    Preset {
        id: "drop-corridor",
        label: "Drop 100 sweeps in the corridor",
        help: "They settle in a streak along the walls, much longer than the information predicts.",
        set: &[("scene", 1.0), ("tau", 0.6), ("colours", 0.0)],
        then: &["drop-100"],
    },
    Preset {
        id: "one-row",
        label: "Take the corridor's rows one by one",
        help: "Start with one row, and add more with the slider. A second distinct row raises the rank to two; no further row raises it to three.",
        set: &[("scene", 1.0), ("rows", 1.0)],
        then: &[],
    },
    Preset {
        id: "turned",
        label: "Turn the sweep by 20°",
        help: "No shift undoes a rotation. The lowest cost rises, and NDT's lowest cell leaves the truth.",
        set: &[("tau", 0.6), ("colours", 0.0), ("heading", 20.0)],
        then: &["play"],
    },
];

params! {
    pub(super) static MEASURE: OneOf<ReliefMeasure> = one_of!(
        ReliefMeasure,
        "measure",
        "relief of",
        &[
            (ReliefMeasure::Icp, "icp", "ICP"),
            (ReliefMeasure::Ndt, "ndt", "NDT"),
        ],
    )
    .help("ICP's cost or NDT's score, for the same sweep on the same points. The relief morphs from one to the other.");

    pub(super) static SCENE: OneOf<SweepPlace> = one_of!(
        SweepPlace,
        "scene",
        "scene",
        &[
            (SweepPlace::Room, "room", "room"),
            (SweepPlace::Corridor, "corridor", "corridor"),
            (SweepPlace::OwnCorridor, "own-corridor", "corridor on itself"),
        ],
    )
    .help("Room A, matched with its own points; a corridor without doors, matched with a map whose noise is independent; or the Apartment's corridor, with its doors, matched with its own points.");

    pub(super) static TAU: Param<f64> = Param::slider("tau", "pair limit τ", [0.1, 1.6], 0.05)
        .unit("m")
        .default(0.15)
        .help(
            "ICP pairs a point with the nearest map point within τ; an unmatched point costs τ².",
        );

    pub(super) static NDT_CELL: Param<f64> = Param::slider("ndt-cell", "NDT cell", [0.3, 1.2], 0.05)
        .unit("m")
        .default(TerrainScene::DEFAULT_NDT_CELL_M)
        .help("NDT fits one Gaussian to the map points of each cell of this width.");

    pub(super) static HEADING: Param<f64> =
        Param::slider("heading", "heading offset", [-180.0, 180.0], 1.0)
            .unit("°")
            .help("How far the sweep is turned about the sensor before it is shifted.");

    pub(super) static CELLS: Param<f64> = Param::slider("cells", "cells per side", CELLS_OF_A_SIDE, 8.0)
        .default(49.0)
        .help("The relief is sampled at this many shifts along each axis.");

    pub(super) static COLOURS: OneOf<Colors> = one_of!(
        Colors,
        "colours",
        "colours",
        &[
            (Colors::ByHeight, "value", "by value"),
            (Colors::ByRank, "rank", "by rank"),
        ],
    )
    .default("rank")
    .help("By rank, every colour covers the same number of cells, so shallow hollows show even on high ground.");

    pub(super) static SEED: Param<u32> = Param::seed("seed of the sweep", TerrainScene::SEED)
        .help("Seed of the range noise in the sweep; the chapter uses 1472.");

    pub(super) static PROBE_X: Param<f64> =
        Param::slider("probe-x", "drop at Δx", [-HALF_SPAN_M, HALF_SPAN_M], 0.05)
            .unit("m")
            .default(0.4)
            .help("How far east of the truth the crosshair is placed, which is where the ball starts.");

    pub(super) static PROBE_Y: Param<f64> =
        Param::slider("probe-y", "drop at Δy", [-HALF_SPAN_M, HALF_SPAN_M], 0.05)
            .unit("m")
            .default(0.1)
            .help("How far north of the truth the crosshair is placed, which is where the ball starts.");

    pub(super) static DROPS: Param<usize> =
        Param::slider("drops", "sweeps dropped", [0.0, MAX_DROPS], 1.0)
            .help("How many sweeps, each with its own noise, are dropped up to 0.3 m from the truth and registered point-to-plane with a τ of 0.6 m.");

    pub(super) static ROWS: Param<f64> = Param::slider("rows", "rows of the step", [0.0, MAX_ROWS], 1.0)
        .default(MAX_ROWS)
        .help("How many points, in beam order, contribute a row (n_x, n_y, p × n) to the point-to-plane step; at the right end, all of them do.");

    pub(super) static ODOMETRY: Param<f64> =
        Param::slider("odometry", "σ of an odometry row", [0.0, 0.5], 0.01)
            .unit("m")
            .help("Adds the row (1, 0, 0) with weight 1/σ²; 0 adds no row.");

    pub(super) static ROLLED: Param<f64> = Param::timeline("t", "% rolled", END_PERCENT)
        .help("How much of its path the ball has rolled, in steps of its descent.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.3",
    name: "Cost terraces",
    title: "Where does the ball roll home, and where does it stick?",
    claim: "The cost itself has false minima.",
    gesture: "Drag the ball, then let it go.",
    awaits: Awaits::End,
    notice: &[
        "Both reliefs compare the same sweep with the same points; only the measure differs. Dark is low, and the ball rolls into the dark.",
        "A small τ creases ICP's bowl and leaves hollows in it. The ball rests in the nearest hollow, however good the solver. The profile beside the relief shows the ball, and the pit it never reached.",
        "At each crease a point changes its match, or loses it, so the slope jumps and the height does not. Points about to change light up.",
        "NDT has no such creases, because each point feels the whole bell of its cell. But thin walls make thin bells, so the valley is narrow and the plain around it has dents of its own. Wider cells help.",
        "A wide τ lets ICP reach further than NDT. Neither measure wins everywhere.",
        "In the corridor both valleys run along x and never end. A hundred sweeps settle in a streak there, and in a round heap in the room. The ellipse is what the information promises.",
    ],
    opening: Opening {
        panels: &["relief", "path"],
        params: &["measure"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[DROP_100, PLAY, STEP, RESET, DEFAULTS],
    presets: PRESETS,
};
