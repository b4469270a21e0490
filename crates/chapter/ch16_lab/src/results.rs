//! The results table of many laps: the distribution of each of its entries.
//!
//! This module evaluates finished laps; the caller runs them, on any number of threads.

use pr_geom::sort_numbers;
use serde::{Deserialize, Serialize};

use crate::incremental::{IncrementalOutcome, IncrementalTrace};
use crate::lap::{AcceptedShares, IncrementalKind, LapRecord, LapSummary, PATH_SHARES, PathErrors};

/// A column of the results table: the estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultColumn {
    /// Dead reckoning.
    Odometry,
    /// Scan matching without loops.
    FrontEnd,
    /// The lap as configured.
    WithLoops,
    /// Incremental maximum likelihood mapping, if it was run.
    MaximumLikelihood,
    /// Its variant for cycles, if it was run.
    MaximumLikelihoodCycles,
}

/// A row of the results table: the kind of error, m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultRow {
    /// Position error at the end.
    EndError,
    /// Root mean square position error.
    Rms,
    /// Smallest error of the last nine keyframes.
    LastKeyframesMin,
    /// Largest error of the last nine keyframes.
    LastKeyframesMax,
    /// Largest error of all keyframes.
    KeyframeMax,
    /// Position error halfway along the path.
    HalfWay,
    /// The graph's standard deviation of the position halfway.
    HalfWaySigma,
    /// Distance between the map of the outward path and what the return path saw.
    MapDisagreement,
}

impl ResultColumn {
    /// All columns, from left to right.
    pub const ALL: [Self; 5] = [
        Self::Odometry,
        Self::FrontEnd,
        Self::WithLoops,
        Self::MaximumLikelihood,
        Self::MaximumLikelihoodCycles,
    ];

    /// The column of an incremental method.
    #[must_use]
    pub fn from_incremental(kind: IncrementalKind) -> Self {
        match kind {
            IncrementalKind::MaximumLikelihood => Self::MaximumLikelihood,
            IncrementalKind::WithCycles => Self::MaximumLikelihoodCycles,
        }
    }
}

impl ResultRow {
    /// All rows, from top to bottom.
    pub const ALL: [Self; 8] = [
        Self::EndError,
        Self::Rms,
        Self::LastKeyframesMin,
        Self::LastKeyframesMax,
        Self::KeyframeMax,
        Self::HalfWay,
        Self::HalfWaySigma,
        Self::MapDisagreement,
    ];
}

/// Results of one lap that statistics need.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LapOutcome {
    /// The lap as configured.
    pub lap: LapSummary,
    /// Its front end alone.
    pub front_end: LapSummary,
    /// Loops that were closed.
    pub loops: usize,
    /// Errors of the lap along its path.
    pub lap_way: PathErrors,
    /// Errors of its front end alone.
    pub front_end_way: PathErrors,
    /// Attempts to close a loop, true and false, and those that were accepted.
    pub attempts: AcceptedShares,
    /// Digest of all poses; see [`LapRecord::digest`]. It is serialized in hexadecimal, because some readers'
    /// integers end at 2⁵³.
    #[serde(with = "hexadecimal")]
    pub digest: u64,
    /// Incremental mapping on the same drive, for the methods that were run.
    pub incremental_runs: [Option<IncrementalOutcome>; IncrementalKind::ALL.len()],
}

impl LapOutcome {
    /// Evaluates a finished lap.
    #[must_use]
    pub fn from_record(record: &LapRecord) -> Self {
        Self {
            lap: record.lap.summary,
            front_end: record.front_end.summary,
            loops: record.lap.graph_summary.loops,
            lap_way: record.path_errors(),
            front_end_way: record.front_end_path_errors(),
            attempts: record.lap.accepted_shares(),
            digest: record.digest(),
            incremental_runs: [None; IncrementalKind::ALL.len()],
        }
    }

    /// Adds an incremental method, run on the drive of `record`.
    #[must_use]
    pub fn with_incremental(mut self, kind: IncrementalKind, record: &LapRecord) -> Self {
        let trace = IncrementalTrace::run(kind, &record.config, &record.drive);
        self.incremental_runs[kind as usize] = Some(trace.outcome);
        self
    }

    /// An entry of the results table, m; `None` if the table has a gap.
    #[must_use]
    pub fn entry(&self, column: ResultColumn, row: ResultRow) -> Option<f64> {
        if column == ResultColumn::Odometry {
            return self.odometry_entry(row);
        }
        let (summary, way) = self.of(column)?;
        match row {
            ResultRow::EndError => Some(summary.keyframe_end_error_m),
            ResultRow::Rms => Some(summary.keyframe_rms_m),
            ResultRow::LastKeyframesMin => Some(summary.last_keyframes_m.0),
            ResultRow::LastKeyframesMax => Some(summary.last_keyframes_m.1),
            ResultRow::KeyframeMax => Some(summary.keyframe_max_m),
            ResultRow::HalfWay => Some(way.half_path_length_m()),
            ResultRow::HalfWaySigma => way.half_way_sigma_m,
            ResultRow::MapDisagreement => summary.map_disagreement_m,
        }
    }

    /// Errors of an estimator with keyframes, if it was run.
    fn of(&self, column: ResultColumn) -> Option<(&LapSummary, &PathErrors)> {
        let incremental = |kind: IncrementalKind| {
            let run = self.incremental_runs[kind as usize].as_ref()?;
            Some((&run.summary, &run.way))
        };
        match column {
            ResultColumn::Odometry => None,
            ResultColumn::FrontEnd => Some((&self.front_end, &self.front_end_way)),
            ResultColumn::WithLoops => Some((&self.lap, &self.lap_way)),
            ResultColumn::MaximumLikelihood => incremental(IncrementalKind::MaximumLikelihood),
            ResultColumn::MaximumLikelihoodCycles => incremental(IncrementalKind::WithCycles),
        }
    }

    /// Dead reckoning has neither keyframes nor a map.
    fn odometry_entry(&self, row: ResultRow) -> Option<f64> {
        match row {
            ResultRow::EndError => Some(self.lap.odometry_end_error_m),
            ResultRow::Rms => Some(self.lap.odometry_rms_m),
            _ => None,
        }
    }
}

mod hexadecimal {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(value: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{value:016x}"))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        let digits = <&str>::deserialize(deserializer)?;
        u64::from_str_radix(digits, 16).map_err(D::Error::custom)
    }
}

/// Statistics of laps that differ only in their seed.
#[derive(Clone, Debug, PartialEq)]
pub struct LapStatistics {
    /// The laps, in the order of their seeds.
    pub outcomes: Vec<LapOutcome>,
}

impl LapStatistics {
    /// The distribution of an entry of the results table; `None` if no lap has it.
    #[must_use]
    pub fn spread(&self, column: ResultColumn, row: ResultRow) -> Option<Percentiles> {
        let entries = self.outcomes.iter();
        Percentiles::from_values(entries.filter_map(|outcome| outcome.entry(column, row)))
    }

    /// Medians of the position errors along the path, m, at the ends of its shares; `None` for dead reckoning
    /// and without laps.
    #[must_use]
    pub fn along_path_m(&self, column: ResultColumn) -> Option<[f64; PATH_SHARES + 1]> {
        let laps = self.outcomes.iter();
        let ways: Vec<&PathErrors> = laps.filter_map(|lap| Some(lap.of(column)?.1)).collect();
        let mut medians = [0.0; PATH_SHARES + 1];
        for (k, median) in medians.iter_mut().enumerate() {
            *median = Percentiles::from_values(ways.iter().map(|way| way.errors_m[k]))?.median;
        }
        Some(medians)
    }

    /// Share of the laps that satisfy a condition; NaN without laps.
    #[must_use]
    pub fn share(&self, is_true: impl Fn(&LapOutcome) -> bool) -> f64 {
        let matches = self.outcomes.iter().filter(|outcome| is_true(outcome));
        matches.count() as f64 / self.outcomes.len() as f64
    }

    /// Shares of the laps with 0, 1, 2, and 3 or more closed loops.
    #[must_use]
    pub fn loop_shares(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|loops| self.share(|outcome| outcome.loops.min(3) == loops))
    }

    /// Share of the laps that closed a false loop.
    #[must_use]
    pub fn false_run_share(&self) -> f64 {
        self.share(|outcome| outcome.attempts.of_false[0] > 0)
    }

    /// Closed loops of all laps.
    #[must_use]
    pub fn accepted_loops(&self) -> usize {
        self.outcomes.iter().map(|outcome| outcome.loops).sum()
    }

    /// Attempts of all laps, true and false, and those that were accepted.
    #[must_use]
    pub fn attempts(&self) -> AcceptedShares {
        self.outcomes
            .iter()
            .fold(AcceptedShares::default(), |sum, outcome| {
                sum.plus(&outcome.attempts)
            })
    }
}

/// Median and tails of a distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Percentiles {
    /// One value in twenty is lower.
    pub p05: f64,
    /// Half of the values are lower.
    pub median: f64,
    /// One value in twenty is higher.
    pub p95: f64,
}

impl Percentiles {
    /// The spread of some values; `None` without values.
    #[must_use]
    pub fn from_values(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sort_numbers(&mut sorted);
        Some(Self {
            p05: quantile(&sorted, 0.05)?,
            median: quantile(&sorted, 0.5)?,
            p95: quantile(&sorted, 0.95)?,
        })
    }
}

/// The quantile of sorted values, linear between neighbours (Hyndman & Fan 1996, type 7).
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let position = share * sorted.len().checked_sub(1)? as f64;
    let below = position.floor();
    let low = sorted[below as usize];
    let high = sorted[position.ceil() as usize];
    Some(low + (position - below) * (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::{LapConfig, LapRunner};

    #[test]
    fn quantiles_lie_between_the_sorted_values() {
        let values = [1.0, 2.0, 4.0, 8.0, 16.0];
        assert_eq!(quantile(&values, 0.5), Some(4.0));
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 1.0), Some(16.0));
        // Position 0.05 · 4 = 0.2 between 1 and 2.
        assert_eq!(quantile(&values, 0.05), Some(1.2));
        assert_eq!(Percentiles::from_values([]), None);
        let spread = Percentiles::from_values([8.0, 1.0, 16.0, 4.0, 2.0]).unwrap();
        assert_eq!((spread.p05, spread.median), (1.2, 4.0));
    }

    #[test]
    fn shares_and_counts_are_of_laps_and_of_loops() {
        let record = LapRunner::new().run(&LapConfig::default());
        let right = LapOutcome::from_record(&record);
        let mut wrong = right;
        wrong.loops = 4;
        wrong.attempts.of_false = [2, 3];
        let mut lost = right;
        lost.loops = 0;
        let outcomes = vec![right, wrong, lost, lost];
        let statistics = LapStatistics { outcomes };
        assert_eq!(statistics.loop_shares(), [0.5, 0.0, 0.0, 0.5]);
        assert_eq!(statistics.accepted_loops(), 7);
        assert_eq!(statistics.attempts().of_false, [2, 3]);
        let [accepted, all] = right.attempts.of_true;
        assert_eq!(statistics.attempts().of_true, [4 * accepted, 4 * all]);
        assert_eq!(statistics.false_run_share(), 0.25);
    }

    #[test]
    fn odometry_has_the_two_entries_without_keyframes_and_incremental_mapping_all_but_the_graphs() {
        let record = LapRunner::new().run(&LapConfig::default());
        let outcome = LapOutcome::from_record(&record);
        let entries_of = |column| {
            let rows = ResultRow::ALL.into_iter();
            rows.filter_map(|row| outcome.entry(column, row)).count()
        };
        assert_eq!(ResultColumn::ALL.map(entries_of), [2, 8, 8, 0, 0]);
        let outcome = outcome.with_incremental(IncrementalKind::WithCycles, &record);
        let entries =
            ResultRow::ALL.map(|row| outcome.entry(ResultColumn::MaximumLikelihoodCycles, row));
        // All but the standard deviation, which needs a graph.
        assert_eq!(entries.iter().flatten().count(), 7);
        assert_eq!(
            outcome.entry(ResultColumn::MaximumLikelihood, ResultRow::Rms),
            None
        );
    }
}
