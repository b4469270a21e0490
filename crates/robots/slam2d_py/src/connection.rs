//! A robot that drives: its scans as they come.
//!
//! One thread listens to the robot's server and records the drive, a second one reads the frames and compares them with the
//! odometry, as for a log. Neither holds the interpreter's lock. Frames are passed one at a time, so what the program does
//! not take waits in the bounded stream between both threads.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use pyo3::exceptions::PyConnectionError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use robot_connection::{Address, Connection, Event, Listener};
use robot_io::live::drive::{Drive, DriveEnd, Heard};
use robot_io::live::network::{ConnectError, Host};
use robot_io::live::{WAIT_S, queue};
use robot_io::log::{LogError as NoLog, LogFrame, LogOptions, LogReader as _};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;

use crate::errors::{ChoiceError, LogError, os_error, within};
use crate::log_options::{self, keywords};
use crate::sensor::Sensor;
use crate::steps::{StepArguments, Steps};

/// Longest time without listening to Ctrl-C.
const LISTEN_EVERY: Duration = Duration::from_millis(50);
/// Longest time to wait for a scan or a lost connection, s: a day.
const LONGEST_WAIT_S: f64 = 86_400.0;

/// A robot that drives, from `connect`. Iterating yields its scans as they come, each as (ranges, odometry, stamp), which
/// `Slam.step` takes; it ends with the drive. `with` hangs up at its end.
#[pyclass(frozen, module = "rustslam2d")]
pub struct RobotConnection {
    url: String,
    has_ended: Arc<AtomicBool>,
    drive: Mutex<Driving>,
}

/// What comes from the threads.
struct Driving {
    recording: Option<PathBuf>,
    events: Receiver<Event>,
    /// `None` after the end.
    frames: Option<Receiver<Read>>,
    /// The frame that was looked at for its laser.
    next: Option<Box<LogFrame>>,
    steps: Option<Steps>,
    listening: Option<JoinHandle<Heard>>,
    heard: Option<Heard>,
    /// Sentences on what was corrected.
    corrected: Vec<String>,
}

/// What the reader passes on.
enum Read {
    Frame(Box<LogFrame>),
    /// The end, with sentences on what was corrected, or why there is no frame.
    End(Result<Vec<String>, NoLog>),
}

/// Connects to a robot that drives: to its foxglove_bridge, or to any server of Foxglove's WebSocket protocol.
///
/// url: the address, such as "ws://robot:8765".
/// odometry, scan_topic, odom_topic, odom_frame, body_frame, laser, heights, min_range, footprint: as for `Pipeline`.
/// wait: how long to wait for the first scan, and for the robot to come back after the connection was lost, s.
/// recording: a new file that the drive is recorded to, as MCAP.
///
/// What happens is logged to the logger "rustslam2d": the topics that are read as information, a lost connection as a
/// warning. Scans that come faster than they are taken wait, 1,000 of them; further ones are left out and counted.
///
/// Raises ConnectionError if the robot is not there or speaks another protocol, ChoiceError for an argument out of its range,
/// FileExistsError if the recording exists. Ctrl-C ends the waiting with KeyboardInterrupt.
#[pyfunction]
#[pyo3(signature = (url, *, odometry=None, scan_topic=None, odom_topic=None, odom_frame=None, body_frame=None, laser=None,
    heights=None, min_range=None, footprint=None, wait=WAIT_S, recording=None),
    text_signature = "(url, *, odometry='check', scan_topic=None, odom_topic=None, odom_frame=None, body_frame=None, \
        laser=None, heights=None, min_range=None, footprint=None, wait=30.0, recording=None)")]
// Keyword arguments of Python.
#[expect(clippy::too_many_arguments)]
pub fn connect(
    py: Python<'_>,
    url: String,
    odometry: Option<Bound<'_, PyAny>>,
    scan_topic: Option<String>,
    odom_topic: Option<String>,
    odom_frame: Option<String>,
    body_frame: Option<String>,
    laser: Option<String>,
    heights: Option<(f64, f64)>,
    min_range: Option<f64>,
    footprint: Option<(f64, f64, f64, f64)>,
    wait: f64,
    recording: Option<PathBuf>,
) -> PyResult<RobotConnection> {
    let options = log_options::options(
        &keywords!(py; odometry, scan_topic, odom_topic, odom_frame, body_frame, laser,
        heights, min_range, footprint),
    )?;
    let options = options.of_drive().map_err(ChoiceError::new_err)?;
    let wait = Duration::from_secs_f64(within("wait", wait, 0.0, LONGEST_WAIT_S, " s")?);
    let address = Address::new(&url).map_err(|error| not_there(&error))?;
    py.detach(|| start(address, options, wait, recording))
}

/// Connects, and starts both threads.
fn start(
    address: Address,
    options: LogOptions,
    wait: Duration,
    recording: Option<PathBuf>,
) -> PyResult<RobotConnection> {
    let url = address.url.clone();
    let (opened, opening) = channel();
    let to = address.clone();
    // Nobody waits for it after Ctrl-C.
    thread::spawn(move || drop(opened.send(Connection::open(&to))));
    let connection = next(&opening, || Ok(()))?.expect("the thread sends what it opened");
    let connection = connection.map_err(|error| not_there(&error))?;
    let target: Box<dyn Write + Send> = match &recording {
        Some(path) => {
            let file = File::create_new(path).map_err(|error| os_error(path, &error))?;
            Box::new(BufWriter::with_capacity(1 << 16, file))
        }
        None => Box::new(io::sink()),
    };
    let (feeder, feed) = queue::stream(true);
    let has_ended = Arc::<AtomicBool>::default();
    let (say, events) = channel();
    let ends = Arc::clone(&has_ended);
    let listener = Listener::new(address, target, Drive::new(feeder, options.scan_topics()))
        .waiting(wait)
        .until(move || ends.load(Ordering::Relaxed))
        // Nobody misses what is said after the program has gone on.
        .saying(move |event| drop(say.send(event)));
    let listening = thread::spawn(move || listener.listen(connection));
    let (pass, frames) = sync_channel(0);
    let name = url.clone();
    thread::spawn(move || {
        let reader = LogFormat::open_live(feed, &name, &options);
        read(ComparedReader::chosen(reader, &options), &name, &pass);
    });
    Ok(RobotConnection {
        has_ended,
        drive: Mutex::new(Driving {
            recording,
            events,
            frames: Some(frames),
            next: None,
            steps: None,
            listening: Some(listening),
            heard: None,
            corrected: Vec::new(),
        }),
        url,
    })
}

/// Passes all frames on, while somebody takes them.
fn read(mut reader: ComparedReader<'_>, name: &str, pass: &SyncSender<Read>) {
    loop {
        let read = match reader.next_frame() {
            Ok(Some(frame)) => Read::Frame(Box::new(frame)),
            Ok(None) => Read::End(Ok(reader.notes().sentences(name))),
            Err(problem) => Read::End(Err(problem)),
        };
        let is_end = matches!(read, Read::End(_));
        if pass.send(read).is_err() || is_end {
            return;
        }
    }
}

#[pymethods]
impl RobotConnection {
    /// The laser; waits for the first scan.
    ///
    /// Raises LogError if no scan comes.
    #[getter]
    fn sensor(&self, py: Python<'_>) -> PyResult<Sensor> {
        py.detach(|| {
            let mut drive = self.drive();
            if drive.next.is_none() && drive.steps.is_none() {
                drive.next = self.advance(&mut drive)?;
            }
            match &drive.steps {
                Some(steps) => Ok(steps.sensor()),
                None => Err(LogError::new_err(format!(
                    "{}: the drive ended before its first scan",
                    self.url
                ))),
            }
        })
    }

    /// Sentences on the drive, once it has ended: what was lost or left out, and, after the last scan, what was corrected.
    #[getter]
    fn remarks(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| self.drive().remarks(&self.url))
    }

    /// Hangs up; the recording is complete then. Scans that came before are still yielded.
    ///
    /// Raises OSError if the recording cannot be written.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        self.has_ended.store(true, Ordering::Relaxed);
        py.detach(|| self.drive().hang_up())
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    #[pyo3(signature = (*_error))]
    fn __exit__(&self, py: Python<'_>, _error: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.close(py)
    }

    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<StepArguments>> {
        py.detach(|| {
            let mut drive = self.drive();
            let frame = match drive.next.take() {
                Some(frame) => Some(frame),
                None => self.advance(&mut drive)?,
            };
            let step = frame.zip(drive.steps.as_mut());
            step.map(|(frame, steps)| Python::attach(|py| steps.next(py, &frame)))
                .transpose()
        })
    }

    fn __repr__(&self) -> String {
        format!("RobotConnection({:?})", self.url)
    }
}

impl RobotConnection {
    fn drive(&self) -> std::sync::MutexGuard<'_, Driving> {
        self.drive.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next frame, without the interpreter's lock; `None` after the last.
    fn advance(&self, drive: &mut Driving) -> PyResult<Option<Box<LogFrame>>> {
        let Driving { frames, events, .. } = drive;
        let Some(frames) = frames else {
            return Ok(None);
        };
        let read = next(frames, || {
            events.try_iter().try_for_each(|event| log(&event))
        })?;
        match read {
            Some(Read::Frame(frame)) => {
                if drive.steps.is_none() {
                    drive.steps = Some(Steps::new(self.url.clone(), &frame));
                }
                Ok(Some(frame))
            }
            Some(Read::End(end)) => {
                self.has_ended.store(true, Ordering::Relaxed);
                drive.end(&self.url, end).map(|()| None)
            }
            None => Ok(None),
        }
    }
}

impl Drop for RobotConnection {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Relaxed);
    }
}

impl Driving {
    /// Waits until the listener has ended, which was told to.
    fn hang_up(&mut self) -> PyResult<()> {
        let Some(listening) = self.listening.take() else {
            return Ok(());
        };
        let heard = listening.join().expect("the listener does not panic");
        let written = match (&heard.end, &self.recording) {
            (DriveEnd::Recording(error), Some(path)) => Err(os_error(path, error)),
            _ => Ok(()),
        };
        self.heard = Some(heard);
        written
    }

    /// Takes the end of the drive.
    fn end(&mut self, url: &str, end: Result<Vec<String>, NoLog>) -> PyResult<()> {
        self.frames = None;
        self.hang_up()?;
        self.events.try_iter().try_for_each(|event| log(&event))?;
        self.corrected = end.map_err(|problem| {
            let heard = self.heard.as_ref();
            let said = heard.and_then(|heard| heard.without_scans(url, Host::Python));
            LogError::new_err(said.unwrap_or_else(|| problem.to_string()))
        })?;
        Ok(())
    }

    /// Sentences on what was corrected, lost or left out.
    fn remarks(&self, url: &str) -> Vec<String> {
        let recording = self.recording.as_ref();
        let recording = recording.map(|path| path.display().to_string());
        let of_network = self
            .heard
            .iter()
            .flat_map(|heard| heard.remarks(url, recording.as_deref(), Host::Python));
        self.corrected.iter().cloned().chain(of_network).collect()
    }
}

/// What comes next on a channel, `None` if nothing comes any more; listens to Ctrl-C and does `meanwhile`.
fn next<T>(channel: &Receiver<T>, meanwhile: impl Fn() -> PyResult<()>) -> PyResult<Option<T>> {
    loop {
        let came = channel.recv_timeout(LISTEN_EVERY);
        meanwhile()?;
        match came {
            Ok(came) => return Ok(Some(came)),
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
        }
    }
}

/// Logs what happens to the connection.
fn log(event: &Event) -> PyResult<()> {
    let level = match event {
        Event::Reads(_) | Event::Back(_) => "info",
        Event::Lost(_) => "warning",
    };
    Python::attach(|py| {
        let logger = py.import("logging")?;
        let logger = logger.call_method1("getLogger", ("rustslam2d",))?;
        let said = ("%s", event.to_string());
        logger.call_method1(level, said).map(drop)
    })
}

/// The exception for a robot that cannot be heard.
fn not_there(error: &ConnectError) -> PyErr {
    let sentence = error.to_string();
    match error {
        ConnectError::Address(_) | ConnectError::Encrypted(_) => ChoiceError::new_err(sentence),
        ConnectError::Name { .. } | ConnectError::Refused { .. } | ConnectError::Other { .. } => {
            PyConnectionError::new_err(sentence)
        }
    }
}
