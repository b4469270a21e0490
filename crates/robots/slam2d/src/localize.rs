//! `slam2d localize`: localizes a log on the map of a session.

use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::bail;
use bench_support::process;
use ch16_slam2d::localize::{LocalizeReport, StartPose, Verdict};
use clap::Args;
use pr_geom::SE2;
use robot_io::localize::LocalizeRun;
use robot_io::log::LogReader;
use robot_io::run::late_scans;
use serde::Serialize;

use crate::grade::{Grade, ReferenceArgs, by_reference};
use crate::session_file::read_session;
use command_line::in_file::InFile as _;
use command_line::interrupt::{self, Interrupt};
use command_line::log_args::OneRobotArgs;
use command_line::log_file::open_compared;
use command_line::output::{print_json, say};
use command_line::whole_file::{check_file, write_whole};

/// Localize a log on the map of a session: print poses, their uncertainty, and when the robot was lost.
#[derive(Args, Clone, Debug)]
pub struct LocalizeArgs {
    /// The session, or the folder of a run.
    session: PathBuf,
    /// The log.
    log: PathBuf,
    #[command(flatten)]
    options: OneRobotArgs,
    /// Initial pose on the map: x,y,deg in metres and degrees, or anywhere.
    #[arg(
        long,
        value_name = "x,y,deg|anywhere",
        default_value = "anywhere",
        allow_hyphen_values = true
    )]
    init: Init,
    /// Write the localized poses to this file, in the TUM format.
    #[arg(short = 'o', long, value_name = "FILE.tum")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// Print one JSON object with every scan.
    #[arg(long)]
    json: bool,
}

/// `--init`.
#[derive(Clone, Copy, Debug)]
pub struct Init(pub StartPose);

impl FromStr for Init {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "anywhere" {
            return Ok(Self(StartPose::Anywhere));
        }
        let numbers: Option<Vec<f64>> = text
            .split(',')
            .map(|number| {
                number
                    .trim()
                    .parse()
                    .ok()
                    .filter(|value: &f64| value.is_finite())
            })
            .collect();
        match numbers.as_deref() {
            Some(&[x, y, deg]) => Ok(Self(StartPose::Near(SE2::new(x, y, deg.to_radians())))),
            _ => Err("expected x,y,deg or anywhere".to_owned()),
        }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct LocalizeJson<'a> {
    /// Whether Ctrl-C or SIGTERM ended it early.
    interrupted: bool,
    scans: usize,
    /// Number of scans by verdict.
    found: usize,
    tracking: usize,
    doubtful: usize,
    lost: usize,
    /// Stamp of the first localized scan, s.
    first_found_s: Option<f64>,
    cpu_s: f64,
    peak_mb: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    relations: Option<Grade>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<Grade>,
    /// The report of every scan; unknown numbers are null.
    poses: &'a [LocalizeReport],
}

/// Localizes the log and prints the result.
///
/// # Errors
/// If a file cannot be used.
pub fn run(args: &LocalizeArgs) -> anyhow::Result<ExitCode> {
    let name = args.log.display().to_string();
    if let Some(path) = &args.output {
        check_file(path).in_file(path)?;
    }
    let reference = args.reference.read()?;
    let (session, _) = read_session(&args.session)?;
    let mut run = LocalizeRun::new(&session, args.init.0)
        .map_err(|error| {
            format!("the session has no map for localization: {error}; map a log first")
        })
        .in_file(&args.session)?;
    let interrupt = Interrupt::watch();
    let (mut reader, mut progress) = open_compared(&args.log, &[], &args.options.0)?;
    let mut is_interrupted = true;
    while !interrupt.came() {
        let Some(frame) = reader.next_frame()? else {
            is_interrupted = false;
            break;
        };
        run.step(frame);
        progress.report(run.reports().len());
    }
    progress.end();
    if run.reports().is_empty() {
        let problem = run.rejected().map(|problem| problem.to_string());
        let problem =
            problem.unwrap_or_else(|| "it was interrupted before the first one".to_owned());
        bail!("{name}: no scan could be used: {problem}");
    }
    let late = late_scans(&name, run.late());
    for sentence in reader.notes().sentences(&name).into_iter().chain(late) {
        eprintln!("slam2d: {sentence}");
    }
    let trajectory = run.trajectory();
    if is_interrupted {
        let scans = run.reports().len();
        eprintln!(
            "slam2d: {name}: interrupted after {scans} scans; the rest of the log is missing"
        );
    }
    // A part replaces no whole file.
    let kept = args
        .output
        .as_ref()
        .filter(|path| is_interrupted && path.is_file());
    if let Some(path) = kept {
        eprintln!("slam2d: {} keeps its poses", path.display());
    } else if let Some(path) = &args.output {
        let mut text = Vec::new();
        let written = trajectory.write_tum(&mut text);
        let written = written.and_then(|()| write_whole(path, &text));
        written.in_file(path)?;
    }
    let grade = reference
        .as_ref()
        .map(|reference| reference.grade(&trajectory))
        .transpose()?;
    let (relations, truth) = by_reference(grade);
    let reports = run.reports();
    let count = |verdict| {
        reports
            .iter()
            .filter(|report| report.verdict == verdict)
            .count()
    };
    let localized = trajectory.poses().first();
    let result = LocalizeJson {
        interrupted: is_interrupted,
        scans: reports.len(),
        found: count(Verdict::Found),
        tracking: count(Verdict::Tracking),
        doubtful: count(Verdict::Doubtful),
        lost: count(Verdict::Lost),
        first_found_s: localized.map(|first| first.stamp_s),
        cpu_s: process::cpu_s(),
        peak_mb: process::peak_mb(),
        relations,
        truth,
        poses: reports,
    };
    if args.json {
        print_json(&result);
    } else {
        print_text(&result);
    }
    Ok(interrupt::exit_code(is_interrupted))
}

/// Prints a line for each change of the verdict, and the totals.
fn print_text(result: &LocalizeJson<'_>) {
    for run in result.poses.chunk_by(|a, b| a.verdict == b.verdict) {
        let (first, scans) = (&run[0], run.len());
        let at = match first.pose {
            Some(pose) => {
                let [x, y, heading_rad] = pose.to_array();
                let at = format!("{x:.2} m, {y:.2} m, {:.1}°", heading_rad.to_degrees());
                match first.covariance {
                    Some(known) => {
                        let sigma_m = known[(0, 0)].max(known[(1, 1)]).sqrt();
                        format!(" at {at}, standard deviation {sigma_m:.2} m")
                    }
                    None => format!(" about {at}"),
                }
            }
            None => String::new(),
        };
        say!(
            "{:.3} s: {}{at}; {scans} scans",
            first.stamp_s,
            first.verdict.name()
        );
    }
    say!("scans            {}", result.scans);
    say!(
        "poses            {} localized, {} doubtful, {} lost",
        result.found + result.tracking,
        result.doubtful,
        result.lost
    );
    say!("CPU              {:.2} s", result.cpu_s);
    if let Some(grade) = result.relations.or(result.truth) {
        grade.print();
    }
}
