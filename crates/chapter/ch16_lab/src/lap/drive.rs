//! The simulated drive: truth, odometry and sweeps, tick by tick.
//!
//! It does not depend on the estimate. So it is simulated once, and any number of estimators can run on it:
//! with loops and without, with one gate and another.

mod simulation;

use std::sync::Arc;

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::pipeline::LogFrame;
use ch16_slam2d::scan::{Frame, LaserScan, PreparedFrame};
use pr_geom::SE2;
use pr_sim::motion::sample_velocity_motion;
use pr_sim::{Rng, VelocityCommand};

use super::config::DriveConfig;

pub use simulation::DriveSimulation;

/// One revolution of the sensor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimulatedSweep {
    /// Ranges in metres, one for each beam.
    pub ranges_m: Vec<f64>,
    /// The returns as points in the sensor frame, thinned, with the normals of this sweep alone; a map of
    /// several sweeps turns the normals with the points.
    pub cloud: Arc<PointCloud>,
}

/// One tick of the drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveTick {
    /// The command during the tick.
    pub command: VelocityCommand,
    /// True pose after the tick, world frame.
    pub truth: SE2,
    /// Odometry increment: the pose after the tick in the frame before it.
    pub odometry: SE2,
    /// Odometry composed from the start, world frame.
    pub dead_reckoning: SE2,
    /// Waypoint reached in this tick.
    pub reached: Option<usize>,
    /// The sweep taken at `truth`.
    pub sweep: SimulatedSweep,
    /// State of the generator before the odometry noise, to draw other odometry from the same numbers.
    rng_before_odometry: Rng,
}

/// A complete simulated drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    config: DriveConfig,
    first_sweep: SimulatedSweep,
    ticks: Vec<DriveTick>,
}

impl Drive {
    /// Simulates the drive until its last waypoint is reached.
    #[must_use]
    pub fn simulate(config: &DriveConfig) -> Self {
        let mut simulation = DriveSimulation::new(config.clone());
        loop {
            if let Some(drive) = simulation.step() {
                return drive;
            }
        }
    }

    /// Changes the noise of the odometry and keeps everything else.
    ///
    /// Truth and sweeps do not depend on it: the generator draws equally often at every noise level. The
    /// result equals that of [`Drive::simulate`], bit for bit.
    pub fn set_noise_factor(&mut self, noise_factor: f64) {
        self.config.noise_factor = noise_factor;
        let noise = self.config.odometry_noise.scaled(noise_factor);
        let mut before = self.config.start;
        let mut dead_reckoning = self.config.start;
        for tick in &mut self.ticks {
            let mut rng = tick.rng_before_odometry.clone();
            let wheels =
                sample_velocity_motion(&before, tick.command, &noise, self.config.dt_s, &mut rng);
            tick.odometry = before.between(&wheels);
            dead_reckoning = dead_reckoning * tick.odometry;
            tick.dead_reckoning = dead_reckoning;
            before = tick.truth;
        }
    }

    /// The configuration of the simulation.
    #[must_use]
    pub fn config(&self) -> &DriveConfig {
        &self.config
    }

    /// The sweep taken at the start.
    #[must_use]
    pub fn first_sweep(&self) -> &SimulatedSweep {
        &self.first_sweep
    }

    /// The ticks in order.
    #[must_use]
    pub fn ticks(&self) -> &[DriveTick] {
        &self.ticks
    }

    /// True pose after `tick` ticks; 0 is the start.
    #[must_use]
    pub fn truth(&self, tick: usize) -> SE2 {
        match tick {
            0 => self.config.start,
            _ => self.ticks[tick - 1].truth,
        }
    }

    /// Dead reckoning after `tick` ticks, world frame; 0 is the start.
    #[must_use]
    pub fn dead_reckoning(&self, tick: usize) -> SE2 {
        match tick {
            0 => self.config.start,
            _ => self.ticks[tick - 1].dead_reckoning,
        }
    }

    /// What a robot would record: odometry as poses from the start on, one frame per tick and one at the start.
    pub fn log_frames(&self) -> impl Iterator<Item = LogFrame> + '_ {
        let mut odometry = SE2::identity();
        (0..=self.ticks.len()).map(move |tick| {
            let frame = self.frame(tick);
            odometry = odometry * frame.odometry.unwrap_or(SE2::identity());
            LogFrame {
                stamp_s: frame.stamp_s,
                odometry: Some(odometry),
                scan: frame.scan,
            }
        })
    }

    /// The estimator's input after `tick` ticks; 0 is the start.
    #[must_use]
    pub fn frame(&self, tick: usize) -> Frame {
        Frame {
            stamp_s: self.stamp_s(tick),
            odometry: self.odometry(tick),
            scan: LaserScan {
                ranges_m: self.sweep(tick).ranges_m.clone(),
                ..empty_scan(&self.config)
            },
        }
    }

    /// Like [`Drive::frame`], with the scan already as a cloud, which saves time if a drive is run many
    /// times.
    #[must_use]
    pub fn prepared(&self, tick: usize) -> PreparedFrame {
        PreparedFrame {
            stamp_s: self.stamp_s(tick),
            odometry: self.odometry(tick),
            cloud: Arc::clone(&self.sweep(tick).cloud),
            sweep: None,
        }
    }

    /// The odometry increment of `tick`; `None` at the start.
    #[must_use]
    pub fn odometry(&self, tick: usize) -> Option<SE2> {
        let before = tick.checked_sub(1)?;
        Some(self.ticks[before].odometry)
    }

    fn stamp_s(&self, tick: usize) -> f64 {
        tick as f64 * self.config.dt_s
    }

    /// The sweep taken after `tick` ticks; 0 is the start.
    #[must_use]
    pub fn sweep(&self, tick: usize) -> &SimulatedSweep {
        match tick {
            0 => &self.first_sweep,
            _ => &self.ticks[tick - 1].sweep,
        }
    }
}

/// The geometry of the simulated sensor.
fn empty_scan(config: &DriveConfig) -> LaserScan {
    LaserScan {
        first_angle_rad: config.lidar.first_angle_rad(),
        angle_step_rad: config.lidar.angle_step_rad(),
        range_max_m: config.lidar.return_limit_m(),
        ..LaserScan::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::{CANONICAL_SEED, LAP_TICKS, Lap, LapConfig};
    use ch16_slam2d::slam::{Slam, SlamConfig};

    #[test]
    fn other_noise_on_the_same_drive_gives_the_bits_of_a_new_simulation() {
        let mut drive = Drive::simulate(&DriveConfig::default());
        for noise_factor in [4.0, 0.0, 0.25] {
            drive.set_noise_factor(noise_factor);
            let fresh = Drive::simulate(&DriveConfig {
                noise_factor,
                ..DriveConfig::default()
            });
            assert_eq!(drive, fresh);
        }
    }

    #[test]
    fn neither_noise_nor_seed_changes_the_number_of_ticks() {
        for (seed, noise_factor) in [(CANONICAL_SEED, 1.0), (0, 0.25), (6, 4.0), (u32::MAX, 4.0)] {
            let drive = Drive::simulate(&DriveConfig {
                seed,
                noise_factor,
                ..DriveConfig::default()
            });
            assert_eq!(drive.ticks().len(), LAP_TICKS, "seed {seed}");
        }
    }

    #[test]
    fn without_noise_dead_reckoning_is_the_truth() {
        let drive = Drive::simulate(&DriveConfig {
            noise_factor: 0.0,
            ..DriveConfig::default()
        });
        for tick in drive.ticks() {
            // 5e-6: the sampler drives straight below 1e-6 rad/s, the truth does not; each such tick
            // is off by at most v ω dt²/2 = 2e-8 m.
            assert!(tick.truth.between(&tick.dead_reckoning).step_size() < 5e-6);
        }
    }

    #[test]
    fn the_estimator_on_raw_frames_does_what_it_does_on_prepared_ones() {
        let config = LapConfig::default();
        let mut lap = Lap::new(config.clone());
        let mut slam = Slam::new(SlamConfig {
            start: config.drive.start,
            ..config.slam
        });
        let drive = Arc::clone(lap.drive());
        slam.step(&drive.frame(0)).unwrap();
        while let Some(report) = lap.step() {
            let raw = slam.step(&drive.frame(report.tick)).unwrap();
            assert_eq!(raw.estimate, report.estimate);
            assert_eq!(raw.registration, Some(report.registration));
        }
        assert_eq!(slam.graph().poses(), lap.graph().poses());
    }
}
