//! Motion at a constant velocity command: the exact arc, and the motion model of wheel odometry.

use pr_geom::{Rng, SE2, math};

/// Turn rates below this (rad/s) count as straight motion.
const STRAIGHT_TRUTH: f64 = 1e-9;

/// Sampled turn rates below this (rad/s) count as straight motion.
const STRAIGHT_SAMPLE: f64 = 1e-6;

/// A velocity command, held for one tick.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct VelocityCommand {
    /// Forward speed in m/s.
    pub v_mps: f64,
    /// Turn rate in rad/s.
    pub omega_radps: f64,
}

/// The six noise parameters α of the velocity motion model (Thrun, Burgard, Fox 2005, Table 5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityNoise {
    /// α₁…α₆: variance of speed, of turn rate and of the final rotation, each per v² and ω².
    pub alpha: [f64; 6],
}

impl Default for VelocityNoise {
    fn default() -> Self {
        Self {
            alpha: [0.06, 0.02, 0.05, 0.02, 0.02, 0.01],
        }
    }
}

impl VelocityNoise {
    /// Multiplies all six α by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            alpha: self.alpha.map(|a| a * factor),
        }
    }
}

/// Returns the pose after `command` for `dt_s` seconds: an arc of a circle, or a straight line.
#[must_use]
pub fn drive_exactly(world_from_body: &SE2, command: VelocityCommand, dt_s: f64) -> SE2 {
    drive_arc(world_from_body, command, dt_s, STRAIGHT_TRUTH)
}

/// Draws a pose from the velocity motion model (Thrun, Burgard, Fox 2005, Table 5.3).
///
/// `v̂ = v + N(0, √(α₁v² + α₂ω²))`, `ω̂ = ω + N(0, √(α₃v² + α₄ω²))`,
/// `γ̂ = N(0, √(α₅v² + α₆ω²))`, drawn in this order; the arc of `(v̂, ω̂)`, then θ grows by `γ̂ dt`.
#[must_use]
pub fn sample_velocity_motion(
    world_from_body: &SE2,
    command: VelocityCommand,
    noise: &VelocityNoise,
    dt_s: f64,
    rng: &mut Rng,
) -> SE2 {
    let v2 = command.v_mps * command.v_mps;
    let w2 = command.omega_radps * command.omega_radps;
    let [a1, a2, a3, a4, a5, a6] = noise.alpha;
    let noisy = VelocityCommand {
        v_mps: command.v_mps + rng.normal(0.0, math::sqrt(a1 * v2 + a2 * w2)),
        omega_radps: command.omega_radps + rng.normal(0.0, math::sqrt(a3 * v2 + a4 * w2)),
    };
    let gamma = rng.normal(0.0, math::sqrt(a5 * v2 + a6 * w2));
    let arc = drive_arc(world_from_body, noisy, dt_s, STRAIGHT_SAMPLE);
    SE2::new(arc.x(), arc.y(), arc.theta() + gamma * dt_s)
}

fn drive_arc(pose: &SE2, command: VelocityCommand, dt_s: f64, straight_below: f64) -> SE2 {
    let VelocityCommand { v_mps, omega_radps } = command;
    let (sin, cos) = math::sin_cos(pose.theta());
    let theta = pose.theta() + omega_radps * dt_s;
    if omega_radps.abs() < straight_below {
        return SE2::new(
            pose.x() + v_mps * dt_s * cos,
            pose.y() + v_mps * dt_s * sin,
            theta,
        );
    }
    let radius = v_mps / omega_radps;
    let (sin_end, cos_end) = math::sin_cos(theta);
    SE2::new(
        pose.x() - radius * sin + radius * sin_end,
        pose.y() + radius * cos - radius * cos_end,
        theta,
    )
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn a_quarter_of_a_circle_ends_where_geometry_says() {
        // Radius 2 m to the left of the start: from the origin along x to (2, 2), facing +y.
        let command = VelocityCommand {
            v_mps: PI,
            omega_radps: FRAC_PI_2,
        };
        let end = drive_exactly(&SE2::identity(), command, 1.0);
        assert!((end.x() - 2.0).abs() < 1e-12);
        assert!((end.y() - 2.0).abs() < 1e-12);
        assert!((end.theta() - FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn the_straight_branch_continues_the_arc() {
        // At ω = 2e-9 over 1 s the arc leaves the line by v·ω/2 = 5e-10 m.
        let start = SE2::new(1.0, 2.0, 0.7);
        let at = |omega_radps| {
            drive_exactly(
                &start,
                VelocityCommand {
                    v_mps: 0.5,
                    omega_radps,
                },
                1.0,
            )
        };
        let (straight, arc) = (at(0.0), at(2e-9));
        // 1e-6: r sin θ with r = 2.5e8 m keeps nine digits after the point at best.
        assert!((straight.x() - arc.x()).abs() < 1e-6);
        assert!((straight.y() - arc.y()).abs() < 1e-6);
    }

    #[test]
    fn without_noise_the_sample_is_the_truth() {
        let command = VelocityCommand {
            v_mps: 0.6,
            omega_radps: 0.3,
        };
        let start = SE2::new(1.0, -2.0, 3.0);
        let quiet = VelocityNoise::default().scaled(0.0);
        let sample = sample_velocity_motion(&start, command, &quiet, 0.25, &mut Rng::new(3));
        assert_eq!(sample, drive_exactly(&start, command, 0.25));
    }
}
