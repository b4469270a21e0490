//! Opens a recorded log: its files, with progress on standard error.

use std::fs::{self, File};
use std::io::{self, BufReader, Read as _};
use std::path::{Path, PathBuf};

use anyhow::ensure;
use indicatif::ProgressBar;
use robot_io::log::{LogError, LogFrame, LogNotes, LogOptions, LogReader, with_remarks};
use robot_io::log_bytes::{LogBytes, WRITE_AHEAD};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::remark::{Part, Remark};
use robot_io::robots::Robots;
use robot_io::rosbag2;

use crate::in_file::InFile as _;
use crate::progress::{Counted, Progress};

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

/// Opens a log or its folder, and its further parts, with a progress bar over its bytes.
///
/// # Errors
/// If it cannot be opened or is not a log.
pub fn open_log(
    path: &Path,
    parts: &[PathBuf],
    options: &LogOptions,
) -> anyhow::Result<(Box<dyn LogReader>, Progress)> {
    let (files, progress) = LogFiles::of(path, parts, options)?;
    Ok((files.open(options)?, progress))
}

/// Reads all frames of a log.
///
/// # Errors
/// If it cannot be read or is not a log.
pub fn read_frames(path: &Path) -> anyhow::Result<Vec<LogFrame>> {
    let (mut reader, progress) = open_log(path, &[], &LogOptions::default())?;
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
    parts: &[PathBuf],
    options: &LogOptions,
) -> anyhow::Result<(ComparedReader<'static>, Progress)> {
    let (reader, progress) = open_log(path, parts, options)?;
    Ok((ComparedReader::chosen(reader, options), progress))
}

/// Opens a log as [`open_compared`] does, for one robot or all.
///
/// # Errors
/// If it cannot be opened or is not a log.
pub fn open_robots(
    path: &Path,
    parts: &[PathBuf],
    options: &LogOptions,
) -> anyhow::Result<(Robots<'static>, Progress)> {
    let (files, progress) = LogFiles::of(path, parts, options)?;
    let (again, mut is_first) = (progress.clone(), true);
    let open = move |options: &LogOptions| {
        let reader = ComparedReader::chosen(files.open(options)?, options);
        if !std::mem::take(&mut is_first) {
            again.restart();
        }
        Ok(reader)
    };
    Ok((Robots::open(open, options)?, progress))
}

/// The files of a log.
struct LogFiles {
    name: String,
    parts: Vec<LogBytes<'static>>,
    /// Remarks on them.
    remarks: Vec<Remark>,
    /// Their sizes when they were opened, bytes.
    sizes: Vec<(PathBuf, u64)>,
}

impl LogFiles {
    /// The files of a log and of its further parts, then that of its odometry.
    fn of(
        path: &Path,
        further: &[PathBuf],
        options: &LogOptions,
    ) -> anyhow::Result<(Self, Progress)> {
        let (mut files, mut remarks) = log_files(path)?;
        let odometry = options.odometry_file.as_ref();
        let odometry = odometry.map(|file| PathBuf::from(&file.path));
        for part in further.iter().chain(&odometry) {
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
        let name = path.display().to_string();
        let files = Self {
            name,
            parts,
            remarks,
            sizes,
        };
        Ok((files, progress))
    }

    fn open(&self, options: &LogOptions) -> Result<Box<dyn LogReader>, LogError> {
        let reader = LogFormat::open_parts(self.parts.clone(), &self.name, options)?;
        Ok(Box::new(WatchedReader {
            inner: with_remarks(reader, self.remarks.clone()),
            sizes: self.sizes.clone(),
            grown: None,
        }))
    }
}

/// A reader of files that may still be written: what they have grown by is said at their end.
struct WatchedReader {
    inner: Box<dyn LogReader>,
    sizes: Vec<(PathBuf, u64)>,
    /// The notes at the end, if a file has grown.
    grown: Option<LogNotes>,
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
        if matches!(frame, Ok(None)) {
            self.grown = self.growth().map(|remark| {
                let mut notes = self.inner.notes().clone();
                notes.warnings.push(remark);
                notes
            });
        }
        frame
    }

    fn notes(&self) -> &LogNotes {
        self.grown.as_ref().unwrap_or_else(|| self.inner.notes())
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
            let (mut reader, _) = open_log(&path, &[], &LogOptions::default()).unwrap();
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
