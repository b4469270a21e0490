//! Figures of thousands of laps: recorded, because the laps take minutes.
//!
//! The record holds each figure twice: of all laps, and of every twentieth seed. A test drives the latter again, so
//! it notices a change of a statistic, and by the digests one of a single bit of these laps. After a change that is
//! meant to change laps, this drives all of them and writes the files; `git diff` then shows what changed:
//!
//! ```sh
//! SLAM_RECORD=1 cargo test -p slam2d_tests recorded_laps
//! ```

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::{env, fs};

use ch16_slam2d::digest::Digest;
use serde::{Deserialize, Serialize};

use super::sweep::LapSweep;
use super::{attempts, consistency};
use crate::page::document::{path_of, source};

const FILE: &str = "tests/pinned/sweeps/figures.json";

/// Step between the seeds of the laps that the suite drives again.
const STEP: usize = 20;

#[derive(Deserialize, Serialize)]
struct Record {
    all: Driven,
    sample: Driven,
}

/// What laps came to.
#[derive(Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Driven {
    /// By name.
    figures: BTreeMap<String, f64>,
    /// Digests of all that the figures come from, by case.
    digests: BTreeMap<String, String>,
}

impl Driven {
    /// Adds the finite ones of some figures.
    pub fn add(&mut self, prefix: &str, figures: impl IntoIterator<Item = (String, Option<f64>)>) {
        let values = figures
            .into_iter()
            .filter_map(|(name, value)| Some((format!("{prefix}.{name}"), value?)));
        self.figures
            .extend(values.filter(|(_, value)| value.is_finite()));
    }

    /// Adds the digest of the laps of a case, which print all their digits.
    pub fn add_digest(&mut self, case: &str, laps: &[impl std::fmt::Debug]) {
        let mut digest = Digest::new();
        for byte in format!("{laps:?}").bytes() {
            digest.add_bits(u64::from(byte));
        }
        let digest = format!("{:016x}", digest.value());
        self.digests.insert(case.to_owned(), digest);
    }

    fn new(sweep: &LapSweep, step: usize) -> Self {
        let mut driven = Self::default();
        sweep.add_to(&mut driven);
        consistency::add_to(&mut driven, step);
        attempts::add_to(&mut driven, sweep);
        driven
    }
}

/// The recorded figure of that name.
pub fn value(name: &str) -> Option<f64> {
    static RECORD: OnceLock<Record> = OnceLock::new();
    let record = RECORD.get_or_init(|| serde_json::from_str(&source(FILE)).expect("a record"));
    record.all.figures.get(name).copied()
}

#[test]
fn the_recorded_laps_are_those_of_the_core() {
    let sample = LapSweep::drive(STEP);
    let driven = Driven::new(&sample, STEP);
    if env::var_os("SLAM_RECORD").is_some() {
        let sweep = LapSweep::drive(1);
        let record = Record {
            all: Driven::new(&sweep, 1),
            sample: driven,
        };
        let text = serde_json::to_string_pretty(&record).expect("numbers and names") + "\n";
        fs::write(path_of(FILE), text).expect("the record");
        attempts::write(&sweep);
        return;
    }
    let recorded: Record = serde_json::from_str(&source(FILE)).expect("a record");
    for (name, value) in &driven.figures {
        assert_eq!(recorded.sample.figures.get(name), Some(value), "{name}");
    }
    assert_eq!(recorded.sample, driven);
    attempts::check(&sample);
}
