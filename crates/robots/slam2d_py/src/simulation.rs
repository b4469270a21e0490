//! Simulated drives: frames as a robot would record them, and the truth.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use ch16_lab::lap::{
    BuiltInWorld, CANONICAL_SEED, Drive as Simulated, LapConfig, NamedChoice as _, SlamConfig,
};
use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pr_geom::SE2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot_io::json_log::write_frames;

use crate::arrays;
use crate::callables::Callables;
use crate::errors::{no_choice, os_error, whole, within};
use crate::reduced::{self, Reduced};
use crate::sensor::Sensor;
use crate::slam::Slam;
use crate::slam_step::SlamStep;

/// A simulated drive: what a robot would record, and the truth.
#[pyclass(frozen, module = "rustslam2d")]
pub struct Drive {
    drive: Simulated,
    /// The geometry of the simulated laser.
    #[pyo3(get)]
    sensor: Py<Sensor>,
    /// Times of the scans, s, shape (n,).
    #[pyo3(get)]
    stamps: Py<PyArray1<f64>>,
    /// Ranges, m, shape (n, beams); those at `sensor.range_max_m` and beyond are no points.
    #[pyo3(get)]
    ranges: Py<PyArray2<f64>>,
    /// Motion of the body since the previous scan, by odometry, shape (n, 3): m, m, rad; zero for the first.
    #[pyo3(get)]
    odometry: Py<PyArray2<f64>>,
    /// That motion composed from the start, world frame, shape (n, 3).
    #[pyo3(get)]
    dead_reckoning: Py<PyArray2<f64>>,
    /// True poses world_from_body, shape (n, 3): x and y in m, θ in rad.
    #[pyo3(get)]
    truth: Py<PyArray2<f64>>,
    /// The chapter's estimator after the drive, if a function was given; otherwise None.
    #[pyo3(get)]
    slam: Option<Py<Slam>>,
    /// Its result for each scan, a SlamStep.
    #[pyo3(get)]
    steps: Vec<Py<SlamStep>>,
    world: &'static str,
}

/// Simulates the drive of the chapter's lap.
///
/// seed: seed of all noise, 0 to 2³² − 1; the chapter's is 0xC0FFEE.
/// noise: factor of the odometry noise, 0 to 100.
/// world: "apartment", "ring", "twins", "corridor" or "hall".
/// icp, gate: functions in place of the parts of the chapter's estimator, see `Slam.chapter`; it then takes the drive, and
///     `slam` and `steps` of the result have its map and its steps.
///
/// Raises ChoiceError for an argument out of its range, and what a function raises.
#[pyfunction]
#[pyo3(signature = (seed=CANONICAL_SEED.into(), noise=1.0, *, world="apartment", icp=None, gate=None),
    text_signature = "(seed=0xC0FFEE, noise=1.0, *, world='apartment', icp=None, gate=None)")]
pub fn simulate(
    py: Python<'_>,
    seed: f64,
    noise: f64,
    world: &str,
    icp: Option<Bound<'_, PyAny>>,
    gate: Option<Bound<'_, PyAny>>,
) -> PyResult<Drive> {
    let functions = Callables::new(icp, gate)?;
    let seed = whole("seed", seed, f64::from(u32::MAX))? as u32;
    let noise = within("noise", noise, 0.0, 100.0, "")?;
    let names = || BuiltInWorld::all().map(|world| world.name());
    let found = BuiltInWorld::named(world)
        .ok_or_else(|| no_choice("world", world, &names().collect::<Vec<_>>()))?;
    let mut config = LapConfig::with_seed_and_noise(seed, noise);
    if found != BuiltInWorld::Apartment {
        config = config.elsewhere(&found.course());
    }
    let drive = py.detach(|| Simulated::simulate(&config.drive));
    let frames = 0..=drive.ticks().len();
    let count = frames.clone().count();
    let first = drive.frame(0);
    let mut ranges = Vec::with_capacity(count * first.scan.ranges_m.len());
    for frame in frames.clone() {
        ranges.extend_from_slice(&drive.sweep(frame).ranges_m);
    }
    let stamps = frames.clone().map(|frame| drive.frame(frame).stamp_s);
    let motion = |frame| drive.odometry(frame).unwrap_or(SE2::identity());
    let beams = ranges.len() / count;
    let sensor = Py::new(py, Sensor::from_scan(&first.scan))?;
    let (slam, steps) = if functions.is_empty() {
        (None, Vec::new())
    } else {
        let config = SlamConfig {
            start: drive.truth(0),
            ..SlamConfig::chapter()
        };
        let slam = Slam::with_callables(sensor.clone_ref(py), config, &functions);
        let frames = 0..=drive.ticks().len();
        let steps = frames.map(|frame| {
            py.check_signals()?;
            Py::new(py, slam.drive(py, drive.frame(frame))?)
        });
        let steps = steps.collect::<PyResult<_>>()?;
        (Some(Py::new(py, slam)?), steps)
    };
    Ok(Drive {
        slam,
        steps,
        world: found.name(),
        sensor,
        stamps: PyArray1::from_vec(py, stamps.collect()).unbind(),
        ranges: PyArray1::from_vec(py, ranges)
            .reshape([count, beams])?
            .unbind(),
        odometry: arrays::of_poses(py, frames.clone().map(motion))?.unbind(),
        dead_reckoning: arrays::of_poses(
            py,
            frames.clone().map(|frame| drive.dead_reckoning(frame)),
        )?
        .unbind(),
        truth: arrays::of_poses(py, frames.map(|frame| drive.truth(frame)))?.unbind(),
        drive,
    })
}

#[pymethods]
impl Drive {
    /// Writes the drive as a log, lines of JSON with the truth beside each scan: what `ch16 lap --frames` writes.
    ///
    /// Raises OSError if the file cannot be written.
    fn write_log(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| write_log(&self.drive, &path).map_err(|error| os_error(&path, &error)))
    }

    /// What pickles: the arguments, but not the functions and their result.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(slf.py());
        let config = slf.get().drive.config();
        keywords.set_item("seed", config.seed)?;
        keywords.set_item("noise", config.noise_factor)?;
        keywords.set_item("world", slf.get().world)?;
        reduced::by_keywords("Drive", keywords)
    }

    /// Number of scans.
    fn __len__(&self) -> usize {
        self.drive.ticks().len() + 1
    }

    fn __repr__(&self) -> String {
        let config = self.drive.config();
        format!(
            "Drive(seed={:#x}, noise={}, {} scans)",
            config.seed,
            config.noise_factor,
            self.drive.ticks().len() + 1
        )
    }
}

fn write_log(drive: &Simulated, path: &Path) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let frames = drive.log_frames().enumerate();
    write_frames(
        frames.map(|(tick, frame)| (frame, drive.truth(tick))),
        &mut file,
    )
}
