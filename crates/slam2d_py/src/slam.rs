//! The estimator, one scan at a time.

use std::sync::{Mutex, MutexGuard, PoisonError};

use ch16_slam2d::scan::Frame;
use ch16_slam2d::slam::{LoopAttempt, RobotConfig, SlamConfig};
use numpy::{PyArray1, PyArray2, PyArray3};
use pr_geom::SE2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot_io::graph_file::GraphFile;

use crate::arrays;
use crate::errors::{FrameError, OptimizeError};
use crate::pose_graph::PoseGraph;
use crate::sensor::Sensor;
use crate::settings::{self, Chosen};

/// SLAM for a planar laser, one scan at a time.
///
/// config: settings by name, as `settings()` lists them: {"max_correspondence_m": 0.5, "loops": {"bundle": 6}}. The others have the
///     values for recorded logs of robots.
/// sensor: the geometry of the laser.
/// start: pose of the first scan in the map, shape (3,).
///
/// `Slam.chapter` makes the estimator of the chapter.
/// Raises SettingError for a name or a value that the estimator does not have.
#[pyclass(frozen, module = "rustslam2d")]
pub struct Slam {
    sensor: Py<Sensor>,
    inner: Mutex<Estimator>,
}

/// The estimator derives some of its numbers from the first scan.
enum Estimator {
    Waiting { chosen: Chosen, start: SE2 },
    Running(Box<ch16_slam2d::slam::Slam>),
}

/// Result of one scan.
#[pyclass(frozen, module = "rustslam2d")]
pub struct SlamStep {
    /// Estimated pose world_from_body after the scan, shape (3,): x and y in m, θ in rad.
    #[pyo3(get)]
    pose: Py<PyArray1<f64>>,
    /// Number of the scan, counted from 0.
    #[pyo3(get)]
    frame: usize,
    /// Number of the keyframe that it became, or None.
    #[pyo3(get)]
    keyframe: Option<usize>,
    /// χ² of the pose graph.
    #[pyo3(get)]
    chi2: f64,
    /// Pairs of the registration; None for the first scan.
    #[pyo3(get)]
    inliers: Option<usize>,
    /// Root mean square residual of the pairs, m; None for the first scan.
    #[pyo3(get)]
    rmse: Option<f64>,
    /// Loops that were tried: dicts with from, to, chi2, gate_chi2, rmse, inliers, accepted, reason.
    #[pyo3(get)]
    loops: Vec<Py<PyDict>>,
}

#[pymethods]
impl SlamStep {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "SlamStep(frame={}, pose={}, keyframe={}, {} loops tried)",
            self.frame,
            self.pose.bind(py).repr()?,
            self.keyframe.map_or("None".to_owned(), |k| k.to_string()),
            self.loops.len()
        ))
    }
}

/// A loop that was tried, as a dict.
fn tried(py: Python<'_>, attempt: &LoopAttempt) -> PyResult<Py<PyDict>> {
    let found = &attempt.verification;
    let dict = PyDict::new(py);
    dict.set_item("from", found.from_node)?;
    dict.set_item("to", found.candidate.node)?;
    dict.set_item("chi2", found.gate.chi2)?;
    dict.set_item("gate_chi2", found.gate.gate_chi2)?;
    dict.set_item("rmse", found.rmse_m)?;
    dict.set_item("inliers", found.inliers)?;
    dict.set_item("accepted", attempt.accepted())?;
    dict.set_item("reason", found.reason())?;
    Ok(dict.unbind())
}

impl Slam {
    fn lock(&self) -> MutexGuard<'_, Estimator> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Estimator {
    fn slam(&self) -> Option<&ch16_slam2d::slam::Slam> {
        match self {
            Self::Waiting { .. } => None,
            Self::Running(slam) => Some(slam),
        }
    }

    /// The estimator for the sensor of a first scan.
    fn running(&mut self, frame: &Frame) -> PyResult<&mut ch16_slam2d::slam::Slam> {
        if let Self::Waiting { chosen, start } = self {
            let robot = settings::applied(RobotConfig::for_scan(&frame.scan), chosen)?;
            let config = SlamConfig {
                start: *start,
                ..SlamConfig::from_robot(robot)
            };
            let slam = ch16_slam2d::slam::Slam::new(config);
            *self = Self::Running(Box::new(slam));
        }
        match self {
            Self::Running(slam) => Ok(slam),
            Self::Waiting { .. } => unreachable!("it was made above"),
        }
    }
}

#[pymethods]
impl Slam {
    #[new]
    #[pyo3(signature = (config=None, *, sensor, start=None))]
    fn new(
        config: Option<&Bound<'_, PyDict>>,
        sensor: Py<Sensor>,
        start: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let chosen = settings::chosen(config)?;
        let start = arrays::pose_or("start", start, SE2::identity())?;
        Ok(Self {
            sensor,
            inner: Mutex::new(Estimator::Waiting { chosen, start }),
        })
    }

    /// The estimator of the chapter, with the same bits as in its lap.
    ///
    /// loops: False for the front end alone.
    #[staticmethod]
    #[pyo3(signature = (*, sensor, start=None, loops=true))]
    fn chapter(
        sensor: Py<Sensor>,
        start: Option<&Bound<'_, PyAny>>,
        loops: bool,
    ) -> PyResult<Self> {
        let mut config = SlamConfig {
            start: arrays::pose_or("start", start, SE2::identity())?,
            ..SlamConfig::chapter()
        };
        if !loops {
            config = config.without_loops();
        }
        let slam = ch16_slam2d::slam::Slam::new(config);
        Ok(Self {
            sensor,
            inner: Mutex::new(Estimator::Running(Box::new(slam))),
        })
    }

    /// Takes the next scan: predicts, registers, takes a keyframe and closes loops if they are due.
    ///
    /// ranges: shape (beams,), m; 0, NaN and infinite ones are no points.
    /// odometry: motion of the body since the last scan, shape (3,), m, m, rad; `between` computes it from two
    ///     poses. Without it the prediction is constant velocity.
    /// stamp: time of the scan, s; without it its number.
    ///
    /// Raises FrameError for a scan that cannot be used, such as one that is not later than the last one; the estimator
    /// stays as it was.
    #[pyo3(signature = (ranges, odometry=None, stamp=None))]
    fn step(
        &self,
        py: Python<'_>,
        ranges: &Bound<'_, PyAny>,
        odometry: Option<&Bound<'_, PyAny>>,
        stamp: Option<f64>,
    ) -> PyResult<SlamStep> {
        let scan = self.sensor.get().scan(arrays::vector("ranges", ranges)?);
        let odometry = odometry
            .map(|motion| arrays::pose("odometry", motion))
            .transpose()?;
        let report = py.detach(|| {
            let mut estimator = self.lock();
            let number = estimator.slam().map_or(0, |slam| slam.frames());
            let frame = Frame {
                stamp_s: stamp.unwrap_or(number as f64),
                odometry,
                scan,
            };
            let report = estimator.running(&frame)?.step(&frame);
            report.map_err(|error| FrameError::new_err(error.to_string()))
        })?;
        let matched = report.registration.map(|found| found.matched);
        let loops = report.loop_attempts.iter();
        Ok(SlamStep {
            pose: arrays::of_pose(py, &report.estimate).unbind(),
            frame: report.frame,
            keyframe: report.new_keyframe,
            chi2: report.chi2,
            inliers: matched.as_ref().map(|matched| matched.inliers),
            rmse: matched.as_ref().map(|matched| matched.rmse_m),
            loops: loops
                .map(|attempt| tried(py, attempt))
                .collect::<PyResult<_>>()?,
        })
    }

    /// Ends the run: closes pending loops, links the keyframes once more, and returns the loops that were tried.
    fn conclude(&self, py: Python<'_>) -> PyResult<Vec<Py<PyDict>>> {
        let attempts = py.detach(|| match &mut *self.lock() {
            Estimator::Waiting { .. } => Vec::new(),
            Estimator::Running(slam) => slam.conclude().tried,
        });
        attempts.iter().map(|attempt| tried(py, attempt)).collect()
    }

    /// Number of scans taken.
    #[getter]
    fn frames(&self) -> usize {
        self.lock().slam().map_or(0, |slam| slam.frames())
    }

    /// Poses of the keyframes as the graph has them now, shape (k, 3): x and y in m, θ in rad.
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let estimator = self.lock();
        let poses = estimator
            .slam()
            .map_or(&[][..], |slam| slam.graph().poses());
        arrays::of_poses(py, poses.iter().copied())
    }

    /// The scan that became each keyframe, by its number, shape (k,).
    #[getter]
    fn keyframes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let estimator = self.lock();
        let keyframes = estimator.slam().map_or(&[][..], |slam| slam.keyframes());
        let frames = keyframes.iter().map(|keyframe| keyframe.frame as i64);
        PyArray1::from_vec(py, frames.collect())
    }

    /// Points of a keyframe's thinned scan in the body's frame, shape (n, 2), m.
    ///
    /// Raises IndexError for a keyframe that does not exist.
    fn scan<'py>(&self, py: Python<'py>, keyframe: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let estimator = self.lock();
        let keyframes = estimator.slam().map_or(&[][..], |slam| slam.keyframes());
        let found = keyframes.get(keyframe).ok_or_else(|| {
            pyo3::exceptions::PyIndexError::new_err(format!(
                "there is no keyframe {keyframe}: the estimator has {}",
                keyframes.len()
            ))
        })?;
        arrays::of_points(py, found.scan.iter())
    }

    /// Covariance of every keyframe against the first one, shape (k, 3, 3), order x, y, θ in the body's frame: m², rad².
    ///
    /// Raises OptimizeError if the graph has none.
    fn covariances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let covariances = py.detach(|| match &mut *self.lock() {
            Estimator::Waiting { .. } => Ok(Vec::new()),
            Estimator::Running(slam) if slam.keyframes().is_empty() => Ok(Vec::new()),
            Estimator::Running(slam) => slam.keyframe_covariances(),
        });
        let covariances = covariances.map_err(|error| OptimizeError::new_err(error.to_string()))?;
        arrays::of_matrices(py, &covariances)
    }

    /// A copy of the pose graph; node k is keyframe k.
    #[getter]
    fn graph(&self) -> PoseGraph {
        let estimator = self.lock();
        let graph = estimator.slam().map(|slam| slam.graph());
        PoseGraph::from_file(&graph.map(GraphFile::from_pose_graph).unwrap_or_default())
    }

    fn __repr__(&self) -> String {
        let estimator = self.lock();
        let (frames, keyframes) = estimator
            .slam()
            .map_or((0, 0), |slam| (slam.frames(), slam.keyframes().len()));
        format!("Slam({frames} scans, {keyframes} keyframes)")
    }
}
