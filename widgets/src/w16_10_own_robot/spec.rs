//! The widget's texts and its list of parameters.

use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, Named, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, ButtonSpec, DEFAULTS, PLAY, Preset, WidgetSpec};
use widget_kit::{one_of, params};

/// The quantity that colours the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Position on the timeline.
    Time,
    /// Share of each scan that fits.
    Fit,
    /// Standard deviation of the position.
    Sigma,
    /// Error against a reference.
    Error,
}

/// Which loops the map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownLoops {
    /// None.
    None,
    /// Those of the graph.
    InGraph,
    /// The rejected ones as well.
    All,
}

/// An upper bound of the number of keyframes, beyond the end of every timeline.
pub const MAX_KEYFRAMES: f64 = 999_999.0;

/// An upper bound of the number of scans.
pub const MAX_SCANS: f64 = 99_999_999.0;

/// The options of recordings, with their names of the command line.
pub const RECORDING_OPTIONS: &[Named<&str>] = &[
    ("scan-topic", "scan-topic", "scan topic"),
    ("odom-topic", "odom-topic", "odometry topic"),
    ("odom-frame", "odom-frame", "odometry frame"),
    ("body-frame", "body-frame", "body frame"),
];

params! {
    pub(super) static COLOUR: OneOf<Colour> = one_of!(
        Colour,
        "colour",
        "colour the path by",
        &[
            (Colour::Time, "time", "time"),
            (Colour::Fit, "fit", "fit"),
            (Colour::Sigma, "sigma", "σ"),
            (Colour::Error, "error", "error"),
        ],
    )
    .help("What the colours show: time, the share of each scan that fits, the graph's standard deviation, or the error against your reference.");

    pub(super) static LOOPS: OneOf<ShownLoops> = one_of!(
        ShownLoops,
        "links",
        "show loops",
        &[
            (ShownLoops::None, "none", "none"),
            (ShownLoops::InGraph, "closed", "closed"),
            (ShownLoops::All, "all", "all"),
        ],
    )
    .default("closed")
    .help("Which loops the map shows: none, the accepted ones, or the rejected ones as well.");

    pub(super) static LOOP: Param<usize> = Param::typed("loop", "listed loop", MAX_KEYFRAMES)
        .help("The loop whose evidence is shown; loop 0 fits the graph worst.");

    pub(super) static MARKED: Param<usize> = Param::typed("marked", "marked keyframe", MAX_KEYFRAMES)
        .help("One end of a loop you add; the other end is the keyframe shown.");

    pub(super) static POOR: Param<f64> =
        Param::slider("poor", "look into scans that fit less than", [0.0, 1.0], 0.05)
            .default(0.5)
            .help("Keyframes with a smaller share of fitting points are ringed on the map, and “Next doubt” stops there.");

    pub(super) static FILE: OneOf<&'static str> = one_of!(
        &'static str,
        "file",
        "file to save",
        &[
            ("map.pgm", "map-pgm", "map.pgm"),
            ("map.yaml", "map-yaml", "map.yaml"),
            ("map.png", "map-png", "map.png"),
            ("trajectory.tum", "trajectory", "trajectory.tum"),
            ("graph.g2o", "graph", "graph.g2o"),
            ("report.html", "report", "report.html"),
            ("session.slam2d", "session", "session.slam2d"),
            ("where.tum", "where", "where.tum"),
        ],
    )
    .help("The map for Nav2, the trajectory as TUM, the graph as g2o, a report with pictures, the session (to continue later), or the poses of the other log’s robot.");

    // Whether the other log starts at the keyframe shown.
    pub(super) static STARTS_HERE: OneOf<bool> = one_of!(
        bool,
        "start",
        "look for the robot",
        &[
            (false, "anywhere", "anywhere"),
            (true, "here", "at the keyframe shown"),
        ],
    )
    .help("Where the other log begins on this map: anywhere, or within 1.5 m and 34° of the keyframe shown.");

    pub(super) static SCAN: Param<usize> = Param::typed("scan", "scan of the other log", MAX_SCANS)
        .default(MAX_SCANS)
        .help("The scan of the other log whose pose is shown; values past the end show the last scan.");

    // What the page does with a log that is dropped, as it is named to the page.
    pub(super) static DROP: OneOf<&'static str> = one_of!(
        &'static str,
        "drop",
        "a dropped log",
        &[
            ("map", "map", "becomes the map"),
            ("where", "where", "is localized on it"),
        ],
    )
    .help("Whether a dropped log is mapped, or its robot is localized on the current map.");

    pub(super) static OPTION: OneOf<&'static str> = one_of!(
        &'static str,
        "option",
        "what to change",
        RECORDING_OPTIONS,
    )
    .help("What “Take another” changes if a recording offers more than one: the scan topic, the odometry topic, the odometry frame, or the body frame.");

    pub(super) static KEYFRAME: Param<usize> = Param::timeline("keyframe", "keyframe", MAX_KEYFRAMES)
        .default(MAX_KEYFRAMES)
        .help("The keyframe whose scan is drawn over the map.");

    use SPEED;
    use MORE;
}

/// Keys of the buttons that move a keyframe.
pub const KEYS: &[(&str, &str)] = &[
    ("ArrowLeft", "west"),
    ("ArrowRight", "east"),
    ("ArrowUp", "north"),
    ("ArrowDown", "south"),
];

/// The parts shown before a log is opened; no other part has anything to do.
pub const WITHOUT_LOG: Opening = Opening {
    panels: &["map"],
    params: &[],
    buttons: &["open", "sample"],
};

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.10",
    name: "Your own robot",
    title: "How far astray do wheels lead a robot?",
    claim: "Revisited places correct the wheels' drift.",
    gesture: "Open a log of your robot, or watch the sample being mapped.",
    awaits: Awaits::Nothing,
    notice: &[
        "Loops are sorted by how strongly the rest of the graph contradicts them. Reject one, and the graph is solved again at once.",
        "Look where a scan fits badly: glass, people, or a wrong pose.",
        "A graph with small standard deviations may still be wrong. The innovations of odometry can show a bias; an external reference shows the error itself.",
    ],
    opening: Opening {
        panels: &["map"],
        params: &["colour"],
        buttons: &["open", "play", "sample", "cancel"],
    },
    params: PARAMS,
    buttons: &[
        ButtonSpec::new(
            "open",
            "Open a log…",
            "Opens a CARMEN, ROS 1 or ROS 2 log, a saved session, or a pose graph. You can also drop it on the picture. It stays in this browser.",
        ),
        ButtonSpec {
            help: "Maps the sample if no log is open, pauses or resumes a log while it is being read, and plays back the path once the log is mapped.",
            ..PLAY
        },
        ButtonSpec::new(
            "sample",
            "Watch the sample",
            "Maps a log from the simulator's ring of corridors, and grades it against the truth.",
        ),
        ButtonSpec::new("cancel", "Stop", "Stops reading, and keeps what was read."),
        ButtonSpec::new(
            "doubt",
            "Next doubt",
            "Goes to the next keyframe whose registration or loop should be checked.",
        ),
        ButtonSpec::new(
            "previous",
            "Previous loop",
            "Shows the previous loop in the list.",
        ),
        ButtonSpec::new("next", "Next loop", "Shows the next loop in the list."),
        ButtonSpec::new(
            "turn",
            "Reject or close",
            "Removes the loop shown from the graph, or adds it; the graph is solved at once.",
        ),
        ButtonSpec::new(
            "mark",
            "Mark",
            "Marks the keyframe shown as one end of a loop.",
        ),
        ButtonSpec::new(
            "add",
            "Close with mark",
            "Registers the keyframe shown against the map around the marked one, and closes the loop if it passes the tests.",
        ),
        ButtonSpec::new(
            "west",
            "Left",
            "Moves the keyframe shown 5 cm to the left, as the arrow key does.",
        ),
        ButtonSpec::new(
            "east",
            "Right",
            "Moves the keyframe shown 5 cm to the right, as the arrow key does.",
        ),
        ButtonSpec::new(
            "north",
            "Up",
            "Moves the keyframe shown 5 cm up, as the arrow key does.",
        ),
        ButtonSpec::new(
            "south",
            "Down",
            "Moves the keyframe shown 5 cm down, as the arrow key does.",
        ),
        ButtonSpec::new("unpin", "Let go", "Releases the keyframes you moved."),
        ButtonSpec::new(
            "reference",
            "Grade…",
            "Opens a file of relations or true poses, and compares the path with it.",
        ),
        ButtonSpec::new(
            "locate",
            "Where am I?…",
            "Opens another log of the same place, and localizes its robot on this map.",
        ),
        ButtonSpec::new(
            "locate-sample",
            "Another day",
            "Localizes the sample’s robot on this map on another day. It is switched on halfway round.",
        ),
        ButtonSpec::new(
            "change",
            "Next verdict",
            "Goes to the next scan of the other log where the robot is found or lost.",
        ),
        ButtonSpec::new(
            "other",
            "Take another",
            "Maps the recording again, with its next topic or frame.",
        ),
        ButtonSpec::new("save", "Save", "Saves the selected file."),
        ButtonSpec {
            label: "Start over",
            help: "Closes the log, and resets every setting to its default.",
            ..DEFAULTS
        },
    ],
    presets: &[
        Preset {
            id: "sure",
            label: "How sure is the graph?",
            help: "The sample, coloured by each keyframe's standard deviation. It grows with distance from the start, and loops limit it.",
            set: &[COLOUR.to("sigma")],
            then: &["sample"],
        },
        Preset {
            id: "error",
            label: "How wrong is it?",
            help: "The sample, coloured by its error against the truth.",
            set: &[COLOUR.to("error")],
            then: &["sample"],
        },
        Preset {
            id: "where",
            label: "Where am I, another day?",
            help: "The sample's map, on another day. The robot is switched on halfway round and localizes itself.",
            set: &[],
            then: &["sample", "locate-sample"],
        },
    ],
};
