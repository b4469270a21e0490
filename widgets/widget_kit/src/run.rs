//! The parameters of one lap of the robot, shared by all widgets that run it.

use crate::param::Param;

/// Noise factor of the odometry.
pub static NOISE: Param<f64> = Param::slider("noise", "odometry noise ×", [0.25, 4.0], 0.05)
    .default(1.0)
    .help("Multiplies the variances of the wheel odometry; at 1, the robot is the chapter's.");

/// Whether loops are closed.
pub static LOOPS: Param<bool> = Param::switch("loops", "loop closure")
    .on()
    .help("Whether a keyframe near an old one is matched against it.");

/// The seed of the lap; the caller passes the chapter's seed, because this crate does not depend on the core.
#[must_use]
pub const fn seed(chapters: u32) -> Param<u32> {
    Param::seed("seed", chapters).help(
        "A different seed gives a different lap with the same robot; the default is the chapter's.",
    )
}
