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
        // Benches are compiled, to be linted; only `cargo bench` runs them.
        linting(&mut cargo())?.args(["test", "--quiet", "--no-run", "--all-targets"]),
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
    ledger.time("native: tools", compile_tools)?;
    timed(
        ledger,
        "counts",
        skipped.told_to(program(tool("slam2d_bench")).args(["--counts", "check"])),
    )
}

/// `cargo xtask record-counts`: what the workloads take now is what [`counts`] allows from now on.
///
/// # Errors
/// Where they do not compile, or valgrind is missing.
pub fn record_counts() -> Result<(), Failure> {
    compile_tools()?;
    show(
        "Recording the instruction counts",
        program(tool("slam2d_bench"))
            .args(["--counts", "accept"])
            .env("SLAM_NO_SKIP", "1"),
    )
}

/// Compiles the programs that are counted, or compared with the module in Node.
///
/// # Errors
/// Where they do not compile.
pub fn compile_tools() -> Result<(), Failure> {
    show(
        "Compiling slam2d, states and slam2d_bench",
        unincremental(&mut cargo())
            .args(["build", "--quiet"])
            .args(["--package=slam2d_bench", "--package=slam2d_cli"])
            .args(["--package=slam_web", "--bins"])
            // With a bench cargo counts in what only tests need, so that the crates of others have the
            // features, and the one build, that the tests have.
            .arg("--bench=workloads")
            .arg("--target-dir")
            .arg(root().join("target")),
    )
}

/// A program of [`compile_tools`].
pub fn tool(name: &str) -> PathBuf {
    folder_of_tools().join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// Where [`compile_tools`] leaves the programs.
pub fn folder_of_tools() -> PathBuf {
    root().join("target/debug")
}

/// `cargo xtask peers`: lints and tests of the crate that times other people's solvers.
///
/// # Errors
/// The step that failed.
pub fn peers() -> Result<(), Failure> {
    show(
        "Lints of the peers",
        linting(&mut cargo())?
            .args(["test", "--quiet", "--no-run"])
            .args(["--package=solver_peers", "--all-targets"]),
    )?;
    show(
        "Tests of the peers",
        linting(&mut cargo())?.args(["test", "--quiet", "--package=solver_peers"]),
    )
}

/// Makes clippy the compiler of the workspace's crates and every warning an error.
fn linting(command: &mut Command) -> Result<&mut Command, Failure> {
    let driver = tools::clippy_driver()?;
    Ok(unincremental(command)
        .env("RUSTC_WORKSPACE_WRAPPER", driver)
        // As `cargo clippy -- -D warnings` says it to its driver.
        .env(
            "CLIPPY_ARGS",
            ["-D", "warnings", ""].join("__CLIPPY_HACKERY__"),
        ))
}

/// What is kept for the next compilation of a crate costs the first one a tenth more.
fn unincremental(command: &mut Command) -> &mut Command {
    command.env("CARGO_INCREMENTAL", "0")
}
