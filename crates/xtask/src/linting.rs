//! Clippy beside the compiler: this program as cargo's `RUSTC_WORKSPACE_WRAPPER`.
//!
//! Clippy instead of the compiler compiles, too, but optimizes less; what is published must come from
//! the compiler. Clippy as a build of its own would check the crates of others once more. So for each
//! crate of the workspace this runs clippy up to its lints, and then the compiler.

use std::env;
use std::ffi::{OsStr, OsString};
use std::process::{Command, ExitCode};

use crate::run::{Failure, root};
use crate::tools;

/// Names clippy's driver, and so tells this program that cargo started it as the compiler.
const DRIVER: &str = "SLAM_CLIPPY_DRIVER";

/// What `cargo clippy -- -D warnings` says to its driver, and how.
pub const DENY_WARNINGS: (&str, &str) = (
    "CLIPPY_ARGS",
    "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__",
);

/// Makes a build lint the workspace's crates on its way; a warning ends it.
///
/// # Errors
/// One line where clippy is missing, or this program has no path.
pub fn lint_on_the_way(command: &mut Command) -> Result<(), Failure> {
    let this = env::current_exe().map_err(|error| Failure::new(format!("xtask: {error}")))?;
    let (name, value) = DENY_WARNINGS;
    command
        .env("RUSTC_WORKSPACE_WRAPPER", this)
        .env(DRIVER, tools::clippy_driver()?)
        .env(name, value);
    Ok(())
}

/// Compiles one crate where cargo started this program to do so.
pub fn compile() -> Option<ExitCode> {
    let driver = env::var_os(DRIVER)?;
    let mut words = env::args_os().skip(1);
    let compiler = words.next()?;
    let words: Vec<OsString> = words.collect();
    let linted = lint(&driver, &compiler, &words);
    Some(
        linted
            .and_then(|()| run(&compiler, &words))
            .err()
            .unwrap_or(ExitCode::SUCCESS),
    )
}

fn lint(driver: &OsStr, compiler: &OsStr, words: &[OsString]) -> Result<(), ExitCode> {
    let out = root().join("target/xtask/lints");
    match lint_words(words, out.as_os_str()) {
        Some(words) => {
            let compiler = [compiler.to_owned()];
            run(driver, compiler.iter().chain(&words))
        }
        None => Ok(()),
    }
}

/// The words that make the compiler stop at the lints; nothing where cargo only asks it something.
fn lint_words(words: &[OsString], out: &OsStr) -> Option<Vec<OsString>> {
    let mut lints = Vec::new();
    let mut compiles = false;
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let text = word.to_string_lossy();
        if text.starts_with("--emit=") {
            compiles = true;
            lints.push("--emit=metadata".into());
        } else if let Some(kinds) = text.strip_prefix("--json=") {
            // Cargo takes what is announced for the crate itself.
            let kinds: Vec<_> = kinds
                .split(',')
                .filter(|kind| *kind != "artifacts")
                .collect();
            lints.push(format!("--json={}", kinds.join(",")).into());
        } else if text == "--out-dir" {
            words.next();
            lints.extend([word.clone(), out.to_owned()]);
        } else {
            lints.push(word.clone());
        }
    }
    compiles.then_some(lints)
}

fn run(
    program: &OsStr,
    words: impl IntoIterator<Item = impl AsRef<OsStr>>,
) -> Result<(), ExitCode> {
    match Command::new(program).args(words).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            Err(ExitCode::from(code.unwrap_or(1)))
        }
        Err(error) => {
            eprintln!("{}: {error}", program.to_string_lossy());
            Err(ExitCode::FAILURE)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn the_lints_see_the_crate_as_the_compiler_does_and_leave_nothing_that_cargo_takes() {
        let asked = words(
            "--crate-name web --edition=2024 lib.rs --json=diagnostic-rendered-ansi,artifacts,future-incompat \
             --crate-type cdylib --emit=dep-info,link -C opt-level=z --out-dir deps --extern kit=kit.rlib",
        );
        let expected = words(
            "--crate-name web --edition=2024 lib.rs --json=diagnostic-rendered-ansi,future-incompat \
             --crate-type cdylib --emit=metadata -C opt-level=z --out-dir elsewhere --extern kit=kit.rlib",
        );
        assert_eq!(lint_words(&asked, OsStr::new("elsewhere")), Some(expected));
    }

    #[test]
    fn a_question_of_cargo_to_the_compiler_is_not_linted() {
        let asked = words("- --crate-name ___ --print=file-names --crate-type bin --print=cfg");
        assert_eq!(lint_words(&asked, OsStr::new("elsewhere")), None);
    }
}
