//! `slam2d live`: maps a robot while it drives.
//!
//! A thread listens to the robot's server, records what it reads as MCAP, and passes the same bytes to the reader of
//! [`LogFormat::open_live`]: from there on, a robot and a file are the same.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{anyhow, bail};
use clap::Args;
use command_line::in_file::InFile as _;
use command_line::interrupt::Interrupt;
use command_line::log_args::OneRobotArgs;
use command_line::numbers;
use robot_connection::{Address, Connection, Listener};
use robot_io::live::drive::{Drive, DriveEnd};
use robot_io::live::network::Host;
use robot_io::live::queue;
use robot_io::live::{RECORDING, WAIT_S};
use robot_io::log::{LogOptions, LogReader as _};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;

use crate::mapping::{Ended, Mapping, MappingArgs};
use crate::shown::{PORT, ServeAt};

/// Time between two reports of progress.
const EVERY: Duration = Duration::from_secs(10);

/// Map a robot while it drives: connect to its foxglove_bridge. Ctrl-C ends the drive. The folder then has the results
/// of slam2d run, and the drive as recording.mcap.
#[derive(Args, Clone, Debug)]
pub struct LiveArgs {
    /// The address of the robot's foxglove_bridge, such as ws://robot:8765.
    #[arg(value_name = "ADDRESS")]
    url: String,
    #[command(flatten)]
    options: OneRobotArgs,
    /// How long to wait for the first scan, and for the robot to come back after the connection was lost, s.
    #[arg(long, value_name = "SECONDS", default_value_t = WAIT_S, value_parser = numbers::wait_s, allow_hyphen_values = true)]
    wait: f64,
    /// Show the map, its path and map → odom to Foxglove or Lichtblick while the robot drives, on this computer: at port
    /// 8766, or this one; with an address such as 0.0.0.0:8766 to others, too.
    #[arg(
        long,
        value_name = "[ADDRESS:]PORT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = PORT
    )]
    serve: Option<ServeAt>,
    #[command(flatten)]
    mapping: MappingArgs,
}

/// Maps the robot until Ctrl-C or the end of the connection, and prints the result.
///
/// # Errors
/// If the robot is not there, has no scans, or a file cannot be used.
pub fn run(args: &LiveArgs) -> anyhow::Result<ExitCode> {
    let address = Address::new(&args.url)?;
    let options = args.options.0.clone();
    let options = options.of_drive().map_err(anyhow::Error::msg)?;
    let Some(folder) = &args.mapping.output else {
        bail!("slam2d live needs a folder for the recording and the results: -o DIR");
    };
    let interrupt = Interrupt::watch();
    let mut mapping = Mapping::start(&args.mapping)?;
    let recording = folder.join(RECORDING);
    if recording.exists() {
        bail!(
            "{} is the recording of an earlier drive; pass another folder, or map it with slam2d run",
            recording.display()
        );
    }
    let mut shown = None;
    if let Some(at) = args.serve {
        let serving = mapping.show_at(at).map_err(|error| {
            anyhow!(
                "the map cannot be served at {at}: {error}; pass another port, such as --serve=8767"
            )
        })?;
        eprintln!("slam2d: shows the map at {}", serving.url());
        shown = Some(serving);
    }
    let connection = Connection::open(&address)?;
    fs::create_dir_all(folder).in_file(folder)?;
    let file = File::create_new(&recording).in_file(&recording)?;
    let (feeder, feed) = queue::stream(true);
    let is_ended = Arc::<AtomicBool>::default();
    let drive = Drive::new(feeder, options.scan_topics());
    let has_ended = Arc::clone(&is_ended);
    let listener = Listener::new(address, BufWriter::with_capacity(1 << 16, file), drive)
        .waiting(Duration::from_secs_f64(args.wait))
        .until(move || interrupt.came() || has_ended.load(Ordering::Relaxed))
        .saying(|event| eprintln!("slam2d: {event}"));
    let listening = thread::spawn(move || listener.listen(connection));
    let options = LogOptions {
        laser_before: mapping.laser_before,
        ..options
    };
    let reader = LogFormat::open_live(feed, &args.url, &options);
    let mut reader = ComparedReader::chosen(reader, &options);
    let mut reported = Instant::now();
    let problem = loop {
        match reader.next_frame() {
            Ok(Some(frame)) => {
                let odometry = frame.odometry;
                let report = mapping.step(frame);
                if let Some((shown, report)) = shown.as_mut().zip(report) {
                    shown.step(&report, odometry, reader.notes(), &mapping.run);
                }
            }
            Ok(None) => break None,
            Err(problem) => break Some(problem),
        }
        if reported.elapsed() >= EVERY {
            reported = Instant::now();
            eprintln!("slam2d: {} scans", mapping.run.scans());
        }
    };
    is_ended.store(true, Ordering::Relaxed);
    let heard = listening.join().expect("the listener does not panic");
    if heard.scans == 0 {
        forget(&recording, folder);
    }
    if let Some(problem) = problem {
        let shown = heard.without_scans(&args.url, Host::Command);
        return Err(shown.map_or_else(|| problem.into(), |shown| anyhow!(shown)));
    }
    let mut ended = Ended {
        remarks: reader.notes().sentences(&args.url),
        about: reader.notes().about.clone(),
        shown,
        ..Ended::default()
    };
    let recorded = recording.display().to_string();
    let remarks = heard.remarks(&args.url, Some(&recorded), Host::Command);
    ended.remarks.extend(remarks);
    ended.broken = match heard.end {
        DriveEnd::Recording(error) => Some(anyhow!("{}: {error}", recording.display())),
        DriveEnd::TooLong(why) => Some(anyhow!("{}: {why}; the drive ended there", args.url)),
        _ => None,
    };
    ended.is_interrupted = ended.broken.is_some();
    mapping.end(&args.url, &args.url, ended)
}

/// Removes a recording without scans, and its folder if that is empty.
fn forget(recording: &Path, folder: &Path) {
    let _ = fs::remove_file(recording);
    let _ = fs::remove_dir(folder);
}
