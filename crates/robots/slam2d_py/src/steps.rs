//! Scans of a log or of a robot, as `Slam.step` takes them.

use numpy::PyArray1;
use pr_geom::SE2;
use pyo3::prelude::*;
use robot_io::log::LogFrame;

use crate::arrays;
use crate::errors::LogError;
use crate::sensor::Sensor;

/// Ranges, odometry and stamp of a scan.
pub type StepArguments = (Py<PyArray1<f64>>, Option<Py<PyArray1<f64>>>, f64);

/// Turns frames of one laser into arguments of `Slam.step`.
pub struct Steps {
    /// Where they come from.
    name: String,
    /// The laser.
    sensor: Sensor,
    /// Pose of the odometry at the frame before.
    before: Option<SE2>,
    /// Number of frames so far.
    count: usize,
}

impl Steps {
    /// Starts with the laser of the first frame.
    pub fn new(name: String, first: &LogFrame) -> Self {
        Self {
            name,
            sensor: Sensor::from_scan(&first.scan),
            before: None,
            count: 0,
        }
    }

    /// The laser.
    pub fn sensor(&self) -> Sensor {
        self.sensor.clone()
    }

    /// The arguments for the next frame.
    pub fn next(&mut self, py: Python<'_>, frame: &LogFrame) -> PyResult<StepArguments> {
        if Sensor::from_scan(&frame.scan) != self.sensor {
            return Err(LogError::new_err(format!(
                "{}: the laser of scan {} has other angles, limits or mounting than that of the first; \
                 select one laser with scan_topic",
                self.name, self.count
            )));
        }
        self.count += 1;
        let before = core::mem::replace(&mut self.before, frame.odometry);
        let motion = before
            .zip(frame.odometry)
            .map(|(before, now)| arrays::of_pose(py, &(before.inverse() * now)).unbind());
        let ranges = PyArray1::from_slice(py, &frame.scan.ranges_m).unbind();
        Ok((ranges, motion, frame.stamp_s))
    }
}
