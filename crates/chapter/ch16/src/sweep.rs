//! `ch16 sweep`: statistics of the lap over many seeds and noise factors, on all cores.

mod level;
mod nudge;
mod random;
mod shard;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use anyhow::{bail, ensure};
use ch16_lab::lap::{IncrementalKind, LapEstimator, LapRunner, NamedChoice};
use ch16_lab::results::{LapOutcome, LapStatistics, ResultColumn};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::lap_options::{LapOptions, TrialArgs};
use command_line::choice::choice;
use command_line::numbers::{self, Seeds};
use command_line::output::{print_json, say};
use level::Level;
use shard::Shard;

/// Most laps of one sweep.
const MAX_LAPS: u64 = 10_000_000;

/// Most threads: more than any machine's cores only cost memory.
const MAX_THREADS: usize = 1024;

/// Run the lap at many seeds and noise factors and print the distribution of its figures.
#[derive(Args, Clone, Debug)]
pub struct SweepArgs {
    /// Seeds: A..=B, A..B or one.
    #[arg(long, default_value = "1..=1000", value_parser = numbers::seeds, allow_hyphen_values = true)]
    seeds: Seeds,
    /// Factors of odometry noise, separated by commas.
    #[arg(
        long,
        default_value = "0.25,1,2,4",
        value_delimiter = ',',
        value_parser = numbers::noise_factor,
        allow_hyphen_values = true
    )]
    noise: Vec<f64>,
    /// Estimators of the laps, separated by commas; each has its columns.
    #[arg(
        long,
        default_value = "graph",
        value_delimiter = ',',
        value_parser = choice(LapEstimator::NAMED)
    )]
    estimator: Vec<LapEstimator>,
    #[command(flatten)]
    trial: TrialArgs,
    /// Number of threads, at most one per seed; default: all cores.
    #[arg(long, value_parser = numbers::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
    /// Run each lap again with its start changed by a relative 4e-16, and count the laps that differ.
    #[arg(long, conflicts_with = "estimator")]
    nudge: bool,
    /// Draw the configuration of each lap from the documented ranges, including noise, and check
    /// that every figure is finite.
    #[arg(long, conflicts_with_all = ["nudge", "noise", "world", "matcher", "front_end", "gate", "information", "no_information_cap", "estimator"])]
    random: bool,
    /// Run one part of the seeds and write its laps to the file of -o: 2/4 is the second of four.
    #[arg(long, value_name = "K/N", value_parser = shard::shard, requires = "output", conflicts_with_all = ["nudge", "random"])]
    shard: Option<Shard>,
    /// The file of a part.
    #[arg(short = 'o', long, value_name = "FILE", requires = "shard")]
    output: Option<PathBuf>,
    /// Run no laps: merge the files of all parts and print the distribution of their figures.
    #[arg(
        long,
        value_name = "FILES",
        num_args = 1..,
        conflicts_with_all = [
            "seeds", "noise", "shard", "nudge", "random", "threads", "world", "matcher",
            "loop_matcher", "detector", "gate", "information", "no_information_cap", "estimator",
        ]
    )]
    merge: Vec<PathBuf>,
    /// Print one JSON list with an object for each noise factor.
    #[arg(long)]
    json: bool,
}

/// Runs all laps and prints the distribution of their figures.
///
/// # Errors
/// If the sweep is too large, the world cannot be used, the threads cannot be started, a part cannot be written
/// or merged, or a random lap fails.
pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    if !args.merge.is_empty() {
        let (args, by_seed) = shard::merge(args)?;
        print(&args, &by_seed);
        return Ok(());
    }
    let laps = args.seeds.count() * args.noise.len() as u64;
    ensure!(
        laps <= MAX_LAPS,
        "{laps} laps are too many; use at most {MAX_LAPS}"
    );
    if !args.has_a_graph()
        && let Some(argument) = args.trial.of_the_graph()
    {
        let estimators: Vec<&str> = args.estimator.iter().map(|e| e.name()).collect();
        bail!(
            "{argument} has no effect on {}; omit it or add graph to --estimator",
            estimators.join(", ")
        );
    }
    let trial = args.trial.trial()?;
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = args.threads {
        let useful = usize::try_from(args.seeds.count()).unwrap_or(usize::MAX);
        pool = pool.num_threads(threads.get().min(useful).min(MAX_THREADS));
    }
    let pool = pool.build()?;
    if args.random {
        return pool.install(|| random::print(args));
    }
    if args.nudge {
        pool.install(|| nudge::print(args, &trial));
        return Ok(());
    }
    if let (Some(part), Some(path)) = (args.shard, &args.output) {
        let laps = pool.install(|| shard::drive(args, &trial, part, path))?;
        if args.json {
            print_json(&serde_json::json!({ "output": path, "laps": laps }));
        } else {
            say!("{laps} laps: {}", path.display());
        }
        return Ok(());
    }
    let seeds: Vec<u32> = (args.seeds.first..=args.seeds.last).collect();
    print(args, &pool.install(|| all_runs(args, &trial, &seeds)));
    Ok(())
}

/// Prints the distribution of the figures at each noise factor.
fn print(args: &SweepArgs, by_seed: &[Vec<LapOutcome>]) {
    let level = |(k, &noise): (usize, &f64)| {
        let outcomes = by_seed.iter().map(|runs| runs[k]).collect();
        Level::new(noise, args, &LapStatistics { outcomes })
    };
    let levels: Vec<Level> = args.noise.iter().enumerate().map(level).collect();
    if args.json {
        print_json(&levels);
    } else {
        levels.iter().for_each(Level::print);
    }
}

/// The runs of each of the seeds, one per noise factor.
fn all_runs(args: &SweepArgs, trial: &LapOptions, seeds: &[u32]) -> Vec<Vec<LapOutcome>> {
    let bar = progress_bar(seeds.len() as u64);
    let runs = seeds
        .par_iter()
        .map_init(LapRunner::new, |runner, &seed| {
            let at = |&noise: &f64| args.outcome(runner, trial, seed, noise);
            let runs = args.noise.iter().map(at).collect();
            bar.inc(1);
            runs
        })
        .collect();
    bar.finish_and_clear();
    runs
}

/// A progress bar on standard error in a terminal, one step per seed.
fn progress_bar(seeds: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} seeds, {eta} left")
        .expect("the template is well formed");
    ProgressBar::new(seeds).with_style(style)
}

impl SweepArgs {
    fn has(&self, estimator: LapEstimator) -> bool {
        self.estimator.contains(&estimator)
    }

    /// Whether any column of a pose graph is requested, including the front end alone.
    fn has_a_graph(&self) -> bool {
        self.has(LapEstimator::Graph) || self.has(LapEstimator::FrontEnd)
    }

    /// Whether a column is requested; odometry always is.
    fn shows(&self, column: ResultColumn) -> bool {
        match column {
            ResultColumn::Odometry => true,
            ResultColumn::FrontEnd => self.has_a_graph(),
            ResultColumn::WithLoops => self.has(LapEstimator::Graph),
            ResultColumn::MaximumLikelihood | ResultColumn::MaximumLikelihoodCycles => self
                .incremental_kinds()
                .any(|kind| ResultColumn::from_incremental(kind) == column),
        }
    }

    fn incremental_kinds(&self) -> impl Iterator<Item = IncrementalKind> + '_ {
        let all = IncrementalKind::ALL.into_iter();
        all.filter(|&kind| self.has(LapEstimator::IncrementalKind(kind)))
    }

    fn outcome(
        &self,
        runner: &mut LapRunner,
        trial: &LapOptions,
        seed: u32,
        noise: f64,
    ) -> LapOutcome {
        let mut config = trial.lap(seed, noise);
        if !self.has(LapEstimator::Graph) {
            config = config.without_loops();
        }
        let record = runner.run(&config);
        let outcome = LapOutcome::from_record(&record);
        self.incremental_kinds().fold(outcome, |outcome, kind| {
            outcome.with_incremental(kind, &record)
        })
    }
}
