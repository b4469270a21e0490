//! Maps a recorded log with the estimator.

use std::path::PathBuf;

use ch16_slam2d::slam::Slam;
use nalgebra::Matrix3;
use numpy::{PyArray1, PyArray2, PyArray3, PyUntypedArrayMethods as _};
use pr_geom::SE2;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use robot_io::graph_file::GraphFile;
use robot_io::log::{LogFrame, LogOptions, LogReader as _, with_remarks};
use robot_io::log_format::LogFormat;
use robot_io::map_image::{MapImage, NoReturn};
use robot_io::motion::ComparedReader;
use robot_io::quality::Quality;
use robot_io::robots::Robots;
use robot_io::run::LogRun;

use crate::arrays;
use crate::errors::{ChoiceError, LogError, SettingError, within};
use crate::grid_map::GridMap;
use crate::log_files::{self, ReadTo};
use crate::log_options::{self, keywords};
use crate::pose_graph::PoseGraph;
use crate::reduced::{self, Reduced};
use crate::sensor::Sensor;
use crate::settings::{self, Chosen};
use crate::steps::{StepArguments, Steps};
use crate::{pictures, trajectories};

/// Scans between two checks for Ctrl-C and two reports of progress.
const SCANS_BETWEEN: usize = 16;

/// Share of a run's time until its last scan; closing loops, covariances and map take the rest. Measured on recorded logs.
const SHARE_OF_SCANS: f64 = 0.75;

/// Maps a recorded log: MCAP, bags of ROS 1 and ROS 2, CARMEN, lines of JSON.
///
/// log: the file, or the folder of a recording of ROS 2.
/// config: settings by name, as `settings()` lists them.
/// odometry: "check" compares it with the scans, "force" takes it as it is, "mirrored" exchanges left and right and compares,
///     "none" uses scans alone; True is "check", False "none". The path of a file takes the odometry beside a log of text
///     from it, as `slam2d run --odometry FILE` does.
/// scan_topic, odom_topic, odom_frame, body_frame: the one to use if a recording of ROS has several.
/// laser: mounting of the laser, which overrides the recording, as `slam2d run --laser` takes it: "0.1,0,180" is metres
///     forward and to the left, and degrees; with ",flipped" if it is upside down.
/// heights: use the points of a 3-D sensor between these heights above the body's origin, (low, high), m.
/// min_range: shorter ranges are no points, m.
/// footprint: the rectangle that the robot covers, whose readings are no points: back, right, front and left end, m.
/// columns: columns of a table without a header, "time_us,angle_deg,range_mm".
/// all_robots: `run` maps all robots of a recording into one map, one after the other.
///
/// Raises OSError if the log cannot be opened, SettingError for a name or a value that the estimator does not have,
/// ChoiceError for an argument out of its range.
#[pyclass(frozen, module = "rustslam2d")]
pub struct Pipeline {
    log: PathBuf,
    chosen: Chosen,
    options: LogOptions,
    /// Its arguments, for pickling.
    keywords: Py<PyDict>,
}

/// Result of `Pipeline.run`.
#[pyclass(frozen, module = "rustslam2d")]
pub struct LogResult {
    /// Times of the scans, s, shape (n,).
    #[pyo3(get)]
    pub stamps: Py<PyArray1<f64>>,
    /// Pose world_from_body of every scan, shape (n, 3): x and y in m, θ in rad.
    #[pyo3(get)]
    pub trajectory: Py<PyArray2<f64>>,
    /// Poses of the keyframes, shape (k, 3).
    #[pyo3(get)]
    pub keyframes: Py<PyArray2<f64>>,
    /// Covariance of every keyframe against the first one, shape (k, 3, 3), order x, y, θ in the body's frame.
    #[pyo3(get)]
    pub covariances: Py<PyArray3<f64>>,
    /// The occupancy grid; None if the area is too large for cells of this size.
    #[pyo3(get)]
    pub map: Option<Py<GridMap>>,
    /// Keyframes, loops with their evidence, and doubts: the dict that `slam2d run -o` writes as quality.json.
    #[pyo3(get)]
    pub quality: Py<PyAny>,
    /// The pose graph; node k is keyframe k.
    #[pyo3(get)]
    pub graph: Py<PoseGraph>,
    /// Remarks on the scans of the log, a sentence each.
    #[pyo3(get)]
    pub remarks: Vec<String>,
}

reduced::restorable! {
    LogResult { stamps, trajectory, keyframes, covariances, map, quality, graph, remarks }
}

#[pymethods]
impl LogResult {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    /// Writes the trajectory as lines of TUM, which evo reads.
    fn save_tum(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        trajectories::save_tum(
            py,
            path,
            self.stamps.bind(py).as_any(),
            self.trajectory.bind(py).as_any(),
        )
    }

    /// The trajectory as a table of pandas: x, y, theta, by the stamp.
    fn to_pandas(slf: Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let pictures = slf.py().import("rustslam2d._pictures")?;
        Ok(pictures.call_method1("table", (slf,))?.unbind())
    }

    /// Draws map, trajectory and loops with matplotlib; returns the axes.
    ///
    /// ax: the axes to draw into; without it new ones.
    #[pyo3(signature = (*, ax=None))]
    fn plot(slf: Bound<'_, Self>, ax: Option<Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
        pictures::draw("run", slf.into_any(), ax)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!(
            "LogResult({} scans, {} keyframes, {})",
            self.stamps.bind(py).len(),
            self.keyframes.bind(py).shape()[0],
            self.map
                .as_ref()
                .map_or_else(|| "no map".to_owned(), |map| map.get().__repr__())
        )
    }
}

/// Result of a run, before its conversion for Python.
struct Found {
    trajectory: Vec<(f64, SE2)>,
    keyframes: Vec<SE2>,
    quality: Quality,
    covariances: Vec<Matrix3<f64>>,
    map: Option<MapImage>,
    graph: Option<GraphFile>,
    remarks: Vec<String>,
}

#[pymethods]
impl Pipeline {
    #[new]
    #[pyo3(signature = (log, config=None, *, odometry=None, scan_topic=None, odom_topic=None, odom_frame=None,
        body_frame=None, laser=None, heights=None, min_range=None, footprint=None, columns=None,
        all_robots=false),
        text_signature = "(log, config=None, *, odometry='check', scan_topic=None, odom_topic=None, odom_frame=None, \
            body_frame=None, laser=None, heights=None, min_range=None, footprint=None, columns=None, \
            all_robots=False)")]
    // Keyword arguments of Python.
    #[expect(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        log: PathBuf,
        config: Option<Bound<'_, PyDict>>,
        odometry: Option<Bound<'_, PyAny>>,
        scan_topic: Option<String>,
        odom_topic: Option<String>,
        odom_frame: Option<String>,
        body_frame: Option<String>,
        laser: Option<String>,
        heights: Option<(f64, f64)>,
        min_range: Option<f64>,
        footprint: Option<(f64, f64, f64, f64)>,
        columns: Option<String>,
        all_robots: bool,
    ) -> PyResult<Self> {
        let keywords = keywords!(py; log, config, odometry, scan_topic, odom_topic, odom_frame, body_frame, laser,
            heights, min_range, footprint, columns, all_robots);
        let options = log_options::options(&keywords)?;
        // A log that is not there is reported here, and not an hour later by the run.
        log_files::parts(&log, &options)?;
        Ok(Self {
            chosen: settings::chosen(config.as_ref())?,
            options,
            keywords: keywords.unbind(),
            log,
        })
    }

    /// Runs the log to its end.
    ///
    /// progress: True shows the share on standard error; a function is called with the scans so far and the share, which
    ///     grows with the scans and is 1 once the map is drawn.
    /// cell: side of the map's cells, m.
    /// free_space: in the map, mark cells as free up to the sensor's limit on beams without a return (REP 117).
    ///
    /// Raises OSError if the file cannot be read, LogError if it is no log, or none of its scans can be used. Ctrl-C ends
    /// it with KeyboardInterrupt.
    #[pyo3(signature = (*, progress=None, cell=0.05, free_space=false))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        cell: f64,
        free_space: bool,
    ) -> PyResult<LogResult> {
        let cell_m = within("cell", cell, 1e-3, 100.0, " m")?;
        let progress = Progress::new(py, progress)?;
        let found = py.detach(|| self.drive(&progress, cell_m, free_space))?;
        progress.tell(found.trajectory.len(), 1.0)?;
        progress.end(py)?;
        let (stamps, poses): (Vec<f64>, Vec<SE2>) = found.trajectory.into_iter().unzip();
        let map = found.map.map(|map| Py::new(py, GridMap::new(&map)));
        let graph = found.graph.unwrap_or_default();
        Ok(LogResult {
            stamps: PyArray1::from_vec(py, stamps).unbind(),
            trajectory: arrays::of_poses(py, poses)?.unbind(),
            keyframes: arrays::of_poses(py, found.keyframes)?.unbind(),
            covariances: arrays::of_matrices(py, &found.covariances)?.unbind(),
            map: map.transpose()?,
            quality: arrays::of_serde(py, &found.quality)?.unbind(),
            graph: Py::new(py, PoseGraph::from_file(&graph))?,
            remarks: found.remarks,
        })
    }

    /// The scans of the log, for a `Slam` or for your own code: the sensor, and a list of (ranges, odometry, stamp) as
    /// `Slam.step` takes them. Odometry is the motion since the scan before, None for the first and where the log has none.
    ///
    /// Raises OSError if the file cannot be read, LogError if it is no log, or its laser changes.
    fn frames(&self, py: Python<'_>) -> PyResult<(Sensor, Vec<StepArguments>)> {
        let frames = py.detach(|| self.read_frames())?;
        let first = frames.first().ok_or_else(|| {
            LogError::new_err(format!("{}: the log has no scan", self.log.display()))
        })?;
        let mut steps = Steps::new(self.log.display().to_string(), first);
        let sensor = steps.sensor();
        let steps: PyResult<_> = frames.iter().map(|frame| steps.next(py, frame)).collect();
        Ok((sensor, steps?))
    }

    /// A pickled pipeline reads the log again, by its path.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_keywords("Pipeline", slf.get().keywords.bind(slf.py()).clone())
    }

    fn __repr__(&self) -> String {
        format!("Pipeline({:?})", self.log.display().to_string())
    }
}

impl Pipeline {
    /// Opens the log, for one robot or all.
    fn reader(&self, options: &LogOptions) -> PyResult<(Robots<'static>, ReadTo)> {
        let name = self.log.display().to_string();
        let (parts, of_files, read) = log_files::parts(&self.log, options)?;
        let open = move |options: &LogOptions| {
            let reader = LogFormat::open_parts(parts.clone(), &name, options)?;
            Ok(ComparedReader::chosen(
                with_remarks(reader, of_files.clone()),
                options,
            ))
        };
        Ok((Robots::open(open, options).map_err(to_error)?, read))
    }

    fn read_frames(&self) -> PyResult<Vec<LogFrame>> {
        let of_one = LogOptions {
            all_robots: false,
            ..self.options.clone()
        };
        let (mut reader, _) = self.reader(&of_one)?;
        let mut frames = Vec::new();
        loop {
            match reader.next_frame() {
                Ok(Some(frame)) => frames.push(frame),
                Err(error) if frames.is_empty() => return Err(to_error(error)),
                // A log that was cut off has the scans before.
                Ok(None) | Err(_) => return Ok(frames),
            }
        }
    }

    /// Runs the log without the interpreter's lock, except to report progress.
    fn drive(&self, progress: &Progress, cell_m: f64, free_space: bool) -> PyResult<Found> {
        let name = self.log.display().to_string();
        let (mut reader, read) = self.reader(&self.options)?;
        let mut run = LogRun::default();
        for (setting, value) in &self.chosen {
            run = run
                .with_setting(setting, *value)
                .map_err(|error| SettingError::new_err(error.to_string()))?;
        }
        let (mut frames, mut share) = (0_usize, 0.0);
        while let Some(frame) = run.next_frame(&mut reader).map_err(to_error)? {
            run.step(frame);
            frames += 1;
            if frames.is_multiple_of(SCANS_BETWEEN) {
                // Of the frames that were read, some wait.
                let taken = frames as f64 / (frames + reader.waiting()) as f64;
                share = (read.share() * taken).max(share);
                progress.tell(run.scans(), SHARE_OF_SCANS * share)?;
            }
        }
        run.finish();
        if let Some(problem) = run.no_map() {
            return Err(LogError::new_err(format!(
                "{name}: no scan could be used: {problem}"
            )));
        }
        let mut remarks = reader.notes().sentences(&name);
        remarks.extend(run.sentences(&name));
        remarks.extend(run.broken().map(str::to_owned));
        let quality = run.quality();
        let covariances = quality
            .keyframes
            .iter()
            .map(|keyframe| Matrix3::from_fn(|row, column| keyframe.covariance[row][column]));
        let map = run.map(cell_m, NoReturn::free_if(free_space));
        remarks.extend(match &map {
            Ok(map) => map.coarser_than(cell_m),
            Err(problem) => Some(format!("there is no map: {problem}")),
        });
        let slam = run.slam();
        let trajectory = run.trajectory();
        let poses = trajectory.poses().iter();
        Ok(Found {
            trajectory: poses.map(|at| (at.stamp_s, at.pose)).collect(),
            keyframes: slam.map_or_else(Vec::new, |slam| slam.graph().poses().to_vec()),
            covariances: covariances.collect(),
            map: map.ok(),
            graph: slam.map(Slam::graph).map(GraphFile::from_pose_graph),
            quality,
            remarks,
        })
    }
}

fn to_error(error: robot_io::log::LogError) -> PyErr {
    LogError::new_err(error.to_string())
}

/// Target of the progress reports.
enum Progress {
    Nowhere,
    /// `sys.stderr`, which notebooks also show.
    Stderr,
    Function(Py<PyAny>),
}

impl Progress {
    fn new(py: Python<'_>, wanted: Option<Py<PyAny>>) -> PyResult<Self> {
        let Some(wanted) = wanted else {
            return Ok(Self::Nowhere);
        };
        if let Ok(is_shown) = wanted.bind(py).cast::<PyBool>() {
            return Ok(if is_shown.is_true() {
                Self::Stderr
            } else {
                Self::Nowhere
            });
        }
        if wanted.bind(py).is_callable() {
            return Ok(Self::Function(wanted));
        }
        Err(ChoiceError::new_err(
            "progress has to be True, False or a function of the scans and the share",
        ))
    }

    /// Checks for Ctrl-C, and reports the progress.
    fn tell(&self, scans: usize, share: f64) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            match self {
                Self::Nowhere => Ok(()),
                Self::Stderr => say(py, &format!("\r{scans} scans, {:3.0}%", 100.0 * share)),
                Self::Function(function) => function.call1(py, (scans, share)).map(drop),
            }
        })
    }

    /// Ends the line.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        match self {
            Self::Stderr => say(py, "\n"),
            Self::Nowhere | Self::Function(_) => Ok(()),
        }
    }
}

fn say(py: Python<'_>, text: &str) -> PyResult<()> {
    let stderr = py.import("sys")?.getattr("stderr")?;
    // Python has none in a program without a console.
    if stderr.is_none() {
        return Ok(());
    }
    stderr.call_method1("write", (text,))?;
    stderr.call_method0("flush").map(drop)
}
