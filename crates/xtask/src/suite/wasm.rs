//! What becomes of the workspace as WebAssembly: its lints, the site, the module in Node.

use super::native::Tools;
use super::skipped::SkipList;
use super::{test_files, timed};
use crate::committed::{Committed, Strictness};
use crate::ledger::Ledger;
use crate::run::{Failure, cargo, program, root};
use crate::site::{self, Speed};
use crate::tools;

/// Lints of what only WebAssembly compiles.
///
/// # Errors
/// Where clippy has something to say.
pub fn lints(ledger: &mut Ledger) -> Result<(), Failure> {
    timed(
        ledger,
        "wasm: lint",
        cargo()
            .args(["clippy", "--quiet"])
            .args(["--package", "slam_web", "--package", "slam_robot"])
            .args(["--target", tools::TARGET, "--", "-D", "warnings"])
            .env("CARGO_INCREMENTAL", "0"),
    )
}

/// Builds the site and checks what the build writes into the repository, and the types.
///
/// # Errors
/// The step that failed.
pub fn site(ledger: &mut Ledger) -> Result<(), Failure> {
    let committed = Committed::read();
    ledger.time("site: build", || site::build(Speed::SmallAndFast))?;
    committed.compare(Strictness::of_this_run())?;
    timed(
        ledger,
        "site: types",
        program(tools::npm())
            .args(["run", "--silent", "check"])
            .current_dir(root().join("web")),
    )
}

/// The module in Node, beside the native programs.
///
/// # Errors
/// The test that failed.
pub fn node(skipped: &SkipList, ledger: &mut Ledger) -> Result<(), Failure> {
    ledger.time("native: tools", || Tools::BesideTests.compile())?;
    timed(
        ledger,
        "node tests",
        skipped.told_to(
            program("node")
                .arg("--test")
                .args(test_files("tests/wasm")?)
                .env("SLAM_NATIVE", Tools::BesideTests.folder()),
        ),
    )
}
