//! `slam2d optimize`: optimizes a pose graph in a g2o file.

mod args;
mod robust;
mod solve;
mod tried;

use anyhow::bail;
use pr_optim::g2o::G2oFile;
use pr_optim::{OptimizeError, RobustKernel};
use robot_io::graph_file::{prepared, with_fix_last};
use serde::Serialize;

pub use self::args::OptimizeArgs;
use self::robust::InlierCounts;
use self::solve::solve_repeatedly;
use self::tried::{TriedJson, start_name};
use command_line::in_file::InFile as _;
use command_line::output::{print_json, say};
use command_line::whole_file::write_whole;

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
    /// The final cost; equals χ² without a kernel.
    cost: f64,
    stop: String,
    /// Every start that was tried, in this order.
    tried: Vec<TriedJson>,
    /// Result of `--robust`; χ² is that of the inliers.
    #[serde(skip_serializing_if = "Option::is_none")]
    robust: Option<InlierCounts>,
    cpu_ms: f64,
    cpu_ms_first: f64,
}

/// Reads, optimizes, writes and prints.
///
/// # Errors
/// If the file is malformed or cannot be optimized; the output file is not written then.
pub fn run(args: &OptimizeArgs) -> anyhow::Result<()> {
    let (file, summary) = solve_file(args)?;
    for (record, count) in file.kept_records() {
        // Priors are part of the problem and were reported before.
        if record != "EDGE_PRIOR_SE2" {
            eprintln!("{count} × {record} kept unchanged, not part of the problem");
        }
    }
    print_summary(&summary, args);
    Ok(())
}

fn solve_file(args: &OptimizeArgs) -> anyhow::Result<(G2oFile, Summary)> {
    let path = &args.input;
    let text = std::fs::read(path).in_file(path)?;
    let prepared = prepared(&text).in_file(path)?;
    let mut file = G2oFile::parse(&prepared.text).in_file(path)?;
    for remark in &prepared.remarks {
        eprintln!("slam2d: {}: {remark}", path.display());
    }
    let chi2_initial = file.problem.chi2();
    if !chi2_initial.is_finite() {
        bail!(
            "{}: line {}: eᵀΩe of this edge is too large for a number: \
             its vertices are too far apart, or its information is too large",
            path.display(),
            file.line_of_factor(worst_factor(&file))
        );
    }
    let solved = solve_repeatedly(&mut file.problem, args)
        .map_err(|error| in_words_of_the_file(&file, error))
        .in_file(path)?;
    if let Some(output) = &args.output {
        let written = file.to_bytes();
        let text = with_fix_last(prepared.own_lines(&written));
        write_whole(output, &text).in_file(output)?;
    }
    let report = solved.outcome.report;
    let summary = Summary {
        nodes: file.problem.node_count() - prepared.helpers,
        edges: file.problem.factors().len() - prepared.priors,
        init: start_name(solved.outcome.start),
        iterations: report.iterations,
        total_iterations: solved.outcome.total_iterations,
        chi2_initial,
        chi2: report.chi2,
        cost: report.cost,
        stop: report.stop.to_string(),
        tried: solved.outcome.tried.iter().map(TriedJson::from).collect(),
        robust: solved.inliers,
        cpu_ms: solved.best_ms,
        cpu_ms_first: solved.first_ms,
    };
    Ok((file, summary))
}

/// The first factor that is not finite at the current poses, or else the largest.
fn worst_factor(file: &G2oFile) -> usize {
    let size = |factor: &usize| {
        let chi2 = file.problem.factor_chi2(*factor);
        if chi2.is_finite() {
            chi2
        } else {
            f64::INFINITY
        }
    };
    // Reversed, because `max_by` returns the last of equal elements.
    (0..file.problem.factors().len())
        .rev()
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .expect("a graph without edges has zero cost")
}

/// Converts a solver's error to vertex and line. Loose ends and indefinite matrices were rejected when the file was
/// read and cannot occur here.
fn in_words_of_the_file(file: &G2oFile, error: OptimizeError) -> String {
    match error {
        OptimizeError::NotPositiveDefinite { node } => format!(
            "line {}: the measurements do not determine the pose of vertex {}: they say \
             nothing about a direction, or their weights differ by too many orders of magnitude",
            file.line_of(node),
            file.id_of(node)
        ),
        OptimizeError::NotFinite => "the steps overflow: try --method lm".to_owned(),
    }
}

fn print_summary(summary: &Summary, args: &OptimizeArgs) {
    if args.json {
        print_json(summary);
        return;
    }
    say!("nodes         {}", summary.nodes);
    say!("edges         {}", summary.edges);
    for tried in &summary.tried {
        say!("tried         {tried}");
    }
    say!("init          {}", summary.init);
    say!("iterations    {}", summary.iterations);
    say!("chi2 initial  {:.6}", summary.chi2_initial);
    say!("chi2          {:.6}", summary.chi2);
    if args.kernel.0 != RobustKernel::None {
        say!("cost          {:.6}, with the kernel", summary.cost);
    }
    if let Some(InlierCounts { loops, inliers, .. }) = summary.robust {
        say!("inliers      {inliers} of {loops} loops");
    }
    say!("stop          {}", summary.stop);
    say!(
        "cpu           {:.3} ms, first {:.3} ms",
        summary.cpu_ms,
        summary.cpu_ms_first
    );
}
