//! A recorded log as a file: opened, and read with progress on standard error.

use std::fs::File;
use std::io::{self, BufReader, IsTerminal, Read, stderr};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use robot_io::log::{LogError, LogOptions, LogReader};
use robot_io::log_format::LogFormat;
use thiserror::Error;

/// Which topics and frames of a recording of ROS are meant, where there are several.
#[derive(Args, Clone, Debug, Default)]
pub struct TopicArgs {
    /// The topic of the scans, such as /scan.
    #[arg(long, value_name = "TOPIC")]
    scan_topic: Option<String>,
    /// The topic of the odometry, such as /odom, or /tf.
    #[arg(long, value_name = "TOPIC")]
    odom_topic: Option<String>,
    /// The frame that /tf gives the odometry in.
    #[arg(long, value_name = "FRAME")]
    odom_frame: Option<String>,
    /// The frame of the robot's body.
    #[arg(long, value_name = "FRAME")]
    body_frame: Option<String>,
}

impl TopicArgs {
    fn options(&self) -> LogOptions {
        LogOptions {
            scan_topic: self.scan_topic.clone(),
            odometry_topic: self.odom_topic.clone(),
            odometry_frame: self.odom_frame.clone(),
            body_frame: self.body_frame.clone(),
        }
    }
}

/// Why a file could not be used.
#[derive(Debug, Error)]
pub enum FileError {
    /// The system could not open or write it.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It is no log that can be read.
    #[error(transparent)]
    Log(#[from] LogError),
}

/// Opens a file; a folder is refused here, not at its first byte.
///
/// # Errors
/// What the system says, with the name.
pub fn open(path: &Path) -> Result<BufReader<File>, FileError> {
    let told = |source| FileError::Io {
        path: path.to_owned(),
        source,
    };
    let file = File::open(path).map_err(told)?;
    if file.metadata().map_err(told)?.is_dir() {
        return Err(told(io::ErrorKind::IsADirectory.into()));
    }
    Ok(BufReader::with_capacity(1 << 16, file))
}

/// Opens a log with a bar that follows its bytes.
///
/// # Errors
/// Where it cannot be opened, or is no log.
pub fn open_log(
    path: &Path,
    topics: &TopicArgs,
) -> Result<(Box<dyn LogReader>, Progress), FileError> {
    let file = open(path)?;
    let bytes = file.get_ref().metadata().map_or(0, |about| about.len());
    let progress = Progress::new(bytes);
    let counted = Counted {
        source: file,
        bar: progress.bar.clone(),
    };
    let reader = LogFormat::open(
        BufReader::with_capacity(1 << 16, counted),
        &path.display().to_string(),
        &topics.options(),
    )?;
    Ok((reader, progress))
}

/// Share, speed and time left: a bar in a terminal, a line every ten seconds elsewhere.
pub struct Progress {
    bar: ProgressBar,
    started: Instant,
    told: Instant,
}

impl Progress {
    const EVERY: Duration = Duration::from_secs(10);

    fn new(bytes: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(bytes), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{wide_bar} {percent} %  {msg}  {eta} left")
            .expect("the template is well formed");
        bar.set_style(style);
        let now = Instant::now();
        Self {
            bar,
            started: now,
            told: now,
        }
    }

    /// Says that so many scans are done.
    pub fn tell(&mut self, scans: usize) {
        let seconds = self.started.elapsed().as_secs_f64();
        let per_second = scans as f64 / seconds.max(1e-3);
        if stderr().is_terminal() {
            self.bar
                .set_message(format!("{scans} scans, {per_second:.0} a second"));
        } else if self.told.elapsed() >= Self::EVERY {
            self.told = Instant::now();
            let left = self.bar.eta().as_secs();
            eprintln!("slam2d: {scans} scans, {per_second:.0} a second, {left} s left");
        }
    }

    /// Takes the bar away.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// Bytes that a bar counts.
struct Counted {
    source: BufReader<File>,
    bar: ProgressBar,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        self.bar.inc(count as u64);
        Ok(count)
    }
}
