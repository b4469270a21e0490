//! `--shard K/N`: one part of the seeds, for one of several machines.

use std::path::Path;
use std::sync::Mutex;

use ch16_lab::lap::LapRunner;
use ch16_lab::results::LapOutcome;
use rayon::prelude::*;

use super::rows::{Header, LapRow, RowsFile};
use super::{SweepArgs, progress_bar};
use crate::lap_options::LapOptions;

/// Most shards.
const MAX_SHARDS: u32 = 100_000;

/// Part `number`, counted from 1, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u32,
    count: u32,
}

impl Shard {
    /// A single shard with all seeds.
    pub const WHOLE: Self = Self {
        number: 1,
        count: 1,
    };

    /// Whether the seed at this index is in the shard. Consecutive seeds go to different shards, which
    /// balances their run times.
    fn contains(self, index: u32) -> bool {
        index % self.count == self.number - 1
    }
}

/// Parses `2/4`, the second of four.
pub fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/');
    let parts = parts.and_then(|(number, count)| Some((number.parse().ok()?, count.parse().ok()?)));
    match parts {
        Some((number, count)) if (1..=count).contains(&number) && count <= MAX_SHARDS => {
            Ok(Shard { number, count })
        }
        _ => Err(format!(
            "not a part such as 2/4, the second of four, of at most {MAX_SHARDS}"
        )),
    }
}

/// Result of a shard.
pub struct ShardResult {
    /// Number of laps in the file.
    pub laps: usize,
    /// Number of laps that were in the file before.
    pub kept: usize,
    /// The outcomes of every seed of the shard, one for each noise factor.
    pub by_seed: Vec<Vec<LapOutcome>>,
}

/// Runs the laps of a shard that `file` lacks, and appends each result.
///
/// # Errors
/// If a row cannot be written; earlier rows are kept.
pub fn drive(
    args: &SweepArgs,
    trial: &LapOptions,
    part: Shard,
    path: &Path,
) -> anyhow::Result<ShardResult> {
    let header = Header::new(args, trial);
    let (file, rows) = RowsFile::open(path, &header)?;
    let file = Mutex::new(file);
    let seeds: Vec<u32> = (0..)
        .zip(args.seeds.first..=args.seeds.last)
        .filter_map(|(index, seed)| part.contains(index).then_some(seed))
        .collect();
    let bar = progress_bar(seeds.len() as u64);
    let by_seed: anyhow::Result<Vec<Vec<(LapOutcome, bool)>>> = seeds
        .into_par_iter()
        .map_init(LapRunner::new, |runner, seed| {
            let mut at = |&noise: &f64| {
                if let Some(outcome) = rows.get(seed, noise) {
                    return Ok((outcome, true));
                }
                let outcome = args.outcome(runner, trial, seed, noise);
                let row = LapRow {
                    seed,
                    noise,
                    outcome,
                };
                file.lock().expect("no other thread panicked").add(&row)?;
                Ok((outcome, false))
            };
            let laps = args.noise.iter().map(&mut at).collect();
            bar.inc(1);
            laps
        })
        .collect();
    bar.finish_and_clear();
    let by_seed = by_seed?;
    let laps = by_seed.iter().map(Vec::len).sum();
    let kept = by_seed.iter().flatten().filter(|(_, kept)| *kept).count();
    let outcomes = |laps: Vec<(LapOutcome, bool)>| laps.into_iter().map(|(lap, _)| lap).collect();
    Ok(ShardResult {
        laps,
        kept,
        by_seed: by_seed.into_iter().map(outcomes).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_is_in_exactly_one_shard() {
        for count in 1..12 {
            for index in 0..50 {
                let shards = (1..=count).map(|number| Shard { number, count });
                assert_eq!(shards.filter(|shard| shard.contains(index)).count(), 1);
            }
        }
        assert!(Shard::WHOLE.contains(7));
    }

    #[test]
    fn a_shard_is_a_part_of_a_whole() {
        assert_eq!(
            shard("2/4"),
            Ok(Shard {
                number: 2,
                count: 4
            })
        );
        for text in [
            "0/4",
            "5/4",
            "1",
            "1/0",
            "a/b",
            "1/2/3",
            "-1/2",
            "1/999999999",
            "",
        ] {
            assert!(shard(text).unwrap_err().starts_with("not a part"), "{text}");
        }
    }
}
