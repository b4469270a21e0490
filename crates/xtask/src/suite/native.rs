//! What runs on this machine without a browser: lints, tests, counts.

use std::path::PathBuf;
use std::process::Command;

use super::skipped::SkipList;
use super::timed;
use crate::ledger::Ledger;
use crate::run::{Failure, cargo, program, root, show};
use crate::tools;

/// Compiles everything that tests need, with clippy as the compiler of the workspace's own crates,
/// and runs the tests.
///
/// Clippy is the compiler with more lints. So one pass lints and compiles, and no crate of others is
/// checked apart from being compiled. Warnings are errors in it.
///
/// # Errors
/// The step that failed.
pub fn test(skipped: &SkipList, ledger: &mut Ledger) -> Result<(), Failure> {
    timed(
        ledger,
        "native: compile and lint",
        // Benches are compiled, to be linted; only `cargo bench` runs them. `--all-targets` would
        // also link test programs for what has no tests.
        linting(&mut cargo())?
            .args(["test", "--quiet", "--no-run"])
            .args(["--tests", "--benches", "--examples"]),
    )?;
    timed(
        ledger,
        "native: test",
        skipped.told_to(linting(&mut cargo())?.args(["test", "--quiet"])),
    )
}

/// Fails where a workload takes 10 % more instructions than recorded; skips without valgrind.
///
/// # Errors
/// The workloads that got slower.
pub fn counts(skipped: &SkipList, ledger: &mut Ledger) -> Result<(), Failure> {
    ledger.time("native: tools", || Tools::BesideTests.compile())?;
    timed(
        ledger,
        "counts",
        skipped
            .told_to(program(Tools::BesideTests.path("slam2d_bench")).args(["--counts", "check"])),
    )
}

/// `cargo xtask record-counts`: what the workloads take now is what [`counts`] allows from now on.
///
/// # Errors
/// Where they do not compile, or valgrind is missing.
pub fn record_counts() -> Result<(), Failure> {
    Tools::BesideTests.compile()?;
    show(
        "Recording the instruction counts",
        program(Tools::BesideTests.path("slam2d_bench"))
            .args(["--counts", "accept"])
            .env("SLAM_NO_SKIP", "1"),
    )
}

/// The programs that are counted, timed, or compared with the module in Node.
const PROGRAMS: [&str; 3] = ["slam2d", "states", "slam2d_bench"];

/// How [`PROGRAMS`] are compiled.
#[derive(Clone, Copy, Debug)]
pub enum Tools {
    /// Profile `dev`, whose crates are those of the tests.
    BesideTests,
    /// Profile `release`: what is timed.
    AsShipped,
}

impl Tools {
    /// Compiles them.
    ///
    /// # Errors
    /// Where they do not compile.
    pub fn compile(self) -> Result<(), Failure> {
        let mut command = cargo();
        unincremental(&mut command).args(["build", "--quiet"]);
        match self {
            // Of the whole workspace, with a bench: then the crates have the features that they have for
            // the tests, and no other build of them is made.
            Self::BesideTests => linting(&mut command)?
                .args(PROGRAMS.map(|name| format!("--bin={name}")))
                .arg("--bench=timings"),
            Self::AsShipped => command
                .args(["--package=slam2d_bench", "--package=slam2d_cli"])
                .args(["--package=slam_web", "--bins", "--release"]),
        };
        show(
            "Compiling slam2d, states and slam2d_bench",
            command.arg("--target-dir").arg(root().join("target")),
        )
    }

    /// One of them.
    pub fn path(self, name: &str) -> PathBuf {
        self.folder()
            .join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    }

    /// Where they are.
    pub fn folder(self) -> PathBuf {
        root().join(match self {
            Self::BesideTests => "target/debug",
            Self::AsShipped => "target/release",
        })
    }
}

/// A package that is checked by a command of its own, beside the suite: what it needs of others takes a minute and
/// more to compile, and nothing of ours depends on it.
#[derive(Clone, Copy, Debug)]
pub enum Beside {
    /// `cargo xtask peers`: it times other people's solvers.
    Peers,
    /// `cargo xtask desktop`: it opens a widget in a window.
    Desktop,
}

impl Beside {
    fn package(self) -> &'static str {
        match self {
            Self::Peers => "solver_peers",
            Self::Desktop => "slam_desktop",
        }
    }

    /// Compiles it with lints and tests it.
    fn test(self) -> Result<Command, Failure> {
        let mut command = cargo();
        linting(&mut command)?.args(["test", "--quiet", "--package", self.package()]);
        Ok(command)
    }
}

/// Lints and tests a package beside the suite.
///
/// # Errors
/// The step that failed.
pub fn beside(what: Beside) -> Result<(), Failure> {
    let package = what.package();
    show(
        &format!("Lints of {package}"),
        what.test()?.args(["--no-run", "--all-targets"]),
    )?;
    show(&format!("Tests of {package}"), &mut what.test()?)
}

/// Makes clippy the compiler of the workspace's crates and every warning an error.
fn linting(command: &mut Command) -> Result<&mut Command, Failure> {
    let driver = tools::clippy_driver()?;
    Ok(tools::deny_warnings(unincremental(command)).env("RUSTC_WORKSPACE_WRAPPER", driver))
}

/// What is kept for the next compilation of a crate costs the first one a tenth more.
fn unincremental(command: &mut Command) -> &mut Command {
    command.env("CARGO_INCREMENTAL", "0")
}
