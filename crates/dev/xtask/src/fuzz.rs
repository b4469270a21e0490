//! `cargo xtask fuzz`: runs the fuzz targets under libFuzzer, one after the other, by cargo-fuzz.
//!
//! The entry points for external input are functions in `tests/fuzz_targets`; `fuzz/` has a target for each. New inputs go
//! to `target/fuzz/corpus`, inputs that cause a panic to `fuzz/artifacts`.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, bail};

use crate::run::{cargo, root, run};
use crate::tools;

/// The targets and the time limit.
#[derive(Debug, clap::Args)]
pub struct Fuzz {
    /// Only this target of fuzz/fuzz_targets.
    #[arg(long)]
    target: Option<String>,
    /// Minutes in total, divided equally among the targets.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u64).range(1..))]
    minutes: u64,
    /// Reduce all inputs to the fewest that reach the same code, and keep those in fuzz/corpus for the tests.
    #[arg(long)]
    keep: bool,
}

/// Runs the targets.
///
/// # Errors
/// If a target cannot be built, or an input causes a panic.
pub fn fuzz(fuzz: &Fuzz) -> anyhow::Result<()> {
    tools::ensure_cargo_fuzz()?;
    let targets = match &fuzz.target {
        Some(name) => vec![name.clone()],
        None => targets()?,
    };
    let seconds = 60 * fuzz.minutes / targets.len() as u64;
    let mut failed = Vec::new();
    for target in &targets {
        let found = root().join("target/fuzz/corpus").join(target);
        fs::create_dir_all(&found)?;
        let mut fuzzer = fuzzer(target, found);
        fuzzer.args([
            "--",
            &format!("-max_total_time={seconds}"),
            // Sufficient for a few dozen lines or points.
            "-max_len=2048",
            // The slowest take a tenth of a second on a quiet machine, and the fuzzer measures wall time.
            "-timeout=300",
            "-rss_limit_mb=4096",
            "-print_final_stats=1",
        ]);
        if let Err(error) = run(&format!("Fuzzing {target}"), &mut fuzzer) {
            println!("{error}");
            failed.push(target.as_str());
        }
    }
    if !failed.is_empty() {
        bail!(
            "{}: fix the code and move the inputs from fuzz/artifacts to fuzz/found, where the tests replay them",
            failed.join(", ")
        );
    }
    if fuzz.keep {
        targets.iter().try_for_each(|target| keep(target))?;
    }
    Ok(())
}

/// Returns the names of all targets.
fn targets() -> anyhow::Result<Vec<String>> {
    let files = fs::read_dir(root().join("fuzz/fuzz_targets"))?;
    let name = |file: fs::DirEntry| Some(file.path().file_stem()?.to_str()?.to_owned());
    let mut names: Vec<String> = files.flatten().filter_map(name).collect();
    names.sort();
    Ok(names)
}

/// Replaces the inputs of the repository by the fewest that cover the same edges as all known inputs.
fn keep(target: &str) -> anyhow::Result<()> {
    let chosen = root().join("target/fuzz/kept").join(target);
    // It remains only if an earlier run was interrupted.
    _ = fs::remove_dir_all(&chosen);
    fs::create_dir_all(&chosen)?;
    let mut merge = fuzzer(target, chosen.clone());
    merge.arg(root().join("target/fuzz/corpus").join(target));
    // Counting how often an edge is taken helps the fuzzer, but would keep ten times as many inputs.
    merge.args(["--", "-set_cover_merge=1", "-use_counters=0"]);
    run(
        &format!("Keeping inputs that reach new code: {target}"),
        merge.arg("-rss_limit_mb=4096"),
    )?;
    let kept = root().join("fuzz/corpus").join(target);
    _ = fs::remove_dir_all(&kept);
    fs::rename(&chosen, &kept).with_context(|| format!("{}", kept.display()))
}

/// Returns the command of a target's fuzzer, on the inputs of the repository and a folder for new ones.
fn fuzzer(target: &str, more: PathBuf) -> Command {
    let mut command = cargo();
    command
        .args(["fuzz", "run", "--sanitizer", "none", target])
        .arg(more)
        .current_dir(root().join("fuzz"))
        .env("PATH", tools::path_with_tools())
        // Coverage counters are an unstable option, which this enables in the stable compiler.
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_TARGET_DIR", root().join("target/fuzz/build"));
    let committed = ["corpus", "found"].map(|kind| root().join("fuzz").join(kind).join(target));
    command.args(committed.into_iter().filter(|folder| folder.exists()));
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_target_has_inputs_that_are_kept() {
        let names = targets().unwrap();
        assert!(names.len() >= 12, "{names:?}");
        for name in names {
            let corpus = root().join("fuzz/corpus").join(&name);
            assert!(fs::read_dir(corpus).unwrap().next().is_some(), "{name}");
        }
    }
}
