//! `slam2d run`: runs the estimator on a recorded log.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ch16_slam2d::slam::SnapshotError;
use clap::Args;
use measuring::{process, timed};
use robot_io::laser_mount::LaserMount;
use robot_io::log::LogReader;
use robot_io::quality::Quality;
use robot_io::recorder::RunRecorder;
use robot_io::run::{LogRun, NOTHING_SEEN, OdometryUse};
use robot_io::settings::{Setting, SettingError};
use serde::Serialize;
use thiserror::Error;

use crate::buildings::setting;
use crate::grade::{Grade, GradeError, ReferenceArgs};
use crate::log_file::{FileError, TopicArgs, open_compared};
use crate::optimize::check_folder;
use crate::output::{print_json, say};
use crate::run_output::write_folder;
use crate::session_file::{SessionFileError, read_session};
use crate::tick_costs::{TickCosts, TickSummary};

/// Map a recorded log, and evaluate the trajectory if a reference is given.
#[derive(Args, Clone, Debug)]
pub struct RunArgs {
    /// The log.
    log: PathBuf,
    #[command(flatten)]
    topics: TopicArgs,
    /// Write the results to this folder.
    #[arg(short = 'o', long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Ignore odometry and match scans alone.
    #[arg(long)]
    no_odometry: bool,
    /// Set a parameter of the estimator; docs/robots-parameters.md lists them.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    settings: Vec<(String, f64)>,
    /// Continue this session, or that of a run's folder: the log is the rest of its recording, and the
    /// parameters stay the same.
    #[arg(long = "continue", value_name = "SESSION", conflicts_with = "settings")]
    session: Option<PathBuf>,
    /// Mark free space in the map along beams without a return, up to the sensor's limit (REP 117).
    #[arg(long)]
    free_space: bool,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Why a run was aborted.
#[derive(Debug, Error)]
pub enum RunError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The session cannot be used.
    #[error(transparent)]
    Session(#[from] SessionFileError),
    /// The session cannot be continued.
    #[error("{name}: {problem}")]
    Snapshot {
        /// The session.
        name: String,
        /// Reason.
        problem: SnapshotError,
    },
    /// The comparison failed.
    #[error(transparent)]
    Grade(#[from] GradeError),
    /// A parameter cannot be set.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The log has no scan after the session.
    #[error(
        "{name}: no scan is later than the session's last one; pass the rest of that recording, or run the log without --continue"
    )]
    NotLater {
        /// The log.
        name: String,
    },
    /// Every scan was invalid.
    #[error("{name}: no scan could be used: {problem}")]
    NoScan {
        /// The log.
        name: String,
        /// Why the first one was invalid.
        problem: String,
    },
}

/// What `--json` prints.
#[derive(Serialize)]
struct RunJson {
    scans: usize,
    keyframes: usize,
    loops_tried: usize,
    loops_accepted: usize,
    /// CPU time of the process, s.
    cpu_s: f64,
    /// Peak memory of the process, MB; null if the system does not report it.
    peak_mb: Option<f64>,
    /// Time per scan at the start and at the end of the log; null with fewer than ten scans.
    ticks: Option<TickSummary>,
    /// Whether Ctrl-C ended the run early.
    interrupted: bool,
    /// What should be checked, one sentence each.
    doubts: Vec<String>,
    /// Every keyframe with its covariance, and every loop with its evidence.
    quality: Quality,
    #[serde(skip_serializing_if = "Option::is_none")]
    relations: Option<Grade>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<Grade>,
}

/// Runs the estimator on the log and prints the result.
///
/// # Errors
/// If a file cannot be used. What was mapped before is written.
pub fn run(args: &RunArgs) -> Result<(), RunError> {
    let name = args.log.display().to_string();
    let reference = args.reference.read()?;
    let is_interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&is_interrupted);
    // If the handler cannot be set, Ctrl-C ends the process without results.
    let _ = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed));
    if let Some(folder) = &args.output {
        check_folder(folder).map_err(|source| FileError::Io {
            path: folder.clone(),
            source,
        })?;
    }
    let (mut run, mut recorder, laser_before) = start(args)?;
    let topics = args.topics.resuming_with(laser_before);
    let (reader, mut progress) = open_compared(&args.log, &topics)?;
    let mut reader = reader.ignoring_odometry(args.no_odometry);
    let mut broken = None;
    let mut costs = TickCosts::default();
    while !is_interrupted.load(Ordering::Relaxed) {
        match reader.next_frame() {
            Ok(Some(frame)) => {
                let (report, ms) = timed(|| run.step(frame.clone()));
                costs.push(ms);
                if let Some(report) = report {
                    recorder.add(&frame, &report);
                }
                progress.report(run.scans());
            }
            Ok(None) => break,
            Err(error) if run.scans() == 0 => return Err(FileError::from(error).into()),
            Err(error) => {
                broken = Some(error);
                break;
            }
        }
    }
    run.finish();
    progress.end();
    if run.scans() == 0 && run.late() > 0 {
        return Err(RunError::NotLater { name });
    }
    let mut remarks = reader.notes().sentences(&name);
    remarks.extend(run.sentences(&name));
    for remark in &remarks {
        eprintln!("slam2d: {remark}");
    }
    if run.scans() == 0 {
        let problem = match run.refused() {
            Some(problem) => problem.to_string(),
            None => "it was interrupted before the first one".to_owned(),
        };
        return Err(RunError::NoScan { name, problem });
    }
    if !run.has_seen() {
        return Err(RunError::NoScan {
            name,
            problem: NOTHING_SEEN.to_owned(),
        });
    }
    let trajectory = run.trajectory();
    let grade = reference
        .as_ref()
        .map(|reference| reference.grade(&trajectory))
        .transpose();
    let mut quality = run.quality();
    if let Some(folder) = &args.output {
        write_results(folder, &run, &quality)?;
        remarks.extend(reader.notes().about.iter().cloned());
        let title = args.log.file_name().unwrap_or(args.log.as_os_str());
        let title = title.to_string_lossy();
        write_folder(
            folder,
            &title,
            &run,
            &quality,
            &recorder,
            &remarks,
            args.free_space,
        )?;
    }
    // Write the results before reporting any later error.
    let grade = grade?;
    if let Some(error) = broken {
        return Err(FileError::from(error).into());
    }
    let of = |wanted: bool| grade.filter(|grade| wanted == matches!(grade, Grade::Relations(_)));
    let doubts = std::mem::take(&mut quality.doubts);
    let result = RunJson {
        scans: run.scans(),
        keyframes: run.slam().map_or(0, |slam| slam.keyframes().len()),
        loops_tried: run.loops().len(),
        loops_accepted: run.loops().iter().filter(|tried| tried.accepted).count(),
        cpu_s: process::cpu_s(),
        peak_mb: process::peak_mb(),
        ticks: costs.summary(),
        interrupted: is_interrupted.load(Ordering::Relaxed),
        doubts,
        quality,
        relations: of(true),
        truth: of(false),
    };
    if args.json {
        print_json(&result);
    } else {
        print_text(&result);
    }
    Ok(())
}

/// A new run, or one that continues a session, and the session's mounting of the laser.
fn start(args: &RunArgs) -> Result<(LogRun, RunRecorder, Option<LaserMount>), RunError> {
    let odometry_use = if args.no_odometry {
        OdometryUse::None
    } else {
        OdometryUse::Log
    };
    let Some(path) = &args.session else {
        let mut run = LogRun::new(odometry_use);
        for (name, value) in &args.settings {
            let setting = Setting::named(name)?;
            setting.check(*value)?;
            run = run.with_setting(setting, *value);
        }
        return Ok((run, RunRecorder::default(), None));
    };
    let (session, _) = read_session(path)?;
    let snapshot_error = |problem| RunError::Snapshot {
        name: path.display().to_string(),
        problem,
    };
    let run = LogRun::resume(&session, odometry_use).map_err(snapshot_error)?;
    let mount = session.sensor.as_ref().map(|sensor| LaserMount {
        body_from_sensor: sensor.body_from_sensor,
        is_flipped: false,
    });
    Ok((run, RunRecorder::resume(&session), mount))
}

/// Writes trajectory, graph, quality and doubts to a folder, which is created if needed.
fn write_results(folder: &Path, run: &LogRun, quality: &Quality) -> Result<(), FileError> {
    let io_error = |path: &Path| {
        let path = path.to_owned();
        move |source| FileError::Io { path, source }
    };
    fs::create_dir_all(folder).map_err(io_error(folder))?;
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(io_error(&path))
    };
    let mut trajectory = Vec::new();
    run.trajectory()
        .write_tum(&mut trajectory)
        .expect("memory takes all");
    write("trajectory.tum", &trajectory)?;
    let json = serde_json::to_vec(quality).expect("plain numbers, strings and lists");
    write("quality.json", &json)?;
    write("report.txt", report(run, quality).as_bytes())
}

/// The quality report as text.
fn report(run: &LogRun, quality: &Quality) -> String {
    let mut text = format!(
        "{} scans, {} keyframes, {} loops in the graph\n\n",
        run.scans(),
        quality.keyframes.len(),
        quality.links.len()
    );
    if quality.doubts.is_empty() {
        text.push_str("No doubts.\n");
    } else {
        text.push_str("Doubts:\n");
    }
    for doubt in &quality.doubts {
        text.push_str(&format!("- {doubt}\n"));
    }
    text.push_str("\nLoops: from, to, score, RMSE (m), inliers, chi-squared (gate)\n");
    for link in &quality.links {
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.3}"));
        text.push_str(&format!(
            "{} {} {} {} {} {} ({:.1})\n",
            link.from,
            link.to,
            number(link.score),
            number(link.rmse_m),
            link.inliers,
            number(link.chi2),
            link.gate_chi2
        ));
    }
    text
}

fn print_text(result: &RunJson) {
    say!("scans            {}", result.scans);
    say!("keyframes        {}", result.keyframes);
    say!(
        "loops            {} tested, {} accepted",
        result.loops_tried,
        result.loops_accepted
    );
    say!("CPU              {:.2} s", result.cpu_s);
    if let Some(peak_mb) = result.peak_mb {
        say!("memory           {peak_mb:.0} MB at most");
    }
    if let Some(TickSummary { first, last }) = result.ticks {
        say!(
            "a scan           {:.2} ms in the first tenth, {:.2} ms in the last (medians)",
            first.median_ms,
            last.median_ms
        );
    }
    for doubt in &result.doubts {
        say!("doubt            {doubt}");
    }
    if let Some(grade) = result.relations.or(result.truth) {
        grade.print();
    }
}
