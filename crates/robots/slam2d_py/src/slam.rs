//! The estimator, one scan at a time.

use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{Conclusion, Keyframe, SlamConfig, SlamReport};
use numpy::{PyArray1, PyArray2, PyArray3};
use pr_geom::SE2;
use pyo3::prelude::*;
use pyo3::sync::MutexExt as _;
use pyo3::types::{PyBytes, PyDict};
use robot_io::graph_file::GraphFile;
use robot_io::map_image::{MapBuilder, NoReturn};
use robot_io::quality;
use robot_io::session::Session;

use crate::arrays;
use crate::callables::{Callables, Raised};
use crate::errors::{FrameError, LogError, OptimizeError, SlamError, index, os_error, within};
use crate::grid_map::GridMap;
use crate::pose_graph::PoseGraph;
use crate::reduced::{self, Reduced};
use crate::sensor::Sensor;
use crate::sessions::session;
use crate::settings::{self, Chosen};
use crate::slam_step::{SlamStep, tried};

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
    /// What a reader's function has raised.
    raised: Raised,
    /// The thread that is in a step.
    stepping: Mutex<Option<ThreadId>>,
    /// The scans of the keyframes, with all their beams, for the map.
    scans: Mutex<Vec<LaserScan>>,
}

/// The estimator derives some of its numbers from the first scan.
enum Estimator {
    Waiting { chosen: Chosen, start: SE2 },
    Running(Box<ch16_slam2d::slam::Slam>),
}

/// Marks a step, and ends the mark.
struct Step<'a>(&'a Mutex<Option<ThreadId>>);

impl Drop for Step<'_> {
    fn drop(&mut self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

impl Slam {
    fn with(sensor: Py<Sensor>, estimator: Estimator, raised: Raised) -> Self {
        Self {
            sensor,
            inner: Mutex::new(estimator),
            raised,
            stepping: Mutex::default(),
            scans: Mutex::default(),
        }
    }

    /// The chapter's estimator with a reader's functions.
    pub fn with_callables(sensor: Py<Sensor>, config: SlamConfig, functions: &Callables) -> Self {
        let slam = Box::new(functions.slam(config));
        Self::with(sensor, Estimator::Running(slam), functions.raised.clone())
    }

    /// The estimator, once no other thread is in a step.
    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Estimator>> {
        if *self.stepper() == Some(thread::current().id()) {
            return Err(SlamError::new_err(
                "a function that the estimator calls during a step cannot read it; use the function's arguments",
            ));
        }
        let inner = self.inner.lock_py_attached(py);
        Ok(inner.unwrap_or_else(PoisonError::into_inner))
    }

    /// Keyframes, their poses, and the configuration, for localization.
    pub fn mapped(&self, py: Python<'_>) -> PyResult<(Vec<Keyframe>, Vec<SE2>, SlamConfig)> {
        let estimator = self.lock(py)?;
        let slam = estimator.slam().ok_or_else(|| {
            SlamError::new_err("the estimator has no map yet: it has taken no scan")
        })?;
        let poses = slam.graph().poses().to_vec();
        Ok((slam.keyframes().to_vec(), poses, slam.config().clone()))
    }

    /// Takes a frame of a simulated drive.
    pub fn drive(&self, py: Python<'_>, frame: Frame) -> PyResult<SlamStep> {
        let report = self.take(py, frame.scan, frame.odometry, Some(frame.stamp_s))?;
        SlamStep::from_report(py, report)
    }

    /// The session of the estimator as a file.
    fn session_bytes(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let estimator = self.lock(py)?;
        let slam = estimator.slam().filter(|slam| slam.frames() > 0);
        let slam = slam.ok_or_else(|| {
            SlamError::new_err("the estimator has no session yet: it has taken no scan")
        })?;
        if slam.config().local_map.is_none() {
            return Err(SlamError::new_err(
                "the chapter's estimator is neither saved nor pickled: its parts may be your functions; run it again on \
                 the same scans, which gives the same bits, or use Slam(sensor=...)",
            ));
        }
        let session = Session {
            snapshot: slam.snapshot(),
            mapped: None,
            scan_poses: Vec::new(),
            sensor: Some(self.sensor.get().scan(Vec::new())),
            last_odometry: None,
        };
        Ok(session.to_bytes())
    }

    /// The estimator of a session.
    fn from_session(
        py: Python<'_>,
        session: &Session,
        sensor: Option<Py<Sensor>>,
    ) -> PyResult<Self> {
        let sensor = match (sensor, &session.sensor) {
            (Some(sensor), _) => sensor,
            (None, Some(scan)) => Py::new(py, Sensor::from_scan(scan))?,
            (None, None) => {
                return Err(SlamError::new_err(
                    "the session has no laser; give its geometry with sensor",
                ));
            }
        };
        let slam = ch16_slam2d::slam::Slam::restore(&session.snapshot);
        let slam = slam.map_err(|error| LogError::new_err(error.to_string()))?;
        let scans = session.posed_scans().map(|(_, scan)| scan).collect();
        let estimator = Estimator::Running(Box::new(slam));
        Ok(Self {
            scans: Mutex::new(scans),
            ..Self::with(sensor, estimator, Raised::default())
        })
    }

    fn stepper(&self) -> MutexGuard<'_, Option<ThreadId>> {
        self.stepping.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins a step.
    fn begin(&self) -> PyResult<Step<'_>> {
        let mut stepping = self.stepper();
        if stepping.is_some() {
            return Err(SlamError::new_err(
                "another step of this estimator is under way; its scans have an order, so call step from one thread",
            ));
        }
        *stepping = Some(thread::current().id());
        Ok(Step(&self.stepping))
    }

    /// Takes a scan.
    fn take(
        &self,
        py: Python<'_>,
        scan: LaserScan,
        odometry: Option<SE2>,
        stamp: Option<f64>,
    ) -> PyResult<SlamReport> {
        let _step = self.begin()?;
        let report = py.detach(|| {
            let mut estimator = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            let number = estimator.slam().map_or(0, |slam| slam.frames());
            let frame = Frame {
                stamp_s: stamp.unwrap_or(number as f64),
                odometry,
                scan,
            };
            let report = estimator.running(&frame)?.step(&frame);
            let report = report.map_err(|error| FrameError::new_err(error.to_string()))?;
            if report.new_keyframe.is_some() {
                let mut scans = self.scans.lock().unwrap_or_else(PoisonError::into_inner);
                scans.push(frame.scan);
            }
            Ok::<_, PyErr>(report)
        })?;
        self.raised.raise()?;
        Ok(report)
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
            let robot = settings::applied(LocalMapConfig::for_scan(&frame.scan), chosen)?;
            let config = SlamConfig {
                start: *start,
                ..SlamConfig::from_local_map(robot)
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
        let estimator = Estimator::Waiting { chosen, start };
        Ok(Self::with(sensor, estimator, Raised::default()))
    }

    /// The estimator of the chapter, with the same bits as in its lap.
    ///
    /// loops: False for the front end alone.
    /// icp: a function in place of its registration, `icp(source, target, init, *, normals, max_distance, max_iterations)`:
    ///     points of shape (n, 2) and (m, 2), the guess of target_from_source, and the unit normals of the target, NaN where
    ///     there is none. It returns the pose, or an object with the attribute `pose`.
    /// gate: a function in place of its verification of loops, `gate(poses, sweeps, node, candidate)`: the keyframes' poses,
    ///     the list of their points, and the numbers of the new and the old keyframe. It returns whether the loop is
    ///     accepted, or an object with the attribute `accepted`.
    ///
    /// What a function raises, the step raises.
    #[staticmethod]
    #[pyo3(signature = (*, sensor, start=None, loops=true, icp=None, gate=None))]
    fn chapter(
        sensor: Py<Sensor>,
        start: Option<&Bound<'_, PyAny>>,
        loops: bool,
        icp: Option<Bound<'_, PyAny>>,
        gate: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let functions = Callables::new(icp, gate)?;
        let mut config = SlamConfig {
            start: arrays::pose_or("start", start, SE2::identity())?,
            ..SlamConfig::chapter()
        };
        if !loops {
            config = config.without_loops();
        }
        Ok(Self::with_callables(sensor, config, &functions))
    }

    /// Takes the next scan: predicts, registers, takes a keyframe and closes loops if they are due.
    ///
    /// ranges: shape (beams,), m; 0, NaN and infinite ones are no points. Their number may change, and without a point
    ///     odometry or velocity alone moves the pose.
    /// odometry: motion of the body since the last scan, shape (3,), m, m, rad; `between` computes it from two
    ///     poses. Without it the prediction is constant velocity.
    /// stamp: time of the scan, s; without it its number.
    ///
    /// Raises FrameError for a scan that cannot be used, such as one that is not later than the last one; the estimator
    /// stays as it was. Raises SlamError if another thread is in a step: scans have an order.
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
        let report = self.take(py, scan, odometry, stamp)?;
        SlamStep::from_report(py, report)
    }

    /// Ends the run: closes pending loops, links the keyframes once more, and returns the loops that were tried.
    ///
    /// Raises OptimizeError if the graph cannot be optimized: the poses then do not follow the newest loops.
    fn conclude(&self, py: Python<'_>) -> PyResult<Vec<Py<PyDict>>> {
        let step = self.begin()?;
        let concluded = py.detach(|| {
            let mut estimator = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            match &mut *estimator {
                Estimator::Waiting { .. } => Conclusion::default(),
                Estimator::Running(slam) => slam.conclude(),
            }
        });
        drop(step);
        self.raised.raise()?;
        if let Some(reason) = &concluded.unsolved {
            return Err(OptimizeError::new_err(quality::unsolved(reason)));
        }
        let tries = concluded.tried.iter();
        tries.map(|attempt| tried(py, attempt)).collect()
    }

    /// Number of scans taken.
    #[getter]
    fn frames(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.lock(py)?.slam().map_or(0, |slam| slam.frames()))
    }

    /// Poses of the keyframes as the graph has them now, shape (k, 3): x and y in m, θ in rad.
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let estimator = self.lock(py)?;
        let poses = estimator
            .slam()
            .map_or(&[][..], |slam| slam.graph().poses());
        arrays::of_poses(py, poses.iter().copied())
    }

    /// The scan that became each keyframe, by its number, shape (k,).
    #[getter]
    fn keyframes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let estimator = self.lock(py)?;
        let keyframes = estimator.slam().map_or(&[][..], |slam| slam.keyframes());
        let frames = keyframes.iter().map(|keyframe| keyframe.frame as i64);
        Ok(PyArray1::from_vec(py, frames.collect()))
    }

    /// Points of a keyframe's thinned scan in the body's frame, shape (n, 2), m.
    ///
    /// Raises NumberError for a keyframe that does not exist.
    fn scan<'py>(&self, py: Python<'py>, keyframe: f64) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let estimator = self.lock(py)?;
        let keyframes = estimator.slam().map_or(&[][..], |slam| slam.keyframes());
        let at = index("keyframe", keyframe, "the estimator", keyframes.len())?;
        arrays::of_points(py, keyframes[at].scan.iter())
    }

    /// Covariance of every keyframe against the first one, shape (k, 3, 3), order x, y, θ in the body's frame: m², rad².
    ///
    /// Raises OptimizeError if the graph has none.
    fn covariances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let covariances = match &mut *self.lock(py)? {
            Estimator::Running(slam) if !slam.keyframes().is_empty() => {
                py.detach(|| slam.keyframe_covariances())
            }
            Estimator::Waiting { .. } | Estimator::Running(_) => Ok(Vec::new()),
        };
        let covariances = covariances.map_err(|error| OptimizeError::new_err(error.to_string()))?;
        arrays::of_matrices(py, &covariances)
    }

    /// A copy of the pose graph; node k is keyframe k.
    #[getter]
    fn graph(&self, py: Python<'_>) -> PyResult<PoseGraph> {
        let estimator = self.lock(py)?;
        let graph = estimator.slam().map(|slam| slam.graph());
        let graph = graph.map(GraphFile::from_pose_graph).unwrap_or_default();
        Ok(PoseGraph::from_file(&graph))
    }

    /// The occupancy grid of the keyframes at their present poses.
    ///
    /// resolution: side of a cell, m.
    /// free_space: mark cells as free up to the sensor's limit on beams without a return (REP 117).
    ///
    /// Raises SlamError if no scan has a point yet, or the area is too large for cells of this size.
    #[pyo3(signature = (resolution=0.05, *, free_space=false))]
    fn map(&self, py: Python<'_>, resolution: f64, free_space: bool) -> PyResult<GridMap> {
        let cell_m = within("resolution", resolution, 1e-3, 100.0, " m")?;
        let estimator = self.lock(py)?;
        let poses = estimator
            .slam()
            .map_or(&[][..], |slam| slam.graph().poses());
        let scans = self.scans.lock().unwrap_or_else(PoisonError::into_inner);
        let image = py.detach(|| {
            let mut map = MapBuilder::new(cell_m).with_no_return(NoReturn::free_if(free_space));
            for (pose, scan) in poses.iter().zip(&*scans) {
                map.add(pose, scan).map_err(|error| error.to_string())?;
            }
            map.finish().map_err(|error| error.to_string())
        });
        Ok(GridMap::new(&image.map_err(SlamError::new_err)?))
    }

    /// Saves the estimator as a session: `Slam.load` and `slam2d run --continue` continue it, `Localizer` localizes on its map.
    ///
    /// path: the file; one that is there is replaced.
    ///
    /// Raises SlamError if there is nothing to save yet, or if it is the chapter's, whose parts may be your functions.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let bytes = self.session_bytes(py)?;
        // A session that is there is replaced once the new one is whole.
        let mut part = path.clone().into_os_string();
        part.push(".part");
        let written =
            py.detach(|| fs::write(&part, &bytes).and_then(|()| fs::rename(&part, &path)));
        written.map_err(|error| os_error(&path, &error))
    }

    /// The estimator of a session: a file that `save` or `slam2d run -o` wrote, or the folder of that run.
    ///
    /// sensor: the geometry of the laser; without it that of the session.
    ///
    /// It continues with the next scan. Scans of the session are thinned, so a map that is drawn from them is, too.
    /// Raises OSError if the file cannot be read, LogError if it is no session, SlamError if it has no laser.
    #[staticmethod]
    #[pyo3(signature = (path, *, sensor=None))]
    fn load(py: Python<'_>, path: PathBuf, sensor: Option<Py<Sensor>>) -> PyResult<Self> {
        let session = py.detach(|| session(path))?;
        Self::from_session(py, &session, sensor)
    }

    /// The estimator of the bytes of a session.
    #[staticmethod]
    fn _from_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let session = Session::from_bytes(bytes, "the pickled estimator");
        let session = session.map_err(|error| LogError::new_err(error.to_string()))?;
        Self::from_session(py, &session, None)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let py = slf.py();
        let fields = PyDict::new(py);
        fields.set_item("bytes", PyBytes::new(py, &slf.get().session_bytes(py)?))?;
        reduced::by_keywords("Slam", fields)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        if self.stepper().is_some() {
            return Ok("Slam(in a step)".to_owned());
        }
        let estimator = self.lock(py)?;
        let (frames, keyframes) = estimator
            .slam()
            .map_or((0, 0), |slam| (slam.frames(), slam.keyframes().len()));
        Ok(format!("Slam({frames} scans, {keyframes} keyframes)"))
    }
}
