//! What is changed in the frames of a recording.

use pr_geom::SE2;

use super::Finding;
use crate::laser_mount::{LaserMount, flip};
use crate::log::LogFrame;

/// Corrections of the frames; the default changes nothing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Repairs {
    mount: Option<CorrectedMount>,
    /// Factor of the odometry's lengths.
    metres: f64,
    pub drops_odometry: bool,
    /// Lag of the odometry, s.
    pub late_s: Option<f64>,
}

/// A corrected mounting.
#[derive(Clone, Debug, PartialEq)]
struct CorrectedMount {
    stated: SE2,
    mount: LaserMount,
    /// Whether the order of the beams is reversed.
    is_turned_over: bool,
}

impl Default for Repairs {
    fn default() -> Self {
        Self {
            mount: None,
            metres: 1.0,
            drops_odometry: false,
            late_s: None,
        }
    }
}

impl Repairs {
    /// What removes these faults from frames whose laser is mounted at `mount`.
    pub fn of(findings: &[Finding], mount: LaserMount) -> Self {
        let mut repairs = Self::default();
        let mut mended = mount;
        for finding in findings {
            match finding {
                Finding::Mirrored { .. } | Finding::Turned { .. } => finding.mend(&mut mended),
                Finding::Unit { metres, .. } => repairs.metres = *metres,
                Finding::Scale { ratio } => repairs.metres = 1.0 / ratio,
                Finding::Still { .. } | Finding::Unlike { .. } => repairs.drops_odometry = true,
                Finding::Late { by_s } => repairs.late_s = Some(*by_s),
            }
        }
        repairs.mount = (mended != mount).then_some(CorrectedMount {
            stated: mount.body_from_sensor,
            mount: mended,
            is_turned_over: mended.is_flipped != mount.is_flipped,
        });
        repairs
    }

    /// The mounting, if it is corrected.
    pub fn mount(&self) -> Option<LaserMount> {
        self.mount.as_ref().map(|corrected| corrected.mount)
    }

    /// A corrected frame, but for the lag of its odometry.
    pub fn apply(&self, mut frame: LogFrame) -> LogFrame {
        if let Some(corrected) = &self.mount
            && frame.scan.body_from_sensor == corrected.stated
        {
            if corrected.is_turned_over {
                flip(&mut frame.scan);
            }
            frame.scan.body_from_sensor = corrected.mount.body_from_sensor;
        }
        if self.drops_odometry {
            frame.odometry = None;
        }
        if self.metres != 1.0 {
            frame.odometry = frame
                .odometry
                .map(|pose| SE2::new(pose.x() * self.metres, pose.y() * self.metres, pose.theta()));
        }
        frame
    }
}
