//! The faults that the comparison of scans and odometry can find.

use core::f64::consts::{PI, TAU};

use pr_geom::{SE2, wrap_angle};

use crate::laser_mount::LaserMount;

/// Mean cost of a scan with and without a repair, nats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// Number of scans.
    pub scans: usize,
    /// With the repair.
    pub with: f64,
    /// Without it.
    pub without: f64,
    /// Whether the repair is better in both halves of the scans, by more than chance.
    pub wins: bool,
}

/// A fault with its correction.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Turns are opposite: the scans are mirrored.
    Mirrored {
        /// Correlation of the turns.
        correlation: f64,
    },
    /// The odometry's headings turn opposite to its path: of its poses, either the heading or y has the wrong sign.
    Opposed {
        /// Whether it is the heading.
        is_heading: bool,
    },
    /// The laser faces another direction than stated.
    Turned {
        /// Difference, rad.
        by_rad: f64,
    },
    /// Odometry is not in metres.
    Unit {
        /// Factor that converts it to metres.
        metres: f64,
        /// Name of the unit.
        name: &'static str,
    },
    /// Odometry overestimates or underestimates lengths.
    Scale {
        /// Its length per metre by scans.
        ratio: f64,
    },
    /// Odometry overestimates or underestimates turns.
    TurnScale {
        /// Its turn per turn by scans.
        ratio: f64,
    },
    /// The beam that is listed last was measured first.
    Backward,
    /// Odometry stands still while scans move.
    Still {
        /// Path length by scans, m.
        moved_m: f64,
    },
    /// Turns do not correlate.
    Unlike {
        /// Correlation of the turns.
        correlation: f64,
    },
    /// A sweep takes several times the time between two scans, and its beams have no times.
    Swept {
        /// Time of a sweep over that between two scans.
        share: f64,
        /// Time of a sweep, s.
        sweep_s: f64,
    },
    /// Odometry has the stamps of another time.
    Late {
        /// Its lag behind the scans, s.
        by_s: f64,
    },
}

impl Finding {
    /// Whether it is about the laser rather than the odometry.
    pub(super) fn is_of_laser(&self) -> bool {
        self.is_of_mount() || matches!(self, Self::Backward | Self::Swept { .. })
    }

    /// Whether it is about the mounting of the laser.
    pub(super) fn is_of_mount(&self) -> bool {
        matches!(self, Self::Mirrored { .. } | Self::Turned { .. })
    }

    /// Whether it is only named, and left to the user.
    pub(super) fn is_left(&self) -> bool {
        matches!(self, Self::Scale { .. } | Self::Unlike { .. })
    }

    /// Corrects a mounting.
    pub(super) fn mend(&self, mount: &mut LaserMount) {
        match self {
            Self::Mirrored { .. } => mount.is_flipped = !mount.is_flipped,
            Self::Turned { by_rad } => {
                let [x, y, theta] = mount.body_from_sensor.to_array();
                // Lasers are mounted at right angles, or at an angle that this cannot estimate exactly.
                let looks = wrap_angle(theta + by_rad);
                let quarter = (looks / (TAU / 4.0)).round() * (TAU / 4.0);
                let is_square = wrap_angle(looks - quarter).abs() < 12.0 * PI / 180.0;
                let theta = if is_square { quarter } else { looks };
                mount.body_from_sensor = SE2::new(x, y, theta);
            }
            _ => {}
        }
    }
}

/// A finding that its trial refuted: nothing was changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// The finding.
    pub finding: Finding,
    /// Costs of the scans with its repair and without.
    pub costs: Costs,
}
