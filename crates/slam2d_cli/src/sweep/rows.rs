//! `--rows FILE`: the result of each lap of a sweep, one line each, so a sweep can be distributed over
//! machines and resumed.
//!
//! ```text
//! {"sweep": 1, "slam2d": "0.1.0", "seeds": [1, 1000], "noise": [0.25, 1], "laps": "9c1f…"}
//! {"seed": 1, "noise": 0.25, "outcome": {…}}
//! ```
//!
//! The first line identifies the sweep and is the same in the files of all shards. `laps` is a digest of the
//! configuration of its first laps: world, matchers, everything. Rows may be in any order.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use ch16_lab::lap::{Choice, LapEstimator};
use ch16_lab::results::LapOutcome;
use ch16_slam2d::digest::Digest;
use serde::{Deserialize, Serialize};

use super::SweepArgs;
use crate::in_file::InFile as _;
use crate::lap_options::LapOptions;
use crate::numbers::Seeds;

/// Version of the format.
const FORMAT: u32 = 1;

/// Identity of the sweep that the rows of a file belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    sweep: u32,
    slam2d: String,
    seeds: [u32; 2],
    /// Factors of odometry noise.
    pub noise: Vec<f64>,
    estimators: Vec<String>,
    laps: String,
}

/// One lap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LapRow {
    /// Seed.
    pub seed: u32,
    /// Factor of odometry noise.
    pub noise: f64,
    /// Result.
    pub outcome: LapOutcome,
}

impl Header {
    /// The header of the sweep that `args` request.
    pub fn new(args: &SweepArgs, trial: &LapOptions) -> Self {
        let mut digest = Digest::new();
        for &noise in &args.noise {
            let words = format!("{:?}", trial.lap(args.seeds.first, noise));
            words.bytes().for_each(|byte| digest.add_bits(byte.into()));
        }
        Self {
            sweep: FORMAT,
            slam2d: env!("CARGO_PKG_VERSION").to_owned(),
            seeds: [args.seeds.first, args.seeds.last],
            noise: args.noise.clone(),
            estimators: args.estimator.iter().map(|e| e.name().to_owned()).collect(),
            laps: format!("{:016x}", digest.value()),
        }
    }

    /// All seeds.
    pub fn seeds(&self) -> Seeds {
        let [first, last] = self.seeds;
        Seeds { first, last }
    }

    /// The estimators of the laps.
    pub fn estimators(&self) -> Vec<LapEstimator> {
        let names = self.estimators.iter();
        names.filter_map(|name| LapEstimator::named(name)).collect()
    }

    /// How `other` differs; `None` if it is the same sweep.
    fn difference(&self, other: &Self) -> Option<String> {
        let differs = |what: &str, theirs: &str, ours: &str| {
            (theirs != ours).then(|| format!("its {what} {theirs}, not {ours}"))
        };
        let seeds = |header: &Self| format!("{}..={}", header.seeds[0], header.seeds[1]);
        let noise = |header: &Self| format!("{:?}", header.noise);
        differs(
            "format is",
            &other.sweep.to_string(),
            &self.sweep.to_string(),
        )
        .or_else(|| differs("seeds are", &seeds(other), &seeds(self)))
        .or_else(|| differs("noise factors are", &noise(other), &noise(self)))
        .or_else(|| differs("program is slam2d", &other.slam2d, &self.slam2d))
        .or_else(|| {
            (other.laps != self.laps)
                .then(|| "its world, matcher or another option differs".to_owned())
        })
    }
}

/// Rows by seed and noise.
#[derive(Debug, Default)]
pub struct Rows {
    by_lap: HashMap<(u32, u64), LapOutcome>,
}

impl Rows {
    /// The result at `seed` and `noise`, if it is present.
    pub fn get(&self, seed: u32, noise: f64) -> Option<LapOutcome> {
        self.by_lap.get(&(seed, noise.to_bits())).copied()
    }

    /// The laps of every seed in order, with one outcome per noise factor.
    ///
    /// # Errors
    /// If laps are missing.
    pub fn by_seed(&self, header: &Header) -> anyhow::Result<Vec<Vec<LapOutcome>>> {
        let [first, last] = header.seeds;
        let laps =
            (first..=last).flat_map(|seed| header.noise.iter().map(move |&noise| (seed, noise)));
        let is_missing = |&(seed, noise): &(u32, f64)| self.get(seed, noise).is_none();
        if let Some((seed, noise)) = laps.clone().find(is_missing) {
            bail!(
                "{} of {} laps are missing, the first is seed {seed} at noise ×{noise}; drive their \
                 shard again with the same --rows file, or name its file as well",
                laps.clone().filter(is_missing).count(),
                laps.count()
            );
        }
        let of_seed = |seed| {
            header
                .noise
                .iter()
                .filter_map(move |&noise| self.get(seed, noise))
        };
        Ok((first..=last).map(|seed| of_seed(seed).collect()).collect())
    }

    /// Reads the rows of a file; returns its header and the number of bytes of its complete lines. `expected` is
    /// the required header, if known.
    fn read(
        &mut self,
        file: &File,
        path: &Path,
        expected: Option<&Header>,
    ) -> anyhow::Result<(Option<Header>, u64)> {
        let mut source = BufReader::new(file);
        let (mut line, mut number, mut whole_bytes) = (Vec::new(), 0, 0);
        let mut header: Option<Header> = None;
        loop {
            line.clear();
            let bytes = source.read_until(b'\n', &mut line).in_file(path)?;
            // An incomplete last line was being written when the program ended.
            if line.last() != Some(&b'\n') {
                return Ok((header, whole_bytes));
            }
            number += 1;
            let no_row = |problem: String| no_row(path, number, &problem);
            match &header {
                None => {
                    let found: Header = serde_json::from_slice(&line)
                        .map_err(|e| no_row(format!("expected the header of a sweep: {e}")))?;
                    if let Some(difference) = expected.and_then(|ours| ours.difference(&found)) {
                        bail!(
                            "{} holds rows of another sweep: {difference}; give another file",
                            path.display()
                        );
                    }
                    header = Some(found);
                }
                Some(_) => {
                    let row: LapRow = serde_json::from_slice(&line)
                        .map_err(|e| no_row(format!("expected a lap: {e}")))?;
                    let before = self
                        .by_lap
                        .insert((row.seed, row.noise.to_bits()), row.outcome);
                    if before.is_some_and(|before| before != row.outcome) {
                        bail!(
                            "{}: line {number}: seed {} at noise ×{} differs from an earlier row; \
                             one of the machines computes other bits",
                            path.display(),
                            row.seed,
                            row.noise
                        );
                    }
                }
            }
            whole_bytes += bytes as u64;
        }
    }
}

fn no_row(path: &Path, line: usize, problem: &str) -> anyhow::Error {
    anyhow!(
        "{}: line {line}: {problem}; give a file that slam2d sweep --rows wrote",
        path.display()
    )
}

/// Reads the rows of all `paths`, which must belong to one sweep.
///
/// # Errors
/// If a file cannot be read, or the files belong to different sweeps.
pub fn read_all(paths: &[PathBuf]) -> anyhow::Result<(Header, Rows)> {
    let mut rows = Rows::default();
    let mut header: Option<Header> = None;
    for path in paths {
        let file = File::open(path).in_file(path)?;
        let (found, _) = rows.read(&file, path, header.as_ref())?;
        let found = found.ok_or_else(|| no_row(path, 1, "the file is empty"))?;
        header.get_or_insert(found);
    }
    Ok((header.expect("clap asks for a file"), rows))
}

/// A file that rows are appended to.
#[derive(Debug)]
pub struct RowsFile {
    path: PathBuf,
    file: File,
}

impl RowsFile {
    /// Opens or creates `path` for the rows of this sweep, and reads existing rows. If another
    /// program writes to the file, waits until it has ended.
    ///
    /// # Errors
    /// If the file cannot be used, or belongs to another sweep.
    pub fn open(path: &Path, header: &Header) -> anyhow::Result<(Self, Rows)> {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false);
        let file = file.open(path).in_file(path)?;
        if file.try_lock().is_err() {
            eprintln!(
                "slam2d: another sweep writes {}; waiting for its end",
                path.display()
            );
            file.lock().in_file(path)?;
        }
        let mut rows = Rows::default();
        let (found, whole_bytes) = rows.read(&file, path, Some(header))?;
        file.set_len(whole_bytes).in_file(path)?;
        let mut kept = Self {
            path: path.to_owned(),
            file,
        };
        kept.file.seek(SeekFrom::Start(whole_bytes)).in_file(path)?;
        if found.is_none() {
            kept.add(header)?;
        }
        Ok((kept, rows))
    }

    /// Appends a line in one call, so no other program sees a part of it.
    ///
    /// # Errors
    /// If the system cannot write it.
    pub fn add(&mut self, line: &impl Serialize) -> anyhow::Result<()> {
        let mut bytes = serde_json::to_vec(line).expect("plain numbers and lists");
        bytes.push(b'\n');
        self.file.write_all(&bytes).in_file(&self.path)
    }
}
