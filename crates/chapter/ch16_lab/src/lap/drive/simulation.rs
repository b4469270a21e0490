//! Simulates a drive one tick at a time.

use std::sync::Arc;

use ch16_slam2d::scan::{LaserScan, ScanPreparer};
use nalgebra::Vector3;
use pr_geom::SE2;
use pr_sim::motion::{VelocityNoise, drive_exactly, sample_velocity_motion};
use pr_sim::{Lidar, Rng, WaypointDriver};

use super::{Drive, DriveTick, SimulatedSweep, empty_scan};
use crate::lap::DriveConfig;

/// A simulation under way: [`Drive::simulate`] in pieces.
pub struct DriveSimulation {
    config: DriveConfig,
    rng: Rng,
    driver: WaypointDriver,
    noise: VelocityNoise,
    sensor: Sensor,
    first_sweep: SimulatedSweep,
    ticks: Vec<DriveTick>,
    truth: SE2,
    dead_reckoning: SE2,
}

impl DriveSimulation {
    /// Starts a simulation with the first sweep.
    #[must_use]
    pub fn new(config: DriveConfig) -> Self {
        let mut rng = Rng::new(config.seed);
        let mut sensor = Sensor::new(&config);
        let first_sweep = sensor.sweep(&config, &config.start, &mut rng);
        Self {
            driver: WaypointDriver::new(config.driver.clone()),
            noise: config.odometry_noise.scaled(config.noise_factor),
            ticks: Vec::new(),
            truth: config.start,
            dead_reckoning: config.start,
            config,
            rng,
            sensor,
            first_sweep,
        }
    }

    /// Simulates one tick. Returns the complete drive once its last waypoint is reached.
    ///
    /// # Panics
    /// If called again after that.
    pub fn step(&mut self) -> Option<Drive> {
        let mut finished = self.ticks.len() >= self.config.max_ticks;
        if !finished {
            finished = self.drive_tick();
        }
        (finished || self.ticks.len() >= self.config.max_ticks).then(|| Drive {
            config: self.config.clone(),
            first_sweep: core::mem::take(&mut self.first_sweep),
            ticks: core::mem::take(&mut self.ticks),
        })
    }

    /// Simulates one tick. Returns whether the last waypoint was reached.
    fn drive_tick(&mut self) -> bool {
        let config = &self.config;
        let step = self.driver.step(&self.truth);
        let before = self.truth;
        self.truth = drive_exactly(&before, step.command, config.dt_s);
        let rng_before_odometry = self.rng.clone();
        let wheels = sample_velocity_motion(
            &before,
            step.command,
            &self.noise,
            config.dt_s,
            &mut self.rng,
        );
        let odometry = before.between(&wheels);
        self.dead_reckoning = self.dead_reckoning * odometry;
        self.ticks.push(DriveTick {
            command: step.command,
            truth: self.truth,
            odometry,
            dead_reckoning: self.dead_reckoning,
            reached: step.reached,
            sweep: self.sensor.sweep(config, &self.truth, &mut self.rng),
            rng_before_odometry,
        });
        step.finished
    }
}

/// The sensor with its buffers.
struct Sensor {
    lidar: Lidar,
    scan: LaserScan,
    preparer: ScanPreparer,
}

impl Sensor {
    fn new(config: &DriveConfig) -> Self {
        Self {
            lidar: Lidar::new(config.lidar),
            scan: empty_scan(config),
            preparer: ScanPreparer::new(),
        }
    }

    fn sweep(
        &mut self,
        config: &DriveConfig,
        world_from_sensor: &SE2,
        rng: &mut Rng,
    ) -> SimulatedSweep {
        self.lidar.sense_into(
            &config.world,
            world_from_sensor,
            rng,
            &mut self.scan.ranges_m,
        );
        // A simulated sweep is instantaneous, so motion does not distort it.
        let cloud = self
            .preparer
            .prepare(&self.scan, &Vector3::zeros(), &config.scan);
        SimulatedSweep {
            ranges_m: self.scan.ranges_m.clone(),
            cloud: Arc::new(cloud),
        }
    }
}
