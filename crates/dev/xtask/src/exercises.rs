//! `cargo xtask exercises`: a student's progress, and a check of our solutions.

mod forbidden;
mod forged;
mod list;
mod report;
mod test_run;

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use anyhow::{Context as _, bail, ensure};

use list::{EXERCISES, Plan, is_untouched, source};
use report::Report;
pub use test_run::Lints;
use test_run::{Code, run_tests};

use crate::run::{cargo, run};
use crate::tools::linting;

/// The arguments.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct Exercises {
    /// Run again after every save.
    #[arg(long)]
    watch: bool,
    /// One JSON object for a grader: teaching/guide/exercises.md has its fields.
    #[arg(long, conflicts_with = "watch")]
    json: bool,
    /// The order in which the next one is named.
    #[arg(long, value_enum, default_value_t = Plan::List)]
    plan: Plan,
    /// Check that the solutions pass, and that unwritten exercises and forgeries fail.
    #[arg(long, conflicts_with_all = ["watch", "json"])]
    solutions: bool,
}

/// The command.
///
/// # Errors
/// If cargo is missing, the tests do not run, or, with `--solutions`, the check fails.
pub fn exercises(args: Exercises) -> anyhow::Result<()> {
    if args.solutions {
        return check(Lints::Allowed);
    }
    loop {
        let saved = last_save();
        let report = run_tests(Code::Students, Lints::Allowed)?;
        match (&report, args.json) {
            (_, true) => println!("{}", Report::json(report.as_ref())),
            (Some(report), false) => report.print(args.plan),
            (None, false) if args.watch => println!("\nThe tests did not run: see above"),
            (None, false) => bail!("the tests did not run: see above"),
        }
        if !args.watch {
            return Ok(());
        }
        println!("\nWaiting for a save in teaching/exercises/src; Ctrl-C ends it");
        while last_save() == saved {
            sleep(Duration::from_millis(300));
        }
    }
}

/// Time of the latest change of a student's file.
fn last_save() -> Option<SystemTime> {
    let saved = |(exercise, _)| fs::metadata(source(exercise)).ok()?.modified().ok();
    EXERCISES.into_iter().filter_map(saved).max()
}

/// Packages outside of `default-members`, except the exercises. With the same packages as in the native tests every
/// crate has the same features, and is not compiled again.
const EXCLUDED_PACKAGES: [&str; 7] = [
    "solver_peers",
    "slam2d_py",
    "web_bindgen",
    "slam_desktop",
    "slam_web_module",
    "slam_robot_module",
    "slam2d_bench_module",
];

/// The command of the tests named `exercises`: those of the exercises and of `ch16 lap --exercises`.
fn all_tests(features: &str, lints: Lints) -> anyhow::Result<Command> {
    let mut tests = cargo();
    if lints == Lints::Denied {
        linting(&mut tests)?;
    }
    tests
        .args([
            "test",
            "--workspace",
            "--test",
            "exercises",
            "--no-fail-fast",
        ])
        .args(
            EXCLUDED_PACKAGES
                .iter()
                .flat_map(|package| ["--exclude", package]),
        )
        .args(["--features", features])
        .env("RUST_BACKTRACE", "0");
    Ok(tests)
}

/// Checks that the solutions pass and drive a lap, that every test of an unwritten exercise fails, and that forgeries
/// earn nothing.
///
/// # Errors
/// The first check that fails.
pub fn check(lints: Lints) -> anyhow::Result<()> {
    let solved = "exercises/solutions,ch16/exercise_solutions";
    run(
        "Solutions of the exercises",
        all_tests(solved, lints)?.arg("--quiet"),
    )?;
    println!("\n── Exercises as they are");
    let output = all_tests("ch16/exercises", lints)?
        .stderr(Stdio::piped())
        .output();
    let output = output.context("cargo cannot be started")?;
    let report = Report::read(&String::from_utf8_lossy(&output.stdout));
    let report = report.with_context(|| String::from_utf8_lossy(&output.stderr).into_owned())?;
    for (exercise, _) in EXERCISES.iter().filter(|(name, _)| is_untouched(name)) {
        let (passed, all) = report.passed(exercise);
        ensure!(all > 0, "{exercise} has no test");
        ensure!(
            passed == 0,
            "{passed} tests of {exercise} pass, but it is not written"
        );
    }
    // Tests of the command are in no module.
    let of_command = report.tests.iter().filter(|(name, _)| !name.contains("::"));
    for (name, passed) in of_command {
        ensure!(*passed, "ch16 lap --exercises: {name} fails");
    }
    let written = EXERCISES.iter().filter(|(name, _)| !is_untouched(name));
    println!(
        "── {} written, and no test of the others passes",
        written.count()
    );
    forged::check(lints)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::root;

    #[test]
    fn every_exercise_has_its_file_and_its_tests() {
        let main = fs::read_to_string(root().join("teaching/exercises/tests/main.rs")).unwrap();
        for (name, _) in EXERCISES {
            assert!(source(name).is_file(), "{name}");
            assert!(main.contains(&format!("mod {name};")), "{name}");
        }
        let files = fs::read_dir(root().join("teaching/exercises/src"))
            .unwrap()
            .count();
        assert_eq!(files, EXERCISES.len() + 1, "lib.rs and the exercises");
    }
}
