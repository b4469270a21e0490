//! How much of the sources behind a door its inputs reach, line by line.
//!
//! The replaying test is built once more with the compiler's own coverage, and runs each door over
//! the inputs of the project and those that the fuzzer has found since.

use std::fmt;
use std::path::PathBuf;

use super::{Target, folder};
use crate::run::{Failure, cargo, program, root, step};
use crate::tools;

/// Lines of some sources.
#[derive(Debug, PartialEq, Eq)]
pub struct Lines {
    covered: u64,
    all: u64,
}

impl fmt::Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = 100.0 * self.covered as f64 / self.all.max(1) as f64;
        write!(f, "{}/{} {percent:.0}%", self.covered, self.all)
    }
}

/// The lines behind each door that its inputs reach.
///
/// # Errors
/// Where the toolchain has no tools for it, or the instrumented test fails.
pub fn measure(targets: &[&Target]) -> Result<Vec<Lines>, Failure> {
    let [llvm_cov, llvm_profdata] = ["llvm-cov", "llvm-profdata"].map(tools::llvm_tool);
    let (llvm_cov, llvm_profdata) = (llvm_cov?, llvm_profdata?);
    let build = folder().join("coverage");
    step(
        "Building the doors with coverage",
        replay(&build).arg("--no-run"),
    )?;
    let test = tools::output(replay(&build).args(["--no-run", "--message-format", "json"]))
        .and_then(|messages| executable(&messages))
        .ok_or_else(|| Failure::new("cargo does not say where the test is"))?;
    let mut lines = Vec::new();
    for target in targets {
        let name = target.name;
        let raw = build.join(format!("{name}.profraw"));
        let profile = build.join(format!("{name}.profdata"));
        step(
            &format!("Coverage of {name}"),
            program(&test)
                .args(["--exact", "every_kept_input_passes_through_its_door"])
                .env("DOOR", name)
                .env("MORE_INPUTS", folder().join("corpus").join(name))
                .env("LLVM_PROFILE_FILE", &raw),
        )?;
        step(
            &format!("Coverage of {name}, merged"),
            program(&llvm_profdata)
                .args(["merge", "--sparse", "--output"])
                .args([&profile, &raw]),
        )?;
        let report = tools::output(
            program(&llvm_cov)
                .args(["export", "--format=lcov", "--instr-profile"])
                .arg(&profile)
                .arg(&test),
        );
        let report = report.ok_or_else(|| Failure::new("llvm-cov writes no report"))?;
        lines.push(count(&report, target.sources));
    }
    Ok(lines)
}

/// Cargo's test command for the test that replays.
fn replay(build: &std::path::Path) -> std::process::Command {
    let mut command = cargo();
    command
        .args([
            "test",
            "--quiet",
            "--package",
            "slam2d_doors",
            "--test",
            "replay",
        ])
        .env("RUSTFLAGS", "-Cinstrument-coverage")
        // What runs during the build is instrumented, too.
        .env("LLVM_PROFILE_FILE", build.join("build.profraw"))
        .env("CARGO_TARGET_DIR", build);
    command
}

/// The program that cargo's messages name.
fn executable(messages: &str) -> Option<PathBuf> {
    let tail = messages.split("\"executable\":\"").nth(1)?;
    Some(tail.split('"').next()?.into())
}

/// Counts the lines of a report in lcov's format that lie in the sources; tests stand last in a
/// file and count like the rest.
fn count(report: &str, sources: &[&str]) -> Lines {
    let top = format!("{}/", root().display());
    let mut lines = Lines { covered: 0, all: 0 };
    let mut counts = false;
    for record in report.lines() {
        if let Some(path) = record.strip_prefix("SF:") {
            let path = path.strip_prefix(&top).unwrap_or(path);
            counts = sources.iter().any(|source| path.starts_with(source));
        } else if let Some((_, hits)) = record
            .strip_prefix("DA:")
            .and_then(|line| line.split_once(','))
            && counts
        {
            lines.all += 1;
            lines.covered += u64::from(hits != "0");
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_of_the_named_sources_are_counted_and_no_others() {
        let top = root();
        let top = top.display();
        let report = format!(
            "SF:{top}/crates/a/src/g2o.rs\nDA:1,0\nDA:2,7\nDA:3,1\nend_of_record\n\
             SF:{top}/crates/b/src/other.rs\nDA:1,5\nend_of_record\n"
        );
        let found = count(&report, &["crates/a/src/"]);
        assert_eq!(found, Lines { covered: 2, all: 3 });
        assert_eq!(found.to_string(), "2/3 67%");
    }

    #[test]
    fn cargo_names_the_program() {
        let messages = r#"{"reason":"compiler-artifact","executable":null}
{"reason":"compiler-artifact","executable":"target/debug/deps/replay-1"}"#;
        assert_eq!(
            executable(messages),
            Some("target/debug/deps/replay-1".into())
        );
    }
}
