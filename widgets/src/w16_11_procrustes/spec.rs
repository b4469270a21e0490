//! The widget's texts and its list of parameters.

use ch16_lab::procrustes::{Handedness, Shape};
use widget_kit::disclosure::Opening;
use widget_kit::param::{MORE, OneOf, Param};
use widget_kit::playback::SPEED;
use widget_kit::spec::{Awaits, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::{one_of, params};

/// Pairs of the largest scene.
pub const MAX_PAIRS: usize = 5;

/// Largest displacement of a target point, m.
pub const REACH_M: f64 = 3.0;

/// A whole turn, °.
pub const WHOLE_TURN_DEG: f64 = 360.0;

/// The parameters that move a point of the target along x and y.
macro_rules! point {
    ($number:literal) => {
        [
            moved(
                concat!("x", $number),
                concat!("target ", $number, ": moved in x"),
            ),
            moved(
                concat!("y", $number),
                concat!("target ", $number, ": moved in y"),
            ),
        ]
    };
}

/// The parameters of each point.
pub(super) static MOVED: [[Param<f64>; 2]; MAX_PAIRS] =
    [point!(1), point!(2), point!(3), point!(4), point!(5)];

const fn moved(id: &'static str, label: &'static str) -> Param<f64> {
    Param::slider(id, label, [-REACH_M, REACH_M], 0.05)
        .unit("m")
        .help("How far the point has been dragged. Applies only to points in the scene.")
}

params! {
    pub(super) static SHAPE: OneOf<Shape> = one_of!(
        Shape,
        "shape",
        "what is seen twice",
        &[
            (Shape::Corners, "corners", "four corners"),
            (Shape::Two, "two", "two points"),
            (Shape::Wall, "wall", "a bare wall"),
            (Shape::UpsideDown, "upside-down", "upside down"),
        ],
    )
    .default("upside-down")
    .help(
        "Paired points from two sweeps. In the last scene, the sensor hung upside down for the second sweep.",
    );

    pub(super) static TRIED: OneOf<Handedness> = one_of!(
        Handedness,
        "tried",
        "matrices tried",
        &[
            (Handedness::Turn, "turns", "rotations"),
            (Handedness::Mirror, "mirrors", "mirror images"),
        ],
    )
    .help("The source is rotated, or mirrored and then rotated. Together these are all the orthogonal matrices.");

    pub(super) static SEED: Param<u32> = Param::seed("seed of the noise", 1)
        .help("Seed of the noise in both sweeps, which has a standard deviation of 12 mm along each axis.");

    use MOVED[0 1 2 3 4][0 1];

    pub(super) static TURN: Param<f64> = Param::timeline("turn", "angle tried", WHOLE_TURN_DEG)
        .unit("°")
        .help("How far the source is rotated, after mirroring if any.");

    use SPEED;
    use MORE;
}

/// The constant description of the widget.
pub const SPEC: WidgetSpec = WidgetSpec {
    id: "w16.11",
    name: "Turn or mirror image",
    title: "Can the best fit be a mirror image?",
    claim: "The best fit may be a mirror image.",
    gesture: "Drag a corner across the middle, then let it go.",
    awaits: Awaits::Rest,
    notice: &[
        "Over a full turn the trace is one sinusoid. It has one peak, and the closed form gives its angle.",
        "Mirror images have their own sinusoid. The higher of the two peaks is the sum of the singular values, and no trace exceeds it.",
        "For two points, or points on a line, both peaks are equally high. Along a bare wall, noise decides which is higher.",
        "A mirrored map fits its points as well as any, but its doors are on the wrong side. Compare the two floor plans.",
    ],
    opening: Opening {
        panels: &["points"],
        params: &["shape"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[
        Preset {
            id: "corners",
            label: "Turn four corners",
            help: "The trace climbs to its bound at one angle and falls again. The mirror images stay far below.",
            set: &[SHAPE.to("corners")],
            then: &["play"],
        },
        Preset {
            id: "two-points",
            label: "Two points only",
            help: "Rotation and mirror image reach the same bound, because two points cannot tell left from right.",
            set: &[SHAPE.to("two")],
            then: &["play"],
        },
        Preset {
            id: "bare-wall",
            label: "A bare wall",
            help: "The wall fixes the line, and noise picks the side. Here the mirror image fits a little better.",
            set: &[SHAPE.to("wall"), SEED.to(2), TRIED.to("mirrors")],
            then: &["play"],
        },
        Preset {
            id: "upside-down",
            label: "Hang the sensor upside down",
            help: "A mirror image fits to within the noise and hides the mistake. The best rotation’s cost gives it away.",
            set: &[SHAPE.to("upside-down"), TRIED.to("mirrors")],
            then: &["play"],
        },
    ],
};
