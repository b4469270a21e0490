//! The simulated drive: truth, wheel odometry and sweeps, tick by tick.
//!
//! Nothing of it depends on the estimate, so it is simulated once and any number of estimators can
//! run over it: with loops and without, with one gate and another.

use pr_geom::SE2;
use pr_sim::motion::{drive_exactly, sample_velocity_motion};
use pr_sim::{Lidar, Rng, VelocityCommand, WaypointDriver, World};

use super::config::DriveConfig;
use ch16_slam2d::cloud::{Downsampler, NormalEstimator, PointCloud};

/// One revolution of the sensor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sweep {
    /// Ranges in metres, one for each beam.
    pub ranges_m: Vec<f64>,
    /// The returns as points in the sensor frame, thinned, with the normals that this sweep alone
    /// gives them: a map of several sweeps turns the normals with the points.
    pub cloud: PointCloud,
}

/// One tick of the drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveTick {
    /// The command that was held during the tick.
    pub command: VelocityCommand,
    /// True pose after the tick, world frame.
    pub truth: SE2,
    /// What the wheels report: the pose after the tick in the frame before it.
    pub odometry: SE2,
    /// Odometry composed from the start, world frame.
    pub dead_reckoning: SE2,
    /// Way point reached in this tick.
    pub reached: Option<usize>,
    /// The sweep taken at `truth`.
    pub sweep: Sweep,
    /// The generator as the wheels found it, to draw other odometry with the same numbers.
    rng_before_odometry: Rng,
}

/// A whole drive, simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    config: DriveConfig,
    first_sweep: Sweep,
    ticks: Vec<DriveTick>,
}

impl Drive {
    /// Simulates the drive until its last way point is reached.
    #[must_use]
    pub fn simulate(config: &DriveConfig) -> Self {
        let world = &*config.world;
        let mut rng = Rng::new(config.seed);
        let mut sensor = Sensor::new(config);
        let mut driver = WaypointDriver::new(config.driver.clone());
        let noise = config.odometry_noise.scaled(config.noise_factor);

        let first_sweep = sensor.sweep(world, &config.start, &mut rng);
        let mut ticks = Vec::new();
        let mut truth = config.start;
        let mut dead_reckoning = config.start;
        let mut finished = false;
        while !finished && ticks.len() < config.max_ticks {
            let step = driver.step(&truth);
            let before = truth;
            truth = drive_exactly(&before, step.command, config.dt_s);
            let rng_before_odometry = rng.clone();
            let wheels =
                sample_velocity_motion(&before, step.command, &noise, config.dt_s, &mut rng);
            let odometry = before.between(&wheels);
            dead_reckoning = dead_reckoning * odometry;
            ticks.push(DriveTick {
                command: step.command,
                truth,
                odometry,
                dead_reckoning,
                reached: step.reached,
                sweep: sensor.sweep(world, &truth, &mut rng),
                rng_before_odometry,
            });
            finished = step.finished;
        }
        Self {
            config: config.clone(),
            first_sweep,
            ticks,
        }
    }

    /// Changes the noise of the wheels and keeps everything else.
    ///
    /// The truth and the sweeps do not depend on it: the generator draws the same number of times
    /// at every noise level. The result is that of [`Drive::simulate`], bit for bit.
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

    /// What was simulated.
    #[must_use]
    pub fn config(&self) -> &DriveConfig {
        &self.config
    }

    /// The sweep taken at the start.
    #[must_use]
    pub fn first_sweep(&self) -> &Sweep {
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

    /// The sweep taken after `tick` ticks; 0 is the start.
    #[must_use]
    pub fn sweep(&self, tick: usize) -> &Sweep {
        match tick {
            0 => &self.first_sweep,
            _ => &self.ticks[tick - 1].sweep,
        }
    }
}

/// Sensing with its buffers kept.
struct Sensor {
    lidar: Lidar,
    downsampler: Downsampler,
    normals: NormalEstimator,
    points: PointCloud,
    cell_m: f64,
    normal_radius_m: f64,
}

impl Sensor {
    fn new(config: &DriveConfig) -> Self {
        Self {
            lidar: Lidar::new(config.lidar),
            downsampler: Downsampler::default(),
            normals: NormalEstimator::default(),
            points: PointCloud::new(),
            cell_m: config.sweep_cell_m,
            normal_radius_m: config.normal_radius_m,
        }
    }

    fn sweep(&mut self, world: &World, world_from_sensor: &SE2, rng: &mut Rng) -> Sweep {
        let mut sweep = Sweep::default();
        self.lidar
            .sense_into(world, world_from_sensor, rng, &mut sweep.ranges_m);
        self.points.clear();
        for point in self.lidar.project(&sweep.ranges_m) {
            self.points.push(point);
        }
        self.downsampler
            .downsample_into(&self.points, self.cell_m, &mut sweep.cloud);
        self.normals
            .estimate(&mut sweep.cloud, self.normal_radius_m);
        sweep
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pr_sim::Course;

    use crate::lap::{CANONICAL_SEED, LAP_TICKS};

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
    fn a_drive_on_another_course_visits_its_way_points() {
        let course = Course::ring();
        let drive = Drive::simulate(&DriveConfig::default().on(&course));
        let reached = drive.ticks().iter().filter_map(|tick| tick.reached);
        assert!(reached.eq(0..course.way_points().len()));
        assert_eq!(drive.truth(0), course.start());
        // What it sees is the ring: the pillar at x = 2.9 m, 0.4 m below the way, 0.9 m ahead.
        let nearest_m = |tick: usize| {
            let ranges = &drive.sweep(tick).ranges_m;
            ranges.iter().copied().fold(f64::INFINITY, f64::min)
        };
        assert!(nearest_m(0) < 0.8);
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
}
