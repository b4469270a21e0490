//! Laps that differ only in their seed, at four noise factors: the variation of the canonical run.
//!
//! The same laps as the defaults of `ch16 sweep`, and the same statistics of the core.

use std::ops::RangeInclusive;
use std::sync::OnceLock;
use std::thread;

use ch16_lab::lap::{AcceptedShares, LapConfig, LapRecord, LapRunner, LapSummary, TestedLoop};
use ch16_lab::nudge::{NUDGE, NudgeStatistics, farthest_keyframe_m, nudged};
use ch16_lab::results::{LapOutcome, LapStatistics, Percentiles, ResultColumn, ResultRow};
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::metrics::position_error_m;

const SEEDS: RangeInclusive<u32> = 1..=1000;
/// The number of laps that are also run from a start that differs by rounding, at noise ×1.
const NUDGED_SEEDS: RangeInclusive<u32> = 1..=300;
/// Index in [`NOISE`] of the canonical run.
const ONCE: usize = 1;
/// Index of the largest noise.
const NOISIEST: usize = 3;
/// Factors of the odometry noise, by their names on the page.
const NOISE: [(&str, f64); 4] = [
    ("quarter", 0.25),
    ("once", 1.0),
    ("double", 2.0),
    ("fourfold", 4.0),
];

/// The laps of all seeds at all noise factors.
pub struct LapSweep {
    levels: [Laps; 4],
    /// The laps at the largest noise with the exact gate.
    exact_gate: Laps,
    nudged: NudgeStatistics,
    canonical: LapOutcome,
}

impl LapSweep {
    /// The sweep, computed on first use.
    pub fn shared() -> &'static Self {
        static SWEEP: OnceLock<LapSweep> = OnceLock::new();
        SWEEP.get_or_init(Self::run)
    }

    /// Runs all of them on all cores; the laps are independent, so threads do not affect results.
    fn run() -> Self {
        let seeds: Vec<u32> = SEEDS.collect();
        let workers = thread::available_parallelism().map_or(1, usize::from);
        let shares = seeds.chunks(seeds.len().div_ceil(workers));
        let by_seed: Vec<OfSeed> = thread::scope(|scope| {
            let running: Vec<_> = shares.map(|share| scope.spawn(|| laps(share))).collect();
            let finished = running.into_iter();
            finished
                .flat_map(|worker| worker.join().expect("no lap panics"))
                .collect()
        });
        let level = |k: usize| Laps::new(by_seed.iter().map(|laps| &laps.levels[k]));
        Self {
            levels: [0, 1, 2, 3].map(level),
            exact_gate: Laps::new(by_seed.iter().map(|laps| &laps.exact_gate)),
            nudged: NudgeStatistics {
                moved_m: by_seed.iter().filter_map(|laps| laps.moved_m).collect(),
            },
            canonical: LapOutcome::from_record(&LapRunner::new().run(&LapConfig::default())),
        }
    }

    /// The attempts to close a loop at the canonical noise, in the order of their seeds.
    pub fn attempts(&self) -> &[TestedLoop] {
        &self.levels[ONCE].tested
    }

    /// The rms errors of the front ends at the canonical noise, in the order of their seeds, m.
    pub fn front_end_rms_m(&self) -> impl Iterator<Item = f64> + '_ {
        let laps = self.levels[ONCE].statistics.outcomes.iter();
        laps.map(|lap| lap.front_end.keyframe_rms_m)
    }

    /// `once.with_loops.end_error.median`, `double.loops.0`, `seeds`: statistics by name.
    pub fn value(&self, path: &[&str]) -> Option<f64> {
        let (&name, rest) = path.split_first()?;
        if let Some(level) = NOISE.iter().position(|&(known, _)| known == name) {
            return match *rest {
                ["noise"] => Some(NOISE[level].1),
                _ => of_laps(&self.levels[level], rest, &self.canonical),
            };
        }
        if name == "exact_gate" {
            return of_laps(&self.exact_gate, rest, &self.canonical);
        }
        match *path {
            ["seeds"] => Some(SEEDS.count() as f64),
            ["levels"] => Some(NOISE.len() as f64),
            ["nudge", "laps"] => Some(self.nudged.moved_m.len() as f64),
            ["nudge", "start_fm"] => Some(1e15 * nudge_m()),
            ["nudge", "changed"] => Some(self.nudged.changed() as f64),
            ["nudge", "farthest_m"] => Some(self.nudged.farthest_m()),
            _ => None,
        }
    }
}

/// A lap, its attempts to close a loop, and whether its first loop raised the rms error.
struct Driven {
    outcome: LapOutcome,
    tested: Vec<TestedLoop>,
    first_raised: Option<bool>,
}

impl Driven {
    fn new(record: &LapRecord) -> Self {
        let mut effects = record.lap.loop_attempts().filter_map(|tried| tried.effect);
        Self {
            outcome: LapOutcome::from_record(record),
            tested: record.lap.tested_loops().collect(),
            first_raised: effects
                .next()
                .map(|effect| effect.keyframe_rms_m.after > effect.keyframe_rms_m.before),
        }
    }
}

/// Laps of one setting.
struct Laps {
    statistics: LapStatistics,
    /// The attempts of all laps, in the order of their seeds.
    tested: Vec<TestedLoop>,
    first_raised: Vec<bool>,
}

impl Laps {
    fn new<'a>(laps: impl Iterator<Item = &'a Driven> + Clone) -> Self {
        Self {
            statistics: LapStatistics {
                outcomes: laps.clone().map(|lap| lap.outcome).collect(),
            },
            tested: laps.clone().flat_map(|lap| lap.tested.clone()).collect(),
            first_raised: laps.filter_map(|lap| lap.first_raised).collect(),
        }
    }
}

/// `true_accepted_percent`, `false_error.median`: attempts to close a loop, by name.
pub fn of_attempts(tested: &[TestedLoop], path: &[&str]) -> Option<f64> {
    let [of_true, of_false] =
        AcceptedShares::of(tested, TestedLoop::is_false, |tested| tested.accepted).rates();
    let closed = tested.iter().filter(|tested| tested.accepted);
    let mut errors_m: Vec<f64> = closed
        .filter(|tested| tested.error.is_false())
        .map(|tested| tested.error.position_m)
        .collect();
    errors_m.sort_by(f64::total_cmp);
    Some(match *path {
        ["attempts"] => tested.len() as f64,
        ["base_percent"] => {
            let wrong = tested.iter().filter(|tested| tested.error.is_false());
            100.0 * wrong.count() as f64 / tested.len() as f64
        }
        ["true_accepted_percent"] => 100.0 * of_true,
        ["gate_rejects_percent"] => {
            let gate = LapConfig::default().slam.chapter.loops.gate_chi2;
            let [passed, _] =
                AcceptedShares::of(tested, TestedLoop::is_false, |tested| tested.chi2 <= gate)
                    .rates();
            100.0 * (1.0 - passed)
        }
        ["false_accepted_percent"] => 100.0 * of_false,
        ["false_error", "median"] => Percentiles::from_values(errors_m)?.median,
        ["false_error", "worst"] => *errors_m.last()?,
        _ => return None,
    })
}

/// The error that one lap in a hundred exceeds.
pub fn p99(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[errors.len() - 1 - errors.len() / 100]
}

/// Statistics of laps, by name.
fn of_laps(all: &Laps, path: &[&str], canonical: &LapOutcome) -> Option<f64> {
    let laps = &all.statistics;
    let percent = |is_true: fn(&LapOutcome) -> bool| 100.0 * laps.share(is_true);
    if let Some(value) = of_attempts(&all.tested, path) {
        return Some(value);
    }
    Some(match *path {
        ["first_loop_raised_percent"] => {
            let raised = all.first_raised.iter().filter(|raised| **raised).count();
            100.0 * raised as f64 / all.first_raised.len() as f64
        }
        ["rms_grew_with_false_percent"] => grew_percent(laps, true),
        ["rms_grew_without_false_percent"] => grew_percent(laps, false),
        ["front_end", "rms", "p99"] => {
            let laps = laps.outcomes.iter();
            p99(laps.map(|lap| lap.front_end.keyframe_rms_m).collect())
        }
        ["loops", count] => 100.0 * laps.loop_shares().get(count.parse::<usize>().ok()?)?,
        ["accepted"] => laps.accepted_loops() as f64,
        ["false_percent"] => 100.0 * laps.false_acceptances() as f64 / laps.accepted_loops() as f64,
        ["false"] => laps.false_acceptances() as f64,
        ["false_runs_percent"] => 100.0 * laps.false_run_share(),
        ["rms_grew_percent"] => percent(|lap| grew(lap, |lap| lap.keyframe_rms_m)),
        [column, row, "below_canonical_percent"] => {
            let (column, row) = (column_of(column)?, row_of(row)?);
            let canonical = canonical.entry(column, row)?;
            100.0 * laps.share(|lap| lap.entry(column, row) < Some(canonical))
        }
        [column, row, quantile] => {
            let spread = laps.spread(column_of(column)?, row_of(row)?)?;
            match quantile {
                "low" => spread.p05,
                "median" => spread.median,
                "high" => spread.p95,
                _ => return None,
            }
        }
        _ => return None,
    })
}

/// The share of the laps with a false closure, or without one, whose rms error the loops raised, %.
fn grew_percent(laps: &LapStatistics, with_false: bool) -> f64 {
    let of_kind = laps
        .outcomes
        .iter()
        .filter(|lap| (lap.false_acceptances > 0) == with_false);
    let outcomes: Vec<_> = of_kind.copied().collect();
    100.0 * LapStatistics { outcomes }.share(|lap| grew(lap, |lap| lap.keyframe_rms_m))
}

/// The laps of one seed.
struct OfSeed {
    /// One for each noise factor.
    levels: [Driven; 4],
    /// Movement of the lap at noise ×1 with its start, if it was tried, m.
    moved_m: Option<f64>,
    /// The lap at the largest noise with the exact gate.
    exact_gate: Driven,
}

/// One runner for all: it reuses the simulation of a seed for all noise factors.
fn laps(seeds: &[u32]) -> Vec<OfSeed> {
    let mut runner = LapRunner::new();
    let of_seed = |&seed: &u32| {
        let configs = NOISE.map(|(_, noise)| LapConfig::with_seed_and_noise(seed, noise));
        let records = configs.each_ref().map(|config| runner.run(config));
        let moved_m = NUDGED_SEEDS.contains(&seed).then(|| {
            let twin = runner.run(&nudged(&configs[ONCE], NUDGE));
            farthest_keyframe_m(&records[ONCE], &twin)
        });
        let exact = configs[NOISIEST]
            .clone()
            .with_gate(GateModel::ExactMarginal);
        OfSeed {
            levels: records.each_ref().map(Driven::new),
            moved_m,
            exact_gate: Driven::new(&runner.run(&exact)),
        }
    };
    seeds.iter().map(of_seed).collect()
}

/// Distance of a twin's start from the start, m.
fn nudge_m() -> f64 {
    let config = LapConfig::default();
    let twin = nudged(&config, NUDGE);
    position_error_m(&config.drive.start, &twin.drive.start)
}

/// Whether closing loops increased an error.
fn grew(lap: &LapOutcome, error_m: impl Fn(&LapSummary) -> f64) -> bool {
    error_m(&lap.lap) > error_m(&lap.front_end)
}

fn column_of(name: &str) -> Option<ResultColumn> {
    match name {
        "odometry" => Some(ResultColumn::Odometry),
        "front_end" => Some(ResultColumn::FrontEnd),
        "with_loops" => Some(ResultColumn::WithLoops),
        _ => None,
    }
}

fn row_of(name: &str) -> Option<ResultRow> {
    match name {
        "end_error" => Some(ResultRow::EndError),
        "rms" => Some(ResultRow::Rms),
        "last_nine_min" => Some(ResultRow::LastKeyframesMin),
        "last_nine_max" => Some(ResultRow::LastKeyframesMax),
        "max_error" => Some(ResultRow::KeyframeMax),
        "map_disagreement" => Some(ResultRow::MapDisagreement),
        "half_way_sigma" => Some(ResultRow::HalfWaySigma),
        _ => None,
    }
}
