//! `cargo xtask test`: every check there is, cheapest first.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::bench;
use crate::chromium;
use crate::committed::{Committed, Strictness};
use crate::run::{Failure, cargo, program, root, show};
use crate::site::{self, Speed};
use crate::tools;

/// Runs every check and stops at the first that fails.
///
/// # Errors
/// The check that failed.
pub fn test() -> Result<(), Failure> {
    show("Format", cargo().args(["fmt", "--check"]))?;
    // What is missing is better known before many minutes of compiling and testing.
    tools::ensure_build_tools()?;
    let chromium = chromium::ensure_chromium()?;
    let browser = root().join("tests/browser");
    tools::ensure_node_modules(&browser)?;
    show(
        "Lints",
        cargo().args(["clippy", "--all-targets", "--quiet", "--", "-D", "warnings"]),
    )?;
    show(
        "Lints of what only WebAssembly compiles",
        cargo()
            .args(["clippy", "--quiet", "--package", "slam_web"])
            .args(["--target", tools::TARGET, "--", "-D", "warnings"]),
    )?;
    // No default member, so that nothing else would notice that it does not compile any more.
    show(
        "Lints of the peers",
        cargo()
            .args(["clippy", "--package", "solver_peers", "--all-targets"])
            .args(["--quiet", "--", "-D", "warnings"]),
    )?;
    show("Native tests", cargo().args(["test", "--quiet"]))?;
    bench::check_counts()?;
    let committed = Committed::read();
    site::build(Speed::SmallAndFast)?;
    committed.compare(Strictness::of_this_run())?;
    let web = root().join("web");
    show(
        "Types of the element",
        program(tools::npm())
            .args(["run", "--silent", "check"])
            .current_dir(web),
    )?;
    show(
        "WebAssembly tests in Node",
        program("node")
            .arg("--test")
            .args(test_files("tests/wasm")?),
    )?;
    browser_tests(&chromium)
}

/// Runs the browser tests one file after the other: they share one machine, and frame counts mean
/// nothing when others run beside them.
///
/// A file that fails runs once more. Chromium draws by software here, and on a shared machine it
/// may be held up for longer than any test should wait; a fault of ours fails both times. What
/// passed at the second attempt only is named at the end.
fn browser_tests(chromium: &Path) -> Result<(), Failure> {
    let mut second = Vec::new();
    for file in test_files("tests/browser")? {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let run = |what: String| {
            show(
                &what,
                program("node")
                    .arg("--test")
                    .arg(&file)
                    .env("CHROMIUM", chromium),
            )
        };
        if let Err(failure) = run(format!("Browser tests: {name}")) {
            println!("── {failure}");
            run(format!("Browser tests, second attempt: {name}"))?;
            second.push(name.into_owned());
        }
    }
    if !second.is_empty() {
        println!(
            "── Passed at the second attempt only: {}",
            second.join(", ")
        );
    }
    Ok(())
}

/// The test files of a folder by name: what `node --test` makes of a folder differs by version.
fn test_files(folder: &str) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: io::Error| Failure::new(format!("{folder}: {error}"));
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join(folder)).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.to_string_lossy().ends_with(".test.mjs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_test_files_are_found_and_the_helpers_left_out() {
        let files = test_files("tests/browser").unwrap();
        assert!(files.iter().any(|file| file.ends_with("manners.test.mjs")));
        assert!(!files.iter().any(|file| file.ends_with("harness.mjs")));
    }
}
