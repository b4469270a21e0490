//! The geometry of a planar laser.

use ch16_slam2d::scan::LaserScan;
use numpy::PyArray1;
use pr_geom::SE2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::errors::FrameError;
use crate::reduced::{self, Reduced};

/// The geometry of a planar laser: bearings of its beams, limits of its ranges, mounting.
///
/// first_angle_rad: bearing of the first beam in the sensor's frame, rad.
/// angle_step_rad: bearing from one beam to the next, rad; negative for a sensor that turns clockwise.
/// range_min_m: shorter ranges are no points, m.
/// range_max_m: ranges at or beyond this are no points, m.
/// body_from_sensor: mounting, the pose of the sensor on the body, shape (3,), m, m, rad.
/// beam_interval_s: time from one beam to the next, s; 0 if the whole sweep is one moment.
///
/// Raises FrameError for an invalid number.
#[pyclass(frozen, module = "rustslam2d")]
#[derive(Clone, PartialEq)]
pub struct Sensor {
    /// The geometry, without ranges.
    scan: LaserScan,
}

impl Sensor {
    /// The sensor of a scan.
    pub fn from_scan(scan: &LaserScan) -> Self {
        Self {
            scan: LaserScan {
                velocity: None,
                ranges_m: Vec::new(),
                ..scan.clone()
            },
        }
    }

    /// A scan of this sensor.
    pub fn scan(&self, ranges_m: Vec<f64>) -> LaserScan {
        LaserScan {
            ranges_m,
            ..self.scan.clone()
        }
    }
}

#[pymethods]
impl Sensor {
    #[new]
    #[pyo3(signature = (*, first_angle_rad, angle_step_rad, range_min_m=0.0, range_max_m=f64::INFINITY,
        body_from_sensor=None, beam_interval_s=0.0),
        text_signature = "(*, first_angle_rad, angle_step_rad, range_min_m=0.0, range_max_m=1e999, body_from_sensor=None, \
            beam_interval_s=0.0)")]
    fn new(
        first_angle_rad: f64,
        angle_step_rad: f64,
        range_min_m: f64,
        range_max_m: f64,
        body_from_sensor: Option<&Bound<'_, PyAny>>,
        beam_interval_s: f64,
    ) -> PyResult<Self> {
        let scan = LaserScan {
            first_angle_rad,
            angle_step_rad,
            range_min_m,
            range_max_m,
            body_from_sensor: arrays::pose_or(
                "body_from_sensor",
                body_from_sensor,
                SE2::identity(),
            )?,
            beam_interval_s,
            velocity: None,
            ranges_m: Vec::new(),
        };
        scan.validate()
            .map_err(|error| FrameError::new_err(error.to_string()))?;
        Ok(Self { scan })
    }

    /// Bearing of the first beam in the sensor's frame, rad.
    #[getter]
    fn first_angle_rad(&self) -> f64 {
        self.scan.first_angle_rad
    }

    /// Bearing from one beam to the next, rad.
    #[getter]
    fn angle_step_rad(&self) -> f64 {
        self.scan.angle_step_rad
    }

    /// Shorter ranges are no points, m.
    #[getter]
    fn range_min_m(&self) -> f64 {
        self.scan.range_min_m
    }

    /// Ranges at or beyond this are no points, m.
    #[getter]
    fn range_max_m(&self) -> f64 {
        self.scan.range_max_m
    }

    /// Mounting: pose of the sensor on the body, shape (3,).
    #[getter]
    fn body_from_sensor<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        arrays::of_pose(py, &self.scan.body_from_sensor)
    }

    /// Time from one beam to the next, s.
    #[getter]
    fn beam_interval_s(&self) -> f64 {
        self.scan.beam_interval_s
    }

    /// The points of a scan in the body's frame, shape (n, 2), m: one for each range that is a point.
    ///
    /// ranges: shape (beams,), m; 0, NaN and infinite ones are no points.
    fn points<'py>(
        &self,
        py: Python<'py>,
        ranges: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, numpy::PyArray2<f64>>> {
        let scan = self.scan(arrays::vector("ranges", ranges)?);
        let mut preparer = ch16_slam2d::scan::ScanPreparer::new();
        let points = preparer.points(&scan, &nalgebra::Vector3::zeros());
        arrays::of_points(py, points.iter())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(slf.py());
        for name in [
            "first_angle_rad",
            "angle_step_rad",
            "range_min_m",
            "range_max_m",
            "body_from_sensor",
            "beam_interval_s",
        ] {
            keywords.set_item(name, slf.getattr(name)?)?;
        }
        reduced::by_keywords("Sensor", keywords)
    }

    fn __repr__(&self) -> String {
        let degrees = |angle: f64| angle.to_degrees();
        format!(
            "Sensor(from {:.1}°, every {:.3}°, {} to {} m)",
            degrees(self.scan.first_angle_rad),
            degrees(self.scan.angle_step_rad),
            self.scan.range_min_m,
            self.scan.range_max_m
        )
    }
}
