//! What is changed in the frames of a recording.

use ch16_slam2d::scan::LaserScan;
use nalgebra::Vector3;
use pr_geom::SE2;
#[cfg(test)]
use pr_geom::math;

use super::Finding;
use crate::laser_mount::{LaserMount, flip};
use crate::log::LogFrame;

/// Corrections of the frames; the default changes nothing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Repairs {
    mount: Option<CorrectedMount>,
    /// Factor of the odometry's lengths.
    metres: f64,
    /// Signs of the odometry's y and headings.
    signs: [f64; 2],
    /// Factor of the odometry's turns.
    turns: f64,
    /// Whether the order of the beams in time is reversed.
    is_backward: bool,
    pub drops_odometry: bool,
    /// Time of a sweep whose beams have no times, s.
    sweep_s: Option<f64>,
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
            signs: [1.0; 2],
            turns: 1.0,
            is_backward: false,
            drops_odometry: false,
            sweep_s: None,
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
                Finding::Opposed { is_heading: true } => repairs.signs = [1.0, -1.0],
                Finding::Opposed { is_heading: false } => repairs.signs = [-1.0, 1.0],
                Finding::Unit { metres, .. } => repairs.metres = *metres,
                Finding::Scale { ratio } => repairs.metres = 1.0 / ratio,
                Finding::TurnScale { ratio } => repairs.turns = 1.0 / ratio,
                Finding::Backward => repairs.is_backward = true,
                Finding::Still { .. } | Finding::Unlike { .. } => repairs.drops_odometry = true,
                Finding::Swept { sweep_s, .. } => repairs.sweep_s = Some(*sweep_s),
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

    /// A corrected frame, but for the lag of its odometry; `path` has the frames before.
    pub fn apply(&self, mut frame: LogFrame, path: &mut TurnedPath) -> LogFrame {
        self.time_beams(&mut frame.scan);
        if self.is_backward {
            reverse(&mut frame.scan);
        }
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
        frame.odometry = frame.odometry.map(|pose| self.pose(pose));
        if self.turns != 1.0 {
            frame.odometry = frame.odometry.map(|pose| path.next(pose, self.turns));
        }
        frame
    }

    /// States the time between the beams of a scan that has none.
    pub fn time_beams(&self, scan: &mut LaserScan) {
        let steps = scan.ranges_m.len().saturating_sub(1).max(1);
        if let Some(sweep_s) = self.sweep_s.filter(|_| scan.beam_interval_s == 0.0) {
            scan.beam_interval_s = sweep_s / steps as f64;
        }
    }

    /// A pose by odometry with corrected unit and signs.
    fn pose(&self, pose: SE2) -> SE2 {
        let [of_y, of_heading] = self.signs;
        SE2::new(
            pose.x() * self.metres,
            pose.y() * self.metres * of_y,
            pose.theta() * of_heading,
        )
    }

    /// The corrected motion of the body between two poses by odometry, as a twist.
    pub fn motion(&self, [from, to]: [SE2; 2]) -> Vector3<f64> {
        let [x, y, turn] = self.pose(from).between(&self.pose(to)).log().into();
        Vector3::new(x, y, turn * self.turns)
    }
}

/// Lists the beams of a scan in the opposite order, at the same bearings.
fn reverse(scan: &mut LaserScan) {
    let last = scan.ranges_m.len().saturating_sub(1);
    scan.first_angle_rad = scan.bearing_rad(last);
    scan.angle_step_rad = -scan.angle_step_rad;
    scan.ranges_m.reverse();
}

/// A path by odometry whose turns are scaled.
#[derive(Clone, Debug, Default)]
pub(super) struct TurnedPath {
    /// The last pose by odometry, and the corrected one.
    last: Option<(SE2, SE2)>,
}

impl TurnedPath {
    /// The corrected pose after the last one: each step is an arc, whose chord turns by half of what its end does.
    fn next(&mut self, pose: SE2, factor: f64) -> SE2 {
        let next = match self.last {
            None => pose,
            Some((last, mended)) => {
                let [x, y, turn] = last.between(&pose).to_array();
                let by_rad = 0.5 * (factor - 1.0) * turn;
                let half = SE2::new(0.0, 0.0, by_rad);
                mended * half * SE2::new(x, y, turn) * half
            }
        };
        self.last = Some((pose, next));
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_with_scaled_turns_is_the_one_that_was_driven() {
        let factor = 1.6;
        let driven = |step: f64| SE2::exp(&(Vector3::new(0.1, 0.0, 0.05) * step));
        let recorded = |step: f64| SE2::exp(&(Vector3::new(0.1, 0.0, 0.05 * factor) * step));
        let mut path = TurnedPath::default();
        for step in 0..200 {
            let step = f64::from(step);
            let mended = path.next(recorded(step), 1.0 / factor);
            let off = driven(step).between(&mended);
            // 0.005 m: the chord of an arc is shorter than the arc, by its turn.
            assert!(
                math::norm2(off.x(), off.y()) < 0.005 && off.theta().abs() < 1e-9,
                "{off:?}"
            );
        }
    }

    #[test]
    fn reversed_beams_see_the_same_points() {
        let scan = LaserScan {
            first_angle_rad: -1.0,
            angle_step_rad: 0.5,
            ranges_m: vec![1.0, 2.0, 3.0],
            ..LaserScan::default()
        };
        let mut reversed = scan.clone();
        reverse(&mut reversed);
        assert_eq!(reversed.ranges_m, [3.0, 2.0, 1.0]);
        for beam in 0..3 {
            assert_eq!(reversed.bearing_rad(beam), scan.bearing_rad(2 - beam));
        }
    }
}
