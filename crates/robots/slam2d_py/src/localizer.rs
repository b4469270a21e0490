//! Localization on a map that stays.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use ch16_slam2d::localize::{KnownMap, LocalizeConfig, StartPose};
use ch16_slam2d::scan::Frame;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::{FrameError, SlamError};
use crate::reduced::{self, Reduced};
use crate::sensor::Sensor;
use crate::sessions::session;
use crate::slam::Slam;

/// Localization on a map that stays, one scan at a time.
///
/// map: an estimator that has mapped, or a session: the file, or the folder that `slam2d run -o` wrote.
/// sensor: the geometry of the laser.
/// start: pose of the first scan on the map, shape (3,), good to some decimetres; without it the whole map is searched.
///
/// Raises SlamError if the map has no points, OSError if the file cannot be read.
#[pyclass(frozen, module = "rustslam2d")]
pub struct Localizer {
    sensor: Py<Sensor>,
    inner: Mutex<ch16_slam2d::localize::Localizer>,
}

/// Where `Localizer.step` is.
#[pyclass(frozen, get_all, module = "rustslam2d")]
pub struct Fix {
    /// Time of the scan, s.
    pub stamp: f64,
    /// found, tracking, doubtful or lost; navigate by the first two.
    pub verdict: String,
    /// Pose map_from_body, shape (3,): x and y in m, θ in rad; None if the robot is lost.
    pub pose: Option<Py<PyArray1<f64>>>,
    /// Its covariance, shape (3, 3), order x, y, θ in the body's frame: m², rad².
    pub covariance: Option<Py<PyArray2<f64>>>,
    /// Share of the scan that fits at the pose; None if the scan has no points.
    pub score: Option<f64>,
    /// Margin to the best distinct pose, if a search found one.
    pub margin: Option<f64>,
}

reduced::restorable! {
    Fix { stamp, verdict, pose, covariance, score, margin }
}

#[pymethods]
impl Fix {
    /// The pose as a homogeneous matrix, shape (3, 3); None if the robot is lost.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let pose = self.pose.as_ref();
        pose.map(|pose| arrays::matrix_of(pose.bind(py).as_any()))
            .transpose()
    }

    /// The pose as a homogeneous matrix of space, shape (4, 4); None if the robot is lost.
    #[getter]
    fn matrix_3d<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let pose = self.pose.as_ref();
        pose.map(|pose| arrays::matrix_3d_of(pose.bind(py).as_any()))
            .transpose()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let pose = self.pose.as_ref().map(|pose| pose.bind(py).repr());
        let pose = pose.transpose()?.map(|pose| pose.to_string());
        Ok(format!(
            "Fix({:?}, pose={})",
            self.verdict,
            pose.as_deref().unwrap_or("None")
        ))
    }
}

#[pymethods]
impl Localizer {
    #[new]
    #[pyo3(signature = (map, *, sensor, start=None))]
    fn new(
        py: Python<'_>,
        map: &Bound<'_, PyAny>,
        sensor: Py<Sensor>,
        start: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let start = start
            .map(|start| arrays::pose("start", start))
            .transpose()?;
        let start = start.map_or(StartPose::Anywhere, StartPose::Near);
        let (keyframes, poses, slam) = if let Ok(mapped) = map.cast::<Slam>() {
            mapped.get().mapped(py)?
        } else {
            let path: PathBuf = map.extract().map_err(|_| {
                SlamError::new_err("map has to be a Slam, or the path of a session")
            })?;
            let session = py.detach(|| session(path))?;
            let poses = session.poses();
            (session.snapshot.keyframes, poses, session.snapshot.config)
        };
        let config = LocalizeConfig::default();
        let known = py.detach(|| KnownMap::new(keyframes, poses, &config));
        let known = known.map_err(|error| SlamError::new_err(error.to_string()))?;
        let localizer = ch16_slam2d::localize::Localizer::new(Arc::new(known), slam, config, start);
        Ok(Self {
            sensor,
            inner: Mutex::new(localizer),
        })
    }

    /// Takes the next scan: tracks the pose, or searches for it.
    ///
    /// ranges: shape (beams,), m; 0, NaN and infinite ones are no points.
    /// odometry: motion of the body since the last scan, shape (3,), m, m, rad.
    /// stamp: time of the scan, s.
    ///
    /// Raises FrameError for a scan that cannot be used; the localizer stays as it was.
    #[pyo3(signature = (ranges, odometry=None, *, stamp))]
    fn step(
        &self,
        py: Python<'_>,
        ranges: &Bound<'_, PyAny>,
        odometry: Option<&Bound<'_, PyAny>>,
        stamp: f64,
    ) -> PyResult<Fix> {
        let frame = Frame {
            stamp_s: stamp,
            odometry: odometry
                .map(|motion| arrays::pose("odometry", motion))
                .transpose()?,
            scan: self.sensor.get().scan(arrays::vector("ranges", ranges)?),
        };
        let report = py.detach(|| {
            let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            inner.step(&frame)
        });
        let report = report.map_err(|error| FrameError::new_err(error.to_string()))?;
        let covariance = report.covariance.as_ref();
        Ok(Fix {
            stamp: report.stamp_s,
            verdict: report.verdict.name().to_owned(),
            pose: report.pose.map(|pose| arrays::of_pose(py, &pose).unbind()),
            covariance: covariance
                .map(|matrix| Ok::<_, PyErr>(arrays::of_matrix(py, matrix)?.unbind()))
                .transpose()?,
            score: report.score,
            margin: report.margin(),
        })
    }

    fn __repr__(&self) -> String {
        let inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        format!("Localizer(on {} keyframes)", inner.map().keyframes().len())
    }
}
