//! Opens a recorded log, and reads it with progress on standard error.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, IsTerminal, Read, Seek, SeekFrom, stderr};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::ensure;
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use robot_io::footprint::Footprint;
use robot_io::laser_mount::LaserMount;
use robot_io::log::{LogError, LogFrame, LogNotes, LogOptions, LogReader, with_remarks};
use robot_io::log_bytes::{LogBytes, WRITE_AHEAD};
use robot_io::log_format::LogFormat;
use robot_io::motion::{ComparedReader, OdometryUse};
use robot_io::remark::{Part, Remark};
use robot_io::rosbag2;
use robot_io::table_layout::TableLayout;

use crate::in_file::InFile as _;
use crate::numbers;
use crate::output::name;

/// Choice of topics and frames in a ROS recording, if there are several.
#[derive(Args, Clone, Debug, Default)]
pub struct TopicArgs {
    /// The topic of the scans, such as /scan.
    #[arg(long, value_name = "TOPIC")]
    scan_topic: Option<String>,
    /// The topic of the odometry, such as /odom, of stamped poses, or /tf.
    #[arg(long, value_name = "TOPIC")]
    odom_topic: Option<String>,
    /// The odometry frame in /tf.
    #[arg(long, value_name = "FRAME")]
    odom_frame: Option<String>,
    /// The frame of the robot's body.
    #[arg(long, value_name = "FRAME")]
    body_frame: Option<String>,
    /// Mounting of the laser on the body, which overrides the recording: metres forward and to the left, and degrees
    /// counter-clockwise; ,flipped if it is mounted upside down or its driver lists beams clockwise.
    #[arg(long, value_name = "X,Y,DEG[,flipped]", allow_hyphen_values = true)]
    laser: Option<LaserMount>,
    /// Use the points of a 3-D sensor between these heights above the body's origin, m.
    #[arg(long, value_name = "LOW,HIGH", value_parser = heights, allow_hyphen_values = true)]
    heights: Option<(f64, f64)>,
    /// Treat shorter ranges as no returns, m.
    #[arg(long, value_name = "METRES", value_parser = numbers::range_m, allow_hyphen_values = true)]
    min_range: Option<f64>,
    /// Treat readings on the robot as no returns: back, right, front and left end of the rectangle that it covers, in
    /// metres from the body's origin.
    #[arg(long, value_name = "B,R,F,L", allow_hyphen_values = true)]
    footprint: Option<Footprint>,
    /// Columns of a table of scans or beams without a header, such as time_us,angle_deg,range_mm or
    /// time,x,y,heading,angle_min,angle_increment,ranges; - is not read.
    #[arg(long, value_name = "NAMES", allow_hyphen_values = true)]
    columns: Option<TableLayout>,
    /// Mounting of the laser in the session that the log continues.
    #[arg(skip)]
    laser_before: Option<LaserMount>,
    /// Whether all robots of the recording are read.
    #[arg(skip)]
    pub all_robots: bool,
    /// Further parts of the recording.
    #[arg(skip)]
    parts: Vec<PathBuf>,
}

/// How the odometry of a log is taken.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct OdometryArgs {
    /// How the odometry is used: checked against the scans, as it is, checked with left and right exchanged, or not at
    /// all.
    #[arg(
        long,
        value_name = "check|force|mirrored|none",
        default_value = "check"
    )]
    odometry: OdometryUse,
    /// Ignore odometry and match scans alone; same as --odometry none.
    #[arg(long, conflicts_with = "odometry")]
    no_odometry: bool,
}

/// Parses two heights, the lower one first.
fn heights(text: &str) -> Result<(f64, f64), String> {
    let numbers = text.split_once(',').and_then(|(low, high)| {
        let (low, high) = (
            low.trim().parse::<f64>().ok()?,
            high.trim().parse::<f64>().ok()?,
        );
        (low < high && low.is_finite() && high.is_finite()).then_some((low, high))
    });
    numbers.ok_or_else(|| "expected two heights, the lower one first, such as 0.2,0.6".to_owned())
}

impl TopicArgs {
    /// The options for a log that continues a session with this mounting.
    pub fn resuming_with(&self, laser: Option<LaserMount>) -> Self {
        Self {
            laser_before: laser,
            ..self.clone()
        }
    }

    /// The options for reading all robots of a recording, if `takes_all`.
    pub fn of_all_robots(self, takes_all: bool) -> Self {
        Self {
            all_robots: takes_all,
            ..self
        }
    }

    /// The options for a recording with these further parts.
    pub fn of_parts(self, parts: &[PathBuf]) -> Self {
        Self {
            parts: parts.to_vec(),
            ..self
        }
    }

    /// The options with these topics of scans.
    pub fn of_scans(&self, topics: &str) -> Self {
        Self {
            scan_topic: Some(topics.to_owned()),
            ..self.clone()
        }
    }

    /// The topics of scans that are asked for.
    pub fn scan_topics(&self) -> impl Iterator<Item = &str> {
        let asked = self.scan_topic.iter();
        asked.flat_map(|topics| topics.split(',').map(str::trim))
    }

    fn options(&self) -> LogOptions {
        LogOptions {
            scan_topic: self.scan_topic.clone(),
            odometry_topic: self.odom_topic.clone(),
            odometry_frame: self.odom_frame.clone(),
            body_frame: self.body_frame.clone(),
            laser: self.laser,
            laser_before: self.laser_before,
            min_range_m: self.min_range,
            footprint: self.footprint,
            columns: self.columns.clone(),
            all_robots: self.all_robots,
            heights_m: self.heights,
        }
    }
}

/// Opens a file; rejects a folder before it is read.
///
/// # Errors
/// If the system cannot open it; the error contains the name.
pub fn open(path: &Path) -> anyhow::Result<BufReader<File>> {
    let file = File::open(path).in_file(path)?;
    if file.metadata().in_file(path)?.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory)).in_file(path);
    }
    Ok(BufReader::with_capacity(1 << 16, file))
}

/// Opens a log or its folder, with a progress bar over its bytes.
///
/// # Errors
/// If it cannot be opened or is not a log.
pub fn open_log(path: &Path, topics: &TopicArgs) -> anyhow::Result<(Box<dyn LogReader>, Progress)> {
    let files = files_of(path, &topics.parts)?;
    let name = path.display().to_string();
    let reader = LogFormat::open_parts(files.parts, &name, &topics.options())?;
    let reader = Box::new(WatchedReader {
        inner: with_remarks(reader, files.remarks),
        sizes: files.sizes,
        notes: LogNotes::default(),
    });
    Ok((reader, files.progress))
}

/// Reads all frames of a log.
///
/// # Errors
/// If it cannot be read or is not a log.
pub fn read_frames(path: &Path, topics: &TopicArgs) -> anyhow::Result<Vec<LogFrame>> {
    let (mut reader, progress) = open_log(path, topics)?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        frames.push(frame);
    }
    progress.end();
    Ok(frames)
}

/// Opens a log as [`open_log`] does, compares its first scans with its odometry, and corrects and reports the
/// faults whose repair wins a trial.
///
/// # Errors
/// If it cannot be opened or is not a log.
pub fn open_compared(
    path: &Path,
    topics: &TopicArgs,
    odometry: OdometryArgs,
) -> anyhow::Result<(ComparedReader<'static>, Progress)> {
    let (reader, progress) = open_log(path, topics)?;
    Ok((compared(reader, topics, odometry), progress))
}

/// Reads a recording of MCAP while it is made, compared as in [`open_compared`]; errors contain `name`.
pub fn open_live(
    stream: impl BufRead + 'static,
    name: &str,
    topics: &TopicArgs,
    odometry: OdometryArgs,
) -> ComparedReader<'static> {
    let reader = LogFormat::open_live(stream, name, &topics.options());
    compared(reader, topics, odometry)
}

fn compared(
    reader: Box<dyn LogReader>,
    topics: &TopicArgs,
    odometry: OdometryArgs,
) -> ComparedReader<'static> {
    let reader = ComparedReader::new(reader, topics.laser.is_some());
    reader.with_odometry(if odometry.no_odometry {
        OdometryUse::Ignore
    } else {
        odometry.odometry
    })
}

/// The files of a log.
struct LogFiles {
    parts: Vec<LogBytes<'static>>,
    /// Remarks on them.
    remarks: Vec<Remark>,
    /// Their sizes when they were opened, bytes.
    sizes: Vec<(PathBuf, u64)>,
    progress: Progress,
}

/// The files of a log and of its further parts.
fn files_of(path: &Path, further: &[PathBuf]) -> anyhow::Result<LogFiles> {
    let (mut files, mut remarks) = log_files(path)?;
    for part in further {
        let (of_part, about_part) = log_files(part)?;
        files.extend(of_part);
        remarks.extend(about_part);
    }
    let size = |file: &PathBuf| file.metadata().map_or(0, |about| about.len());
    let sizes: Vec<(PathBuf, u64)> = files
        .iter()
        .map(|file| (file.clone(), size(file)))
        .collect();
    // A log is read twice: for the survey and for its scans.
    let progress = Progress::new(2 * sizes.iter().map(|(_, bytes)| bytes).sum::<u64>());
    let mut parts = Vec::new();
    for file in files {
        let mut beside = file.clone().into_os_string();
        beside.push(WRITE_AHEAD);
        let beside = PathBuf::from(beside);
        let mut part = bytes_of(file, &progress.bar)?;
        if beside.is_file() {
            part = part.with_write_ahead(bytes_of(beside, &progress.bar)?);
        }
        parts.push(part);
    }
    Ok(LogFiles {
        parts,
        remarks,
        sizes,
        progress,
    })
}

/// A reader of files that may still be written: what they have grown by is said at their end.
struct WatchedReader {
    inner: Box<dyn LogReader>,
    sizes: Vec<(PathBuf, u64)>,
    notes: LogNotes,
}

impl WatchedReader {
    /// A remark on the first file that has grown since it was opened.
    fn growth(&self) -> Option<Remark> {
        self.sizes.iter().find_map(|(file, bytes)| {
            let now = file.metadata().ok().filter(|about| about.is_file())?.len();
            let text = format!(
                "{} grew by {} bytes while it was being read, as if it is still being recorded; what was written meanwhile may be missing. Run again after the recording has ended",
                file.display(),
                now.checked_sub(*bytes).filter(|more| *more > 0)?
            );
            Some(Remark::mended(Part::File, text))
        })
    }
}

impl LogReader for WatchedReader {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let frame = self.inner.next_frame();
        self.notes.clone_from(self.inner.notes());
        if matches!(frame, Ok(None)) {
            let growth = self.growth();
            self.notes.warnings.extend(growth);
        }
        frame
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

/// Bytes of a pipe that are looked at before the rest is read.
const START: u64 = 1 << 16;
/// Most bytes of a pipe: they are kept in memory.
const MAX_PIPED: u64 = 1 << 30;

/// The bytes of a file, opened again for each pass; a pipe is read into memory.
fn bytes_of(path: PathBuf, bar: &ProgressBar) -> anyhow::Result<LogBytes<'static>> {
    let mut file = open(&path)?;
    let is_file = file.get_ref().metadata().is_ok_and(|about| about.is_file());
    if !is_file {
        let mut bytes = Vec::new();
        file.by_ref()
            .take(START)
            .read_to_end(&mut bytes)
            .in_file(&path)?;
        if !matches!(LogFormat::detect(&bytes), LogFormat::Foreign(_)) {
            file.take(MAX_PIPED)
                .read_to_end(&mut bytes)
                .in_file(&path)?;
        }
        ensure!(
            bytes.len() as u64 <= MAX_PIPED,
            "{} delivers more than 1 GB; save it to a file, and pass that",
            path.display()
        );
        return Ok(LogBytes::from(bytes));
    }
    let bar = bar.clone();
    Ok(LogBytes::new(move || {
        let counted = Counted {
            source: File::open(&path)?,
            bar: bar.clone(),
        };
        Ok(BufReader::with_capacity(1 << 16, counted))
    }))
}

/// The files of a recording: one, or those of a folder of parts.
fn log_files(path: &Path) -> anyhow::Result<(Vec<PathBuf>, Vec<Remark>)> {
    if !path.is_dir() {
        return Ok((vec![path.to_owned()], Vec::new()));
    }
    let metadata = path.join(rosbag2::METADATA);
    let listed = if metadata.is_file() {
        Some(fs::read_to_string(&metadata).in_file(&metadata)?)
    } else {
        None
    };
    let mut names = Vec::new();
    for entry in fs::read_dir(path).in_file(path)? {
        let name = entry.in_file(path)?.file_name();
        names.push(name.to_string_lossy().into_owned());
    }
    let order = rosbag2::in_order(listed.as_deref(), &names)
        .map_err(|absent| format!(
            "{} lists {absent}, which is not there, and the folder has no other recording; copy it into the folder",
            rosbag2::METADATA
        ))
        .in_file(path)?;
    let files = order.files.into_iter().map(|k| path.join(&names[k]));
    let files: Vec<PathBuf> = files.collect();
    ensure!(
        !files.is_empty(),
        "{} is a folder without a recording of ROS; pass a log, or a folder with .mcap, .db3 or .bag files",
        path.display()
    );
    Ok((files, order.remarks))
}

/// Progress, speed and time left: a bar in a terminal, otherwise a line every ten seconds.
pub struct Progress {
    bar: ProgressBar,
    started: Instant,
    reported: Instant,
}

impl Progress {
    const EVERY: Duration = Duration::from_secs(10);

    fn new(bytes: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(bytes), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{wide_bar} {percent}%  {msg}  {eta} left")
            .expect("the template is well formed");
        bar.set_style(style);
        let now = Instant::now();
        Self {
            bar,
            started: now,
            reported: now,
        }
    }

    /// Reports the number of scans done.
    pub fn report(&mut self, scans: usize) {
        let seconds = self.started.elapsed().as_secs_f64();
        let per_second = scans as f64 / seconds.max(1e-3);
        if stderr().is_terminal() {
            self.bar
                .set_message(format!("{scans} scans, {per_second:.0} per second"));
        } else if self.reported.elapsed() >= Self::EVERY {
            self.reported = Instant::now();
            let left = self.bar.eta().as_secs();
            eprintln!(
                "{}: {scans} scans, {per_second:.0} per second, {left} s left",
                name()
            );
        }
    }

    /// Removes the bar.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// A reader that advances a progress bar.
struct Counted {
    source: File,
    bar: ProgressBar,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        self.bar.inc(count as u64);
        Ok(count)
    }
}

impl Seek for Counted {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.source.seek(to)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn a_log_that_grows_while_it_is_read_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.clf");
        let line = |k: u32| format!("FLASER 3 1 1 1 0.{k} 0 0 0.{k} 0 0 {k} h {k}\n");
        fs::write(&path, (1..9).map(line).collect::<String>()).unwrap();
        let said = |grows: bool| {
            let (mut reader, _) = open_log(&path, &TopicArgs::default()).unwrap();
            if grows {
                let mut file = fs::OpenOptions::new().append(true).open(&path).unwrap();
                file.write_all(line(9).as_bytes()).unwrap();
            }
            while reader.next_frame().unwrap().is_some() {}
            reader.notes().sentences("x").join(" ")
        };
        assert_eq!(said(false), "");
        assert!(said(true).contains("still being recorded"));
    }
}
