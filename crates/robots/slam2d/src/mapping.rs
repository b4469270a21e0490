//! The estimator's run of `slam2d run` and `slam2d live`: its arguments, its scans, its results.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use bench_support::{process, timed};
use ch16_slam2d::slam::SlamReport;
use clap::Args;
use robot_io::laser_mount::LaserMount;
use robot_io::log::LogFrame;
use robot_io::map_image::NoReturn;
use robot_io::quality::Quality;
use robot_io::run::LogRun;
use robot_io::settings::Setting;
use serde::Serialize;

use crate::grade::{Grade, Reference, ReferenceArgs, by_reference};
use crate::localize::Init;
use crate::run_folder::{CUT_SHORT, folder_of_part};
use crate::run_output::{Results, write_folder};
use crate::session_file::read_session;
use crate::shown::{ServeAt, Shown};
use crate::tick_costs::{TickCosts, TickSummary};
use command_line::in_file::InFile as _;
use command_line::interrupt;
use command_line::numbers;
use command_line::output::{print_json, say};
use command_line::setting::setting;
use command_line::whole_file::check_folder;

/// What a run of the estimator is given, from a log or from a robot.
#[derive(Args, Clone, Debug)]
pub struct MappingArgs {
    /// Write the results to this folder. They replace an older run's results all at once at the end; a run that is cut
    /// short replaces no complete result and goes to its subfolder interrupted.
    #[arg(short = 'o', long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Side of a cell of the map, m.
    #[arg(long, default_value = "0.05", value_parser = numbers::cell_m, allow_hyphen_values = true)]
    resolution: f64,
    /// Set a parameter of the estimator; docs/robots.md lists them.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    settings: Vec<(String, f64)>,
    /// Continue this session, or the session in a run's folder, with its parameters. The log is the rest of its recording, or
    /// a recording of another day, whose robot is first searched for on the session's map.
    #[arg(long = "continue", value_name = "SESSION", conflicts_with = "settings")]
    session: Option<PathBuf>,
    /// Pose of the first scan on the session's map: x,y,deg in metres and degrees, or anywhere.
    #[arg(
        long,
        value_name = "x,y,deg|anywhere",
        requires = "session",
        allow_hyphen_values = true
    )]
    init: Option<Init>,
    /// Mark free space in the map along beams without a return, up to the sensor's limit (REP 117).
    #[arg(long)]
    free_space: bool,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
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
    /// Time per scan: median, 99 %, worst, and those of the first and the last tenth; null with fewer than ten scans.
    ticks: Option<TickSummary>,
    /// Whether Ctrl-C, SIGTERM or an unreadable log ended the run early.
    interrupted: bool,
    /// Folder of the results.
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<PathBuf>,
    /// What should be checked, one sentence each.
    doubts: Vec<String>,
    /// Every keyframe with its covariance, and every loop with its evidence.
    quality: Quality,
    #[serde(skip_serializing_if = "Option::is_none")]
    relations: Option<Grade>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<Grade>,
}

/// A run of the estimator.
pub struct Mapping<'a> {
    args: &'a MappingArgs,
    /// The run so far.
    pub run: LogRun,
    /// The session's mounting of the laser.
    pub laser_before: Option<LaserMount>,
    costs: TickCosts,
    reference: Option<Reference>,
}

/// How the scans ended.
#[derive(Default)]
pub struct Ended {
    /// Sentences on what was corrected.
    pub remarks: Vec<String>,
    /// What was found and chosen.
    pub about: Vec<String>,
    /// Whether a signal cut the run short.
    pub is_interrupted: bool,
    /// Why the log cannot be read further.
    pub broken: Option<anyhow::Error>,
    /// To whom the result is shown, too.
    pub shown: Option<Shown>,
}

impl<'a> Mapping<'a> {
    /// Starts a new run, or one that continues a session.
    ///
    /// # Errors
    /// If a file, the folder or a parameter cannot be used.
    pub fn start(args: &'a MappingArgs) -> anyhow::Result<Self> {
        let reference = args.reference.read()?;
        if let Some(folder) = &args.output {
            check_folder(folder).in_file(folder)?;
        }
        let (run, laser_before) = start(args)?;
        Ok(Self {
            args,
            run,
            laser_before,
            costs: TickCosts::default(),
            reference,
        })
    }

    /// Takes the next scan; returns `None` if it is skipped.
    pub fn step(&mut self, frame: LogFrame) -> Option<SlamReport> {
        let (report, ms) = timed(|| self.run.step(frame));
        self.costs.push(ms);
        report
    }

    /// Starts to show the map to clients at this address.
    ///
    /// # Errors
    /// If it is taken or not this computer's.
    pub fn show_at(&self, at: ServeAt) -> io::Result<Shown> {
        Shown::start(
            at,
            self.args.resolution,
            NoReturn::free_if(self.args.free_space),
        )
    }

    /// Ends the run on `name`, writes its folder, whose report has this title, and prints the result; the exit code
    /// tells whether the run reached its end.
    ///
    /// # Errors
    /// If there is no map or a file cannot be written.
    pub fn end(self, name: &str, title: &str, ended: Ended) -> anyhow::Result<ExitCode> {
        let Self {
            args,
            mut run,
            costs,
            reference,
            ..
        } = self;
        let Ended {
            mut remarks,
            about,
            is_interrupted,
            broken,
            shown,
        } = ended;
        run.finish();
        if run.scans() == 0 && run.late() > 0 {
            bail!(
                "{name}: no scan is later than the session's last one; pass the rest of that recording, or run the log without --continue"
            );
        }
        remarks.extend(run.sentences(name));
        for remark in &remarks {
            eprintln!("slam2d: {remark}");
        }
        if let Some(problem) = run.no_map() {
            bail!("{name}: no scan could be used: {problem}");
        }
        if run.scans() == 0 {
            bail!("{name}: it was interrupted before its first scan");
        }
        let trajectory = run.trajectory();
        let grade = reference
            .as_ref()
            .map(|reference| reference.grade(&trajectory))
            .transpose();
        let mut quality = run.quality();
        if is_interrupted {
            let cause = match &broken {
                Some(_) => "the log cannot be read further",
                None => "it was interrupted",
            };
            let doubt = format!(
                "{CUT_SHORT} after {} scans: {cause}; the rest of the log is missing",
                run.scans()
            );
            quality.doubts.insert(0, doubt);
        }
        let mut folder = args.output.clone();
        if let Some(wanted) = folder.as_mut().filter(|_| is_interrupted) {
            let of_part = folder_of_part(wanted);
            if of_part != *wanted {
                eprintln!(
                    "slam2d: {} keeps the result of a complete run; the new result goes to {}",
                    wanted.display(),
                    of_part.display()
                );
            }
            *wanted = of_part;
        }
        if let Some(folder) = &folder {
            remarks.extend(about);
            let results = Results {
                log: title,
                run: &run,
                quality: &quality,
                remarks: &remarks,
                cell_m: args.resolution,
                no_return: NoReturn::free_if(args.free_space),
                is_whole: !is_interrupted,
            };
            if let Some(sentence) = write_folder(folder, &results)? {
                eprintln!("slam2d: {name}: {sentence}");
            }
        }
        if let Some(shown) = shown {
            shown.end(&run);
        }
        // Write the results before reporting any later error.
        let grade = grade?;
        if let Some(error) = broken {
            return Err(error);
        }
        let (relations, truth) = by_reference(grade);
        let doubts = std::mem::take(&mut quality.doubts);
        let result = RunJson {
            scans: run.scans(),
            keyframes: run.slam().map_or(0, |slam| slam.keyframes().len()),
            loops_tried: run.loops().len(),
            loops_accepted: run.loops().iter().filter(|tried| tried.accepted).count(),
            cpu_s: process::cpu_s(),
            peak_mb: process::peak_mb(),
            ticks: costs.summary(),
            interrupted: is_interrupted,
            folder,
            doubts,
            quality,
            relations,
            truth,
        };
        if args.json {
            print_json(&result);
        } else {
            print_text(&result);
        }
        Ok(interrupt::exit_code(is_interrupted))
    }
}

/// A new run, or one that continues a session, and the session's mounting of the laser.
fn start(args: &MappingArgs) -> anyhow::Result<(LogRun, Option<LaserMount>)> {
    let Some(path) = &args.session else {
        let mut run = LogRun::default();
        for (name, value) in &args.settings {
            run = run.with_setting(Setting::named(name)?, *value)?;
        }
        return Ok((run, None));
    };
    let (session, _) = read_session(path)?;
    let mut run = LogRun::resume(&session).in_file(path)?;
    if let Some(Init(start)) = args.init {
        run = run.starting_at(start);
    }
    let mount = session.sensor.as_ref().map(|sensor| LaserMount {
        body_from_sensor: sensor.body_from_sensor,
        is_flipped: false,
    });
    Ok((run, mount))
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
    if let Some(ticks) = result.ticks {
        say!(
            "a scan           {:.2} ms in the first tenth, {:.2} ms in the last (medians); 99% within {:.1} ms, worst {:.1} ms",
            ticks.first.median_ms,
            ticks.last.median_ms,
            ticks.p99_ms,
            ticks.worst_ms
        );
    }
    for doubt in &result.doubts {
        say!("doubt            {doubt}");
    }
    if let Some(grade) = result.relations.or(result.truth) {
        grade.print();
    }
}
