//! `--shard K/N -o FILE`: one part of the seeds, for one of several machines, and `--merge`, which puts parts together.
//!
//! A file has all digits of each outcome, so the distribution of merged parts is that of one process.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, ensure};
use ch16_lab::lap::{LapEstimator, NamedChoice};
use ch16_lab::results::LapOutcome;
use ch16_slam2d::digest::Digest;
use serde::{Deserialize, Serialize};

use super::SweepArgs;
use crate::lap_options::LapOptions;
use command_line::in_file::InFile as _;
use command_line::numbers::Seeds;
use command_line::whole_file::write_whole;

/// Most shards.
const MAX_SHARDS: u32 = 100_000;

/// Part `number`, counted from 1, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u32,
    count: u32,
}

impl Shard {
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

/// What all parts of a sweep have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SweepIdentity {
    slam2d: String,
    seeds: [u32; 2],
    noise: Vec<f64>,
    estimators: Vec<String>,
    /// Digest of the configuration of the first laps: world, matchers, everything.
    configuration: String,
}

impl SweepIdentity {
    fn new(args: &SweepArgs, trial: &LapOptions) -> Self {
        let mut digest = Digest::new();
        for &noise in &args.noise {
            let words = format!("{:?}", trial.lap(args.seeds.first, noise));
            words.bytes().for_each(|byte| digest.add_bits(byte.into()));
        }
        Self {
            slam2d: env!("CARGO_PKG_VERSION").to_owned(),
            seeds: [args.seeds.first, args.seeds.last],
            noise: args.noise.clone(),
            estimators: args.estimator.iter().map(|e| e.name().to_owned()).collect(),
            configuration: format!("{:016x}", digest.value()),
        }
    }
}

/// The laps of a seed.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct SeedLaps {
    seed: u32,
    /// One for each noise factor.
    outcomes: Vec<LapOutcome>,
}

/// The file of a part.
#[derive(Serialize, Deserialize)]
struct ShardFile {
    sweep: SweepIdentity,
    laps: Vec<SeedLaps>,
}

/// Drives the seeds of a part and writes its file.
///
/// # Errors
/// If the file cannot be written.
pub fn drive(
    args: &SweepArgs,
    trial: &LapOptions,
    part: Shard,
    path: &Path,
) -> anyhow::Result<usize> {
    let seeds: Vec<u32> = (0..)
        .zip(args.seeds.first..=args.seeds.last)
        .filter_map(|(index, seed)| part.contains(index).then_some(seed))
        .collect();
    let by_seed = super::all_runs(args, trial, &seeds);
    let laps = seeds.iter().zip(by_seed);
    let file = ShardFile {
        sweep: SweepIdentity::new(args, trial),
        laps: laps
            .map(|(&seed, outcomes)| SeedLaps { seed, outcomes })
            .collect(),
    };
    write_whole(path, &serde_json::to_vec(&file)?).in_file(path)?;
    Ok(seeds.len() * args.noise.len())
}

/// Merges the files of parts: the arguments of their sweep, and the outcomes of each seed in order.
///
/// # Errors
/// If a file cannot be used, the files belong to different sweeps, or laps are missing.
pub fn merge(args: &SweepArgs) -> anyhow::Result<(SweepArgs, Vec<Vec<LapOutcome>>)> {
    let mut by_seed: HashMap<u32, Vec<LapOutcome>> = HashMap::new();
    let mut first: Option<(&PathBuf, SweepIdentity)> = None;
    for path in &args.merge {
        let text = fs::read(path).in_file(path)?;
        let ShardFile { sweep, laps } = serde_json::from_slice(&text).map_err(|error| {
            anyhow!(
                "{}: {error}; pass a file that ch16 sweep --shard wrote",
                path.display()
            )
        })?;
        let (known, identity) = &*first.get_or_insert_with(|| (path, sweep.clone()));
        ensure!(
            *identity == sweep,
            "{} and {} are of different sweeps; drive all parts with the same program and arguments",
            known.display(),
            path.display()
        );
        for SeedLaps { seed, outcomes } in laps {
            let before = by_seed.insert(seed, outcomes);
            ensure!(
                before.is_none_or(|before| before == by_seed[&seed]),
                "{}: seed {seed} differs from an earlier file; one of the machines computes other bits",
                path.display()
            );
        }
    }
    let (_, identity) = first.expect("clap asks for a file");
    let [first, last] = identity.seeds;
    let missing: Vec<u32> = (first..=last)
        .filter(|seed| by_seed.get(seed).map(Vec::len) != Some(identity.noise.len()))
        .collect();
    ensure!(
        missing.is_empty(),
        "{} of {} seeds are missing, the first is {}; pass the file of their part as well",
        missing.len(),
        Seeds { first, last }.count(),
        missing[0]
    );
    let names = identity.estimators.iter();
    let args = SweepArgs {
        seeds: Seeds { first, last },
        noise: identity.noise,
        estimator: names.filter_map(|name| LapEstimator::named(name)).collect(),
        ..args.clone()
    };
    let laps = (first..=last).filter_map(|seed| by_seed.remove(&seed));
    Ok((args, laps.collect()))
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
