//! Distribution of the figures of the laps at one noise factor.

use ch16_lab::lap::{AcceptedShares, LapEstimator};
use ch16_lab::results::{LapStatistics, ResultColumn, ResultRow};
use serde::{Serialize, Serializer};

use super::SweepArgs;
use command_line::output::say;

/// Most laps whose digests are printed.
const MAX_SAMPLES: usize = 20;

/// The runs at one noise factor.
#[derive(Serialize)]
pub struct Level {
    noise: f64,
    runs: usize,
    /// Shares of the runs with 0, 1, 2 and 3 or more accepted loops.
    loop_shares: [f64; 4],
    accepted_loops: usize,
    /// Accepted attempts and all, of the true loops and of the false ones, which are off by more than 0.3 m or 5°.
    attempts: AcceptedShares,
    /// Share of the runs with a false acceptance.
    false_run_share: f64,
    /// Whether loop closure was on.
    #[serde(skip)]
    has_loops: bool,
    entries: Vec<Entry>,
    /// Medians of the errors at equal shares of the path, from start to end.
    along_the_way: AlongTheWay,
    /// Digests of some laps, evenly spaced: for comparing bits by running only these.
    samples: Vec<Sample>,
}

/// Medians of position errors, m.
#[derive(Serialize)]
struct AlongTheWay {
    front_end: Vec<f64>,
    with_loops: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ml: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ml_cycles: Vec<f64>,
}

/// A lap with its digest.
#[derive(Serialize)]
struct Sample {
    seed: u32,
    digest: String,
}

/// A row of the results table over the runs; runs without it are left out.
///
/// Column and row are stable ids; [`column_title`] and [`row_title`] are display names.
#[derive(Serialize)]
struct Entry {
    #[serde(serialize_with = "column_id")]
    column: ResultColumn,
    #[serde(serialize_with = "row_id")]
    row: ResultRow,
    /// 5th percentile, m.
    p05: f64,
    /// Median, m.
    median: f64,
    /// 95th percentile, m.
    p95: f64,
}

impl Level {
    /// Collects the results of the runs at one factor.
    pub fn new(noise: f64, args: &SweepArgs, statistics: &LapStatistics) -> Self {
        Self {
            noise,
            runs: statistics.outcomes.len(),
            loop_shares: statistics.loop_shares(),
            accepted_loops: statistics.accepted_loops(),
            attempts: statistics.attempts(),
            false_run_share: statistics.false_run_share(),
            has_loops: args.has(LapEstimator::Graph),
            entries: entries(args, statistics),
            along_the_way: AlongTheWay::from_statistics(statistics),
            samples: samples(args.seeds.first, statistics),
        }
    }

    /// Prints the distribution as text.
    pub fn print(&self) {
        say!("noise ×{}, {} runs", self.noise, self.runs);
        if self.has_loops {
            print_loops(self);
        }
        say!(
            "  {:<12} {:<38} {:>8} {:>8} {:>8}",
            "",
            "",
            "5%",
            "median",
            "95%"
        );
        for entry in &self.entries {
            say!(
                "  {:<12} {:<38} {:>8.4} {:>8.4} {:>8.4}",
                column_title(entry.column),
                row_title(entry.row),
                entry.p05,
                entry.median,
                entry.p95
            );
        }
    }
}

impl AlongTheWay {
    fn from_statistics(statistics: &LapStatistics) -> Self {
        let medians = |column| {
            let medians = statistics.along_path_m(column);
            medians.map(Vec::from).unwrap_or_default()
        };
        Self {
            front_end: medians(ResultColumn::FrontEnd),
            with_loops: medians(ResultColumn::WithLoops),
            ml: medians(ResultColumn::MaximumLikelihood),
            ml_cycles: medians(ResultColumn::MaximumLikelihoodCycles),
        }
    }
}

fn samples(first_seed: u32, statistics: &LapStatistics) -> Vec<Sample> {
    let outcomes = &statistics.outcomes;
    let seeds = (first_seed..).zip(outcomes);
    seeds
        .step_by(outcomes.len().div_ceil(MAX_SAMPLES).max(1))
        .map(|(seed, outcome)| Sample {
            seed,
            digest: format!("{:016x}", outcome.digest),
        })
        .collect()
}

fn entries(args: &SweepArgs, statistics: &LapStatistics) -> Vec<Entry> {
    let cells = ResultColumn::ALL
        .into_iter()
        .filter(|&column| args.shows(column))
        .flat_map(|column| ResultRow::ALL.into_iter().map(move |row| (column, row)));
    cells
        .filter_map(|(column, row)| {
            let spread = statistics.spread(column, row)?;
            Some(Entry {
                column,
                row,
                p05: spread.p05,
                median: spread.median,
                p95: spread.p95,
            })
        })
        .collect()
}

fn column_id<S: Serializer>(column: &ResultColumn, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match column {
        ResultColumn::Odometry => "odometry",
        ResultColumn::FrontEnd => "front_end",
        ResultColumn::WithLoops => "with_loops",
        ResultColumn::MaximumLikelihood => "ml",
        ResultColumn::MaximumLikelihoodCycles => "ml_cycles",
    })
}

/// The names that the figures of the page use as well.
fn row_id<S: Serializer>(row: &ResultRow, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match row {
        ResultRow::EndError => "end_error",
        ResultRow::Rms => "rms",
        ResultRow::LastKeyframesMin => "last_nine_min",
        ResultRow::LastKeyframesMax => "last_nine_max",
        ResultRow::KeyframeMax => "max_error",
        ResultRow::HalfWay => "half_way",
        ResultRow::HalfWaySigma => "half_way_sigma",
        ResultRow::MapDisagreement => "map_disagreement",
    })
}

fn column_title(column: ResultColumn) -> &'static str {
    match column {
        ResultColumn::Odometry => "odometry",
        ResultColumn::FrontEnd => "front end",
        ResultColumn::WithLoops => "with loops",
        ResultColumn::MaximumLikelihood => "ml",
        ResultColumn::MaximumLikelihoodCycles => "ml, cycles",
    }
}

fn row_title(row: ResultRow) -> &'static str {
    match row {
        ResultRow::EndError => "position error at the end (m)",
        ResultRow::Rms => "rms position error (m)",
        ResultRow::LastKeyframesMin => "best of the last nine keyframes (m)",
        ResultRow::LastKeyframesMax => "worst of the last nine keyframes (m)",
        ResultRow::KeyframeMax => "largest keyframe error (m)",
        ResultRow::HalfWay => "error at half of the path (m)",
        ResultRow::HalfWaySigma => "standard deviation by the graph (m)",
        ResultRow::MapDisagreement => "map self-disagreement (m)",
    }
}

fn print_loops(level: &Level) {
    let [none, one, two, more] = level.loop_shares.map(|share| 100.0 * share);
    say!(
        "  accepted loops: 0 in {none:.1}%, 1 in {one:.1}%, 2 in {two:.1}%, 3 or more in {more:.1}%"
    );
    say!(
        "  false loops among them: {} of {}, in {:.1}% of the runs",
        level.attempts.of_false[0],
        level.accepted_loops,
        100.0 * level.false_run_share
    );
    let AcceptedShares { of_true, of_false } = level.attempts;
    let [true_percent, false_percent] = level.attempts.rates().map(|rate| 100.0 * rate);
    say!(
        "  accepted attempts: {} of {} true ones, {true_percent:.1}%; {} of {} false ones, {false_percent:.1}%",
        of_true[0],
        of_true[1],
        of_false[0],
        of_false[1],
    );
}
