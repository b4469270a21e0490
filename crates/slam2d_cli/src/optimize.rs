//! `slam2d optimize`: solve a pose graph in a g2o file.

mod whole_file;

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use pr_optim::g2o::{G2oError, G2oFile};
use pr_optim::{
    JacobianModel, Method, OptimizeError, Optimizer, Outcome, Problem, RobustKernel, Session,
    Settings, Start, StopReason,
};
use serde::Serialize;
use thiserror::Error;

use crate::cpu_clock::CpuClock;
use self::whole_file::write_whole;
use crate::output::{print_json, say};

/// First damping of `--method lm`, relative to the diagonal.
const INITIAL_DAMPING: f64 = 1e-6;

/// Largest step, m and rad added, at which a graph without contradictions counts as solved: its
/// cost is rounding noise, of which no share is ever small.
const STEP_TOLERANCE: f64 = 1e-10;

/// Solve a pose graph: g2o in, g2o out.
#[derive(Args, Clone, Debug)]
pub struct OptimizeArgs {
    /// Graph to read: VERTEX_SE2, EDGE_SE2, FIX; other records are kept as they are.
    #[arg(value_name = "IN.g2o")]
    pub input: PathBuf,
    /// Where to write the solved graph. Nothing is written without it.
    #[arg(short, long, value_name = "OUT.g2o")]
    pub output: Option<PathBuf>,
    /// Gauss–Newton or Levenberg–Marquardt.
    #[arg(long, value_enum, default_value_t = MethodName::Gn)]
    pub method: MethodName,
    /// Where to start. `auto` tries the file and a spanning tree, and chordal where they fail.
    #[arg(long, value_enum, default_value_t = StartName::Auto)]
    pub init: StartName,
    /// Robust kernel: none, huber:W (Mahalanobis norm) or dcs:PHI (squared norm).
    #[arg(long, value_parser = KernelName::from_str, default_value = "none")]
    pub kernel: KernelName,
    /// Largest number of iterations of one attempt.
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub max_iters: usize,
    /// Stop where less than this share of χ² is estimated to be left to win.
    #[arg(long, value_name = "T", default_value_t = 1e-8)]
    pub tolerance: f64,
    /// Solve so many times and report the fastest; the result is the same.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeat: u32,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// `--method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Gauss–Newton.
    Gn,
    /// Levenberg–Marquardt.
    Lm,
}

/// `--init`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StartName {
    /// Chosen by the solver.
    Auto,
    /// The poses of the file.
    File,
    /// Along a tree of measurements.
    SpanningTree,
    /// Chordal relaxation.
    Chordal,
}

/// `--kernel`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelName(pub RobustKernel);

impl FromStr for KernelName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let positive = |value: &str| {
            value
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite() && *value > 0.0)
                .ok_or_else(|| format!("`{value}` is not a positive number"))
        };
        match text.split_once(':') {
            None if text == "none" => Ok(Self(RobustKernel::None)),
            Some(("huber", width)) => Ok(Self(RobustKernel::Huber {
                width: positive(width)?,
            })),
            Some(("dcs", phi)) => Ok(Self(RobustKernel::Dcs {
                phi: positive(phi)?,
            })),
            _ => Err("expected none, huber:W or dcs:PHI".to_owned()),
        }
    }
}

/// Why a graph was not solved.
#[derive(Debug, Error)]
pub enum OptimizeFailure {
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not a graph that can be solved.
    #[error("{}: {source}", path.display())]
    Graph {
        /// Which file.
        path: PathBuf,
        /// What is wrong, and in which line.
        source: G2oError,
    },
    /// `--tolerance` is not a number that can be reached.
    #[error("--tolerance: {tolerance} is not a finite number of at least 0")]
    Tolerance {
        /// As it was given.
        tolerance: f64,
    },
    /// No step could be computed.
    #[error("{}: {source}", path.display())]
    Solve {
        /// Which file.
        path: PathBuf,
        /// What went wrong.
        source: OptimizeError,
    },
}

/// What `--json` prints.
#[derive(Clone, Debug, Serialize)]
struct Summary {
    nodes: usize,
    edges: usize,
    init: &'static str,
    iterations: usize,
    total_iterations: usize,
    chi2_initial: f64,
    chi2: f64,
    stop: String,
    cpu_ms: f64,
    cpu_ms_first: f64,
}

/// Reads, solves, writes and prints.
///
/// # Errors
/// Where the file is malformed or cannot be solved; then no output file is touched.
pub fn run(args: &OptimizeArgs) -> Result<(), OptimizeFailure> {
    print_summary(&solve_file(args)?, args.json);
    Ok(())
}

fn solve_file(args: &OptimizeArgs) -> Result<Summary, OptimizeFailure> {
    if !(args.tolerance.is_finite() && args.tolerance >= 0.0) {
        return Err(OptimizeFailure::Tolerance {
            tolerance: args.tolerance,
        });
    }
    let in_file = |source| OptimizeFailure::File {
        path: args.input.clone(),
        source,
    };
    let text = std::fs::read(&args.input).map_err(in_file)?;
    let mut file = G2oFile::parse(&text).map_err(|source| OptimizeFailure::Graph {
        path: args.input.clone(),
        source,
    })?;
    for (record, count) in file.kept_records() {
        eprintln!("{count} × {record} kept as it is, not part of the problem");
    }
    let chi2_initial = file.problem.chi2();
    let solved =
        solve_repeatedly(&mut file.problem, args).map_err(|source| OptimizeFailure::Solve {
            path: args.input.clone(),
            source,
        })?;
    if let Some(path) = &args.output {
        write_whole(path, &file.to_bytes()).map_err(|source| OptimizeFailure::File {
            path: path.clone(),
            source,
        })?;
    }
    Ok(Summary {
        nodes: file.problem.node_count(),
        edges: file.problem.factors().len(),
        init: start_name(solved.outcome.start),
        iterations: solved.outcome.report.iterations,
        total_iterations: solved.outcome.total_iterations,
        chi2_initial,
        chi2: solved.outcome.report.chi2,
        stop: solved.outcome.report.stop.to_string(),
        cpu_ms: solved.best_ms,
        cpu_ms_first: solved.first_ms,
    })
}

struct Solved {
    outcome: Outcome,
    first_ms: f64,
    best_ms: f64,
}

/// Solves from the file's poses `repeat` times; the analysis of the graph is kept after the first.
fn solve_repeatedly(problem: &mut Problem, args: &OptimizeArgs) -> Result<Solved, OptimizeError> {
    let mut optimizer = Optimizer::new(Settings {
        method: match args.method {
            MethodName::Gn => Method::GaussNewton,
            MethodName::Lm => Method::LevenbergMarquardt {
                initial_damping: INITIAL_DAMPING,
            },
        },
        jacobians: JacobianModel::Exact,
        kernel: args.kernel.0,
        max_iterations: args.max_iters,
        step_tolerance: STEP_TOLERANCE,
        decrease_tolerance: args.tolerance,
        ..Settings::default()
    });
    let start = match args.init {
        StartName::Auto => Start::Auto,
        StartName::File => Start::Given,
        StartName::SpanningTree => Start::SpanningTree,
        StartName::Chordal => Start::Chordal,
    };
    let bar = progress_bar();
    let given = problem.poses().to_vec();
    let mut times_ms = Vec::new();
    let outcome = loop {
        problem.poses_mut().copy_from_slice(&given);
        let (outcome, elapsed_ms) = solve_once(&mut optimizer, problem, start, &bar)?;
        times_ms.push(elapsed_ms);
        if times_ms.len() >= args.repeat as usize {
            break outcome;
        }
    };
    bar.finish_and_clear();
    if let StopReason::Failed { error } = outcome.report.stop {
        return Err(error);
    }
    Ok(Solved {
        outcome,
        first_ms: times_ms[0],
        best_ms: times_ms.into_iter().fold(f64::INFINITY, f64::min),
    })
}

/// One solve; the time of the progress bar is not counted.
fn solve_once(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    start: Start,
    bar: &ProgressBar,
) -> Result<(Outcome, f64), OptimizeError> {
    let mut clock = CpuClock::start();
    let mut session = Session::new(optimizer, problem, start)?;
    loop {
        let more = session.step();
        if !more {
            break;
        }
        clock.pause();
        if let Some(step) = session.last_step() {
            bar.set_message(format!("χ² {:.6e}", step.chi2_before));
        }
        bar.inc(1);
        clock.resume();
    }
    let outcome = session.finish();
    clock.pause();
    Ok((outcome, clock.elapsed_ms()))
}

/// A line on a terminal's standard error; nothing where it is not a terminal.
fn progress_bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{spinner} {pos} iterations, {msg} ({elapsed})")
        .expect("the template is well formed");
    ProgressBar::new_spinner().with_style(style)
}

fn print_summary(summary: &Summary, json: bool) {
    if json {
        print_json(summary);
        return;
    }
    say!("nodes         {}", summary.nodes);
    say!("edges         {}", summary.edges);
    say!("init          {}", summary.init);
    say!("iterations    {}", summary.iterations);
    say!("chi2 initial  {:.6}", summary.chi2_initial);
    say!("chi2          {:.6}", summary.chi2);
    say!("stop          {}", summary.stop);
    say!(
        "cpu           {:.3} ms, first {:.3} ms",
        summary.cpu_ms,
        summary.cpu_ms_first
    );
}

fn start_name(start: Start) -> &'static str {
    match start {
        Start::Auto => "auto",
        Start::Given => "file",
        Start::SpanningTree => "spanning-tree",
        Start::Chordal => "chordal",
        Start::LeastSquares => "least-squares",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "\
VERTEX_SE2 0 0 0 0
VERTEX_SE2 1 1.2 0.1 1.5
VERTEX_SE2 2 1 1.1 3.1
VERTEX_SE2 3 0 1 -1.5
EDGE_SE2 0 1 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 1 2 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 2 3 1 0 1.5707963 50 0 0 50 0 100
EDGE_SE2 3 0 1 0 1.6 50 0 0 50 0 100
";

    fn args(input: &Path, output: Option<PathBuf>) -> OptimizeArgs {
        OptimizeArgs {
            input: input.to_owned(),
            output,
            method: MethodName::Gn,
            init: StartName::Auto,
            kernel: KernelName(RobustKernel::None),
            max_iters: 50,
            tolerance: 1e-8,
            repeat: 2,
            json: false,
        }
    }

    #[test]
    fn the_written_graph_has_the_reported_chi2() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("square.g2o");
        let output = folder.path().join("solved.g2o");
        std::fs::write(&input, SQUARE).unwrap();
        let summary = solve_file(&args(&input, Some(output.clone()))).unwrap();
        let written = std::fs::read_to_string(output).unwrap();
        let problem = G2oFile::parse(&written).unwrap().problem;
        // Numbers are written with all their digits: the sum has the same bits.
        assert_eq!(problem.chi2(), summary.chi2);
        // The headings add up to 0.0292 rad too much, at best over four edges of weight 100: 0.0213.
        assert!(summary.chi2 > 0.0213 && summary.chi2 < 0.1);
        assert!(summary.chi2 < 0.01 * summary.chi2_initial);
    }

    #[test]
    fn a_malformed_file_leaves_the_output_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("bad.g2o");
        let output = folder.path().join("solved.g2o");
        std::fs::write(&input, format!("{SQUARE}EDGE_SE2 3 9 1 0 0 1 0 0 1 0 1\n")).unwrap();
        std::fs::write(&output, "old").unwrap();
        let failure = solve_file(&args(&input, Some(output.clone()))).unwrap_err();
        assert!(
            failure
                .to_string()
                .ends_with("bad.g2o: line 9: there is no vertex 9")
        );
        assert_eq!(std::fs::read_to_string(&output).unwrap(), "old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn kernels_are_read_with_their_width() {
        let kernel = |text| KernelName::from_str(text).map(|name| name.0);
        assert_eq!(kernel("none"), Ok(RobustKernel::None));
        assert_eq!(kernel("huber:1.5"), Ok(RobustKernel::Huber { width: 1.5 }));
        assert_eq!(kernel("dcs:10"), Ok(RobustKernel::Dcs { phi: 10.0 }));
        for wrong in ["huber", "huber:0", "dcs:x", "cauchy:1", "none:1"] {
            assert!(kernel(wrong).is_err(), "{wrong}");
        }
    }
}
