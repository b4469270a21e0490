//! Runs the tests of the exercises so that only what the functions did counts.

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::Context as _;

use super::forbidden::forbidden;
use super::list::{EXERCISES, source};
use super::report::Report;
use crate::run::{cargo, root};
use crate::tools::linting;

/// Whether lints are errors, as in the suite, in which crates are compiled as for the native tests.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Lints {
    /// For a student's code.
    Allowed,
    /// For ours.
    Denied,
}

/// Whose functions are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The student's, in `src`.
    Students,
    /// The forgeries of the suite, in `forged`.
    Forged,
}

impl Code {
    fn file(self, exercise: &str) -> PathBuf {
        match self {
            Self::Students => source(exercise),
            Self::Forged => root().join(format!("teaching/exercises/forged/{exercise}.rs")),
        }
    }
}

/// The test program of these functions with these arguments.
fn test_program(code: Code, lints: Lints, arguments: &[&str]) -> anyhow::Result<Command> {
    let mut tests = cargo();
    if lints == Lints::Denied {
        linting(&mut tests)?;
    }
    tests
        .args(["test", "--quiet", "--package", "exercises"])
        .args((code == Code::Forged).then_some("--features=forged"))
        .args(["--test", "exercises", "--"])
        .args(arguments)
        .env("RUST_BACKTRACE", "0")
        .stderr(Stdio::inherit());
    Ok(tests)
}

/// Runs the tests, each exercise in a process of its own: one that ends it hides no other.
/// `None` if they do not compile.
///
/// # Errors
/// If cargo cannot be started.
pub fn run_tests(code: Code, lints: Lints) -> anyhow::Result<Option<Report>> {
    const NO_CARGO: &str = "cargo cannot be started";
    let listed = test_program(code, lints, &["--list"])?
        .output()
        .context(NO_CARGO)?;
    if !listed.status.success() {
        return Ok(None);
    }
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let names = listed
        .lines()
        .filter_map(|line| line.strip_suffix(": test"));
    let names: Vec<String> = names.map(str::to_owned).collect();
    let log = root().join(format!("target/exercises-{}.log", std::process::id()));
    let log_name = log.display().to_string();
    let mut all = Report {
        tests: Vec::new(),
        messages: HashMap::new(),
    };
    for (exercise, _) in EXERCISES {
        let filter = format!("{exercise}::");
        let own = names.iter().filter(|name| name.starts_with(&filter));
        let own: Vec<String> = own.cloned().collect();
        let text = fs::read_to_string(code.file(exercise)).unwrap_or_default();
        if let Some(word) = forbidden(&text) {
            all.fail(
                &own,
                &format!(
                    "{exercise}.rs names `{word}`: no exercise needs it, so its tests do not run"
                ),
            );
            continue;
        }
        let arguments = [filter.as_str(), "--color", "never", "--logfile", &log_name];
        let output = test_program(code, lints, &arguments)?
            .output()
            .context(NO_CARGO)?;
        let written = fs::read_to_string(&log).unwrap_or_default();
        let _ = fs::remove_file(&log);
        let report = Report::read(&String::from_utf8_lossy(&output.stdout));
        let is_success = output.status.success();
        match report.and_then(|report| report.with_log(&written, &own, is_success)) {
            Some(report) => {
                all.tests.extend(report.tests);
                all.messages.extend(report.messages);
            }
            None => all.fail(
                &own,
                "the test program ended before its tests: does the code end the process, or call itself without end?",
            ),
        }
    }
    Ok(Some(all))
}
