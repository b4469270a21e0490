//! The driver: turns toward the next waypoint by the true pose, then drives to it.

use pr_geom::{Point2, SE2, math, wrap_angle};

use crate::motion::VelocityCommand;

/// The controller's gains and limits; the default drives the chapter's lap.
#[derive(Clone, Debug, PartialEq)]
pub struct DriverConfig {
    /// Waypoints in metres, world frame, visited in order.
    pub waypoints: Vec<Point2<f64>>,
    /// Largest forward speed in m/s.
    pub max_speed_mps: f64,
    /// Largest turn rate in rad/s.
    pub max_turn_rate_radps: f64,
    /// Turn rate per radian of heading error, in 1/s.
    pub heading_gain: f64,
    /// Above this heading error (rad) the driver turns on the spot.
    pub turn_in_place_rad: f64,
    /// Below this distance (m) to the waypoint the speed falls in proportion.
    pub slow_down_m: f64,
    /// Distance (m) at which a waypoint counts as reached.
    pub arrival_m: f64,
}

impl Default for DriverConfig {
    fn default() -> Self {
        Self {
            waypoints: vec![Point2::new(10.6, 4.42), Point2::new(1.35, 4.42)],
            max_speed_mps: 0.62,
            max_turn_rate_radps: 1.1,
            heading_gain: 2.2,
            turn_in_place_rad: 0.5,
            slow_down_m: 0.6,
            arrival_m: 0.3,
        }
    }
}

/// The driver's decision in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveStep {
    /// The command of this tick, still toward the waypoint that is reached in it.
    pub command: VelocityCommand,
    /// Index of the waypoint reached in this tick, if any.
    pub reached: Option<usize>,
    /// Whether that is the last one: the lap ends after this tick.
    pub finished: bool,
}

/// Drives from waypoint to waypoint.
#[derive(Clone, Debug, PartialEq)]
pub struct WaypointDriver {
    config: DriverConfig,
    next_waypoint: usize,
}

impl WaypointDriver {
    /// Creates a driver that starts toward the first waypoint.
    #[must_use]
    pub fn new(config: DriverConfig) -> Self {
        Self {
            config,
            next_waypoint: 0,
        }
    }

    /// Returns the command at the true pose `world_from_body`; zero velocity once the lap is finished.
    pub fn step(&mut self, world_from_body: &SE2) -> DriveStep {
        let Some(waypoint) = self.config.waypoints.get(self.next_waypoint) else {
            return DriveStep {
                command: VelocityCommand::default(),
                reached: None,
                finished: true,
            };
        };
        let (dx, dy) = (
            waypoint.x - world_from_body.x(),
            waypoint.y - world_from_body.y(),
        );
        let distance = math::norm2(dx, dy);
        let command = self.command_toward(distance, math::atan2(dy, dx) - world_from_body.theta());
        let reached = (distance < self.config.arrival_m).then_some(self.next_waypoint);
        if reached.is_some() {
            self.next_waypoint += 1;
        }
        DriveStep {
            command,
            reached,
            finished: self.next_waypoint == self.config.waypoints.len(),
        }
    }

    fn command_toward(&self, distance_m: f64, heading_difference_rad: f64) -> VelocityCommand {
        let config = &self.config;
        let error = wrap_angle(heading_difference_rad);
        let limit = config.max_turn_rate_radps;
        VelocityCommand {
            v_mps: if error.abs() > config.turn_in_place_rad {
                0.0
            } else {
                config.max_speed_mps * (distance_m / config.slow_down_m).min(1.0)
            },
            omega_radps: (config.heading_gain * error).clamp(-limit, limit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::drive_exactly;

    #[test]
    fn the_default_lap_reaches_both_way_points_in_129_ticks() {
        // 129 ticks of 0.25 s: the canonical lap of the chapter.
        let mut driver = WaypointDriver::new(DriverConfig::default());
        let mut pose = SE2::new(1.35, 4.42, 0.0);
        let mut reached = Vec::new();
        for tick in 1..=129 {
            let step = driver.step(&pose);
            reached.extend(step.reached);
            pose = drive_exactly(&pose, step.command, 0.25);
            assert_eq!(step.finished, tick == 129);
        }
        assert_eq!(reached, [0, 1]);
    }

    #[test]
    fn facing_away_it_turns_on_the_spot() {
        let mut driver = WaypointDriver::new(DriverConfig::default());
        let step = driver.step(&SE2::new(5.0, 4.42, 3.0));
        assert_eq!(step.command.v_mps, 0.0);
        assert_eq!(step.command.omega_radps, -1.1);
    }
}
