//! What becomes of the workspace as WebAssembly: the site with its lints, the module in Node.

use super::native::Tools;
use super::skipped::SkipList;
use super::{test_files, timed};
use crate::committed::{Committed, Strictness};
use crate::ledger::Ledger;
use crate::run::{Failure, program, root};
use crate::site::{self, Lints, Speed};
use crate::tools;

/// Builds the site, linting what only WebAssembly compiles on the way, and checks what the build writes
/// into the repository, and the types.
///
/// # Errors
/// The step that failed.
pub fn site(ledger: &mut Ledger) -> Result<(), Failure> {
    let committed = Committed::read();
    ledger.time("site: build", || {
        site::build(Speed::SmallAndFast, Lints::Errors)
    })?;
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
