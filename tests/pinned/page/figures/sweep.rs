//! Laps that differ only in their seed, at four noise factors: the variation of the canonical run.
//!
//! The same laps as the defaults of `ch16 sweep`, and the same statistics of the core.

use std::ops::RangeInclusive;

use ch16_lab::lap::{AcceptedShares, LapConfig, LapRecord, LapRunner, LapSummary, TestedLoop};
use ch16_lab::nudge::{NUDGE, NudgeStatistics, farthest_keyframe_m, nudged};
use ch16_lab::results::{LapOutcome, LapStatistics, Percentiles, ResultColumn, ResultRow};
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::metrics::position_error_m;

use super::recorded::Driven;

/// Seeds of the laps.
pub const SEEDS: RangeInclusive<u32> = 1..=1000;
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

/// Statistics of laps, by name, beside those of their estimates and of their attempts to close a loop.
const OF_LAPS: [&str; 13] = [
    "first_loop_raised_percent",
    "rms_grew_percent",
    "rms_grew_with_false_percent",
    "rms_grew_without_false_percent",
    "front_end.rms.p99",
    "loops.0",
    "loops.1",
    "loops.2",
    "loops.3",
    "accepted",
    "false",
    "false_percent",
    "false_runs_percent",
];
const COLUMNS: [(&str, ResultColumn); 3] = [
    ("odometry", ResultColumn::Odometry),
    ("front_end", ResultColumn::FrontEnd),
    ("with_loops", ResultColumn::WithLoops),
];
const ROWS: [(&str, ResultRow); 7] = [
    ("end_error", ResultRow::EndError),
    ("rms", ResultRow::Rms),
    ("last_nine_min", ResultRow::LastKeyframesMin),
    ("last_nine_max", ResultRow::LastKeyframesMax),
    ("max_error", ResultRow::KeyframeMax),
    ("map_disagreement", ResultRow::MapDisagreement),
    ("half_way_sigma", ResultRow::HalfWaySigma),
];

/// The laps of all seeds at all noise factors.
pub struct LapSweep(Vec<OfSeed>);

impl LapSweep {
    /// Drives the laps of every `step`th seed, from the first on.
    pub fn drive(step: usize) -> Self {
        let seeds: Vec<u32> = SEEDS.step_by(step).collect();
        Self(laps(&seeds))
    }

    /// Adds all figures of the laps.
    pub fn add_to(&self, driven: &mut Driven) {
        for (k, (level, noise)) in NOISE.into_iter().enumerate() {
            let mut figures = Laps::new(self.0.iter().map(|laps| &laps.levels[k])).figures();
            figures.push(("noise".to_owned(), Some(noise)));
            driven.add(&format!("sweep.{level}"), figures);
        }
        let exact_gate = Laps::new(self.0.iter().map(|laps| &laps.exact_gate));
        driven.add("sweep.exact_gate", exact_gate.figures());
        let nudged = NudgeStatistics {
            moved_m: self.0.iter().filter_map(|laps| laps.moved_m).collect(),
        };
        let figures = [
            ("laps", nudged.moved_m.len() as f64),
            ("start_fm", 1e15 * nudge_m()),
            ("changed", nudged.changed() as f64),
            ("farthest_m", nudged.farthest_m()),
        ];
        let figures = figures.map(|(name, value)| (name.to_owned(), Some(value)));
        driven.add("sweep.nudge", figures);
        driven.add_digest("sweep", &self.0);
    }

    /// The attempts to close a loop at the canonical noise, in the order of their seeds.
    pub fn attempts(&self) -> impl Iterator<Item = &TestedLoop> {
        self.0.iter().flat_map(|laps| &laps.levels[ONCE].tested)
    }

    /// The seeds, and the rms errors of their front ends at the canonical noise, m.
    pub fn front_end_rms_m(&self) -> impl Iterator<Item = (u32, f64)> {
        let rms_m = |laps: &OfSeed| laps.levels[ONCE].outcome.front_end.keyframe_rms_m;
        self.0.iter().map(move |laps| (laps.seed, rms_m(laps)))
    }
}

/// A lap, its attempts to close a loop, and whether its first loop raised the rms error.
#[derive(Debug)]
struct Lap {
    outcome: LapOutcome,
    tested: Vec<TestedLoop>,
    first_raised: Option<bool>,
}

impl Lap {
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
    fn new<'a>(laps: impl Iterator<Item = &'a Lap> + Clone) -> Self {
        Self {
            statistics: LapStatistics {
                outcomes: laps.clone().map(|lap| lap.outcome).collect(),
            },
            tested: laps.clone().flat_map(|lap| lap.tested.clone()).collect(),
            first_raised: laps.filter_map(|lap| lap.first_raised).collect(),
        }
    }

    /// All figures, by name.
    fn figures(&self) -> Vec<(String, Option<f64>)> {
        let of_path = |name: &str| of_laps(self, &name.split('.').collect::<Vec<_>>());
        let names = ATTEMPTS.iter().chain(&OF_LAPS);
        let mut figures: Vec<_> = names
            .map(|&name| (name.to_owned(), of_path(name)))
            .collect();
        for (column_name, column) in COLUMNS {
            for (row_name, row) in ROWS {
                let spread = self.statistics.spread(column, row);
                let quantiles = [
                    ("low", spread.map(|spread| spread.p05)),
                    ("median", spread.map(|spread| spread.median)),
                    ("high", spread.map(|spread| spread.p95)),
                ];
                figures.extend(quantiles.map(|(quantile, value)| {
                    (format!("{column_name}.{row_name}.{quantile}"), value)
                }));
            }
        }
        figures
    }
}

/// Statistics of attempts to close a loop, by name.
const ATTEMPTS: [&str; 7] = [
    "attempts",
    "base_percent",
    "true_accepted_percent",
    "false_accepted_percent",
    "gate_rejects_percent",
    "false_error.median",
    "false_error.worst",
];

/// One of [`ATTEMPTS`].
pub fn of_attempts(tested: &[TestedLoop], path: &[&str]) -> Option<f64> {
    let [of_true, of_false] =
        AcceptedShares::of(tested, TestedLoop::is_false, |tested| tested.accepted).rates();
    let closed = tested.iter().filter(|tested| tested.accepted);
    let errors_m = closed
        .filter(|tested| tested.error.is_false())
        .map(|tested| tested.error.position_m);
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
        ["false_error", "worst"] => errors_m.max_by(f64::total_cmp)?,
        _ => return None,
    })
}

/// The error that one lap in a hundred exceeds.
pub fn p99(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[errors.len() - 1 - errors.len() / 100]
}

/// One of [`ATTEMPTS`] or of [`OF_LAPS`].
fn of_laps(all: &Laps, path: &[&str]) -> Option<f64> {
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
        ["false_percent"] => {
            100.0 * laps.attempts().of_false[0] as f64 / laps.accepted_loops() as f64
        }
        ["false"] => laps.attempts().of_false[0] as f64,
        ["false_runs_percent"] => 100.0 * laps.false_run_share(),
        ["rms_grew_percent"] => percent(|lap| grew(lap, |lap| lap.keyframe_rms_m)),
        _ => return None,
    })
}

/// The share of the laps with a false closure, or without one, whose rms error the loops raised, %.
fn grew_percent(laps: &LapStatistics, with_false: bool) -> f64 {
    let of_kind = laps
        .outcomes
        .iter()
        .filter(|lap| (lap.attempts.of_false[0] > 0) == with_false);
    let outcomes: Vec<_> = of_kind.copied().collect();
    100.0 * LapStatistics { outcomes }.share(|lap| grew(lap, |lap| lap.keyframe_rms_m))
}

/// The laps of one seed.
#[derive(Debug)]
struct OfSeed {
    seed: u32,
    /// One for each noise factor.
    levels: [Lap; 4],
    /// Movement of the lap at noise ×1 with its start, if it was tried, m.
    moved_m: Option<f64>,
    /// The lap at the largest noise with the exact gate.
    exact_gate: Lap,
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
            seed,
            levels: records.each_ref().map(Lap::new),
            moved_m,
            exact_gate: Lap::new(&runner.run(&exact)),
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
