//! `cargo xtask fuzz`: every door from outside under libFuzzer, one after the other.
//!
//! The doors are functions in `tests/doors`; `fuzz/` gives each a target. What a run finds new goes
//! to `target/fuzz/corpus`, what makes a door panic to `fuzz/artifacts`. `--keep` takes the smallest
//! inputs that together reach as much code as all do into `fuzz/corpus`, which the ordinary tests
//! replay. The tally of all runs on this machine is in `target/fuzz/tally.txt`.

mod coverage;
mod run;
mod tally;
mod targets;

use std::fs;
use std::path::PathBuf;

use crate::run::{Failure, cargo, root, step};
use crate::tools;
use run::TargetRun;
use tally::Tally;
use targets::{TARGETS, Target};

/// What to fuzz, and for how long.
#[derive(Debug, PartialEq)]
pub struct Fuzz {
    /// One target alone.
    pub target: Option<String>,
    /// Minutes in all, shared alike by the targets.
    pub minutes: f64,
    /// Whether the new inputs that reach new code are taken into `fuzz/corpus`.
    pub keep: bool,
}

impl Default for Fuzz {
    fn default() -> Self {
        Self {
            target: None,
            minutes: 7.0,
            keep: false,
        }
    }
}

/// Reads the words after `cargo xtask fuzz`.
///
/// # Errors
/// One line that names the word that does not fit.
pub fn parse(words: &mut impl Iterator<Item = String>) -> Result<Fuzz, String> {
    let mut fuzz = Fuzz::default();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--keep" => fuzz.keep = true,
            "--minutes" => {
                let minutes = words.next().and_then(|word| word.parse().ok());
                fuzz.minutes = minutes
                    .filter(|&minutes: &f64| minutes > 0.0 && minutes.is_finite())
                    .ok_or("--minutes takes a number above 0")?;
            }
            "--target" => {
                let names = TARGETS.map(|target| target.name);
                let name = words.next().filter(|name| names.contains(&name.as_str()));
                fuzz.target = Some(name.ok_or(format!("--target takes {}", names.join(", ")))?);
            }
            _ => return Err(format!("fuzz does not take `{word}`")),
        }
    }
    Ok(fuzz)
}

/// Builds the targets, runs them, and prints what was executed, found and covered.
///
/// # Errors
/// Where a target cannot be built, or an input made a door panic.
pub fn fuzz(fuzz: &Fuzz) -> Result<(), Failure> {
    tools::ensure_cargo_tool("cargo-fuzz", "cargo-fuzz", CARGO_FUZZ)?;
    step(
        "Building the fuzz targets",
        cargo()
            .args(["fuzz", "build", "--sanitizer", "none"])
            .current_dir(root().join("fuzz"))
            .env("PATH", tools::path_with_tools())
            // The counters for the fuzzer are an unstable option of the stable compiler.
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_TARGET_DIR", folder().join("build")),
    )?;
    let chosen: Vec<&Target> = TARGETS
        .iter()
        .filter(|target| {
            fuzz.target
                .as_deref()
                .is_none_or(|name| name == target.name)
        })
        .collect();
    let seconds = (60.0 * fuzz.minutes / chosen.len() as f64).ceil() as u64;
    let mut tally = Tally::read();
    let mut runs = Vec::new();
    for target in &chosen {
        let run = TargetRun::of(target, seconds)?;
        tally.add(target.name, run.executions, run.seconds);
        tally.write()?;
        runs.push(run);
    }
    if fuzz.keep {
        for target in &chosen {
            run::keep(target)?;
        }
    }
    let covered = coverage::measure(&chosen);
    print_table(&chosen, &runs, &tally, covered.as_deref());
    if let Err(failure) = covered {
        println!("no coverage of the sources: {failure}");
    }
    let found: Vec<String> = runs.into_iter().flat_map(|run| run.found).collect();
    if found.is_empty() {
        return Ok(());
    }
    Err(Failure::new(format!(
        "inputs that make a door panic: {}; mend the code, and move them to fuzz/found/TARGET, where \
         the tests replay them",
        found.join(", ")
    )))
}

/// Pinned: what its flags do to the build is part of the figures.
const CARGO_FUZZ: &str = "0.13.2";

/// What the fuzzer keeps for itself.
fn folder() -> PathBuf {
    root().join("target/fuzz")
}

/// A folder of inputs that are part of the project, if there is one.
fn committed(kind: &str, target: &Target) -> Option<PathBuf> {
    let folder = root().join("fuzz").join(kind).join(target.name);
    fs::exists(&folder).unwrap_or(false).then_some(folder)
}

fn print_table(
    targets: &[&Target],
    runs: &[TargetRun],
    tally: &Tally,
    covered: Result<&[coverage::Lines], &Failure>,
) {
    println!();
    println!(
        "{:<14} {:>13} {:>10} {:>15} {:>13} {:>9}",
        "target", "executions", "a second", "edges", "lines", "in all"
    );
    for (index, (target, run)) in targets.iter().zip(runs).enumerate() {
        let lines = covered.map_or("-".to_owned(), |covered| covered[index].to_string());
        println!(
            "{:<14} {:>13} {:>10.0} {:>15} {:>13} {:>9.1e}",
            target.name,
            run.executions,
            run.executions as f64 / run.seconds.max(1e-9),
            format!("{} of {}", run.edges, run.all_edges),
            lines,
            tally.executions(target.name) as f64,
        );
    }
    println!(
        "In all on this machine: {:.2e} executions in {:.0} minutes.",
        tally.all_executions() as f64,
        tally.all_seconds() / 60.0
    );
    println!("Edges: of the whole program. Lines: of the sources behind the door.");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_line(line: &str) -> Result<Fuzz, String> {
        parse(&mut line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn minutes_and_target_are_read_and_checked() {
        let expected = Fuzz {
            target: Some("g2o".to_owned()),
            minutes: 0.5,
            keep: true,
        };
        assert_eq!(
            parse_line("--target g2o --minutes 0.5 --keep"),
            Ok(expected)
        );
        assert_eq!(parse_line(""), Ok(Fuzz::default()));
        for (line, word) in [
            ("--target all", "links, messages"),
            ("--minutes 0", "above 0"),
            ("--minutes", "above 0"),
            ("now", "`now`"),
        ] {
            assert!(parse_line(line).unwrap_err().contains(word), "{line}");
        }
    }
}
