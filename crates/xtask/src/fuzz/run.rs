//! One target under libFuzzer: how often it ran, what it reached, what it found.

use std::fs;
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::process::Stdio;
use std::time::Instant;

use super::{Target, committed, folder};
use crate::run::{Failure, program, root, step};

/// Longest input that the fuzzer makes up, bytes: a few dozen lines or points.
const MAX_LEN: u32 = 2048;
/// An execution that takes longer counts as found, s: the slowest take a tenth of a second of a quiet
/// machine, but the fuzzer goes by the wall clock, and last on a busy one.
const TIMEOUT_S: u32 = 300;
/// How much less urgent than anything else on the machine this is.
const NICENESS: &str = "10";

/// What a run of a target came to.
#[derive(Debug, Default)]
pub struct TargetRun {
    /// Inputs that were run.
    pub executions: u64,
    /// Wall time, s.
    pub seconds: f64,
    /// Edges of the control flow that some input passed.
    pub edges: u64,
    /// Edges in the program.
    pub all_edges: u64,
    /// Inputs that made the door panic, by their paths.
    pub found: Vec<String>,
}

impl TargetRun {
    /// Runs a target for so many seconds, or until it finds something.
    ///
    /// # Errors
    /// Where it cannot be started.
    pub fn of(target: &Target, seconds: u64) -> Result<Self, Failure> {
        let name = target.name;
        let fresh = folder().join("corpus").join(name);
        let artifacts = root().join("fuzz/artifacts").join(name);
        for folder in [&fresh, &artifacts] {
            let failed = |error| Failure::new(format!("{}: {error}", folder.display()));
            fs::create_dir_all(folder).map_err(failed)?;
        }
        println!("Fuzzing {name} for {seconds} s …");
        let started = Instant::now();
        let mut child = fuzzer(target)
            .arg(&fresh)
            .args(committed("corpus", target))
            .args(committed("found", target))
            .arg(format!("-artifact_prefix={}/", artifacts.display()))
            .arg(format!("-max_total_time={seconds}"))
            .arg(format!("-max_len={MAX_LEN}"))
            .arg(format!("-timeout={TIMEOUT_S}"))
            .args([
                "-print_final_stats=1",
                "-rss_limit_mb=4096",
                "-use_value_profile=0",
            ])
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| Failure::new(format!("{name} cannot be started: {error}")))?;
        let log_path = folder().join(format!("{name}.log"));
        let mut log = fs::File::create(&log_path)
            .map_err(|error| Failure::new(format!("{}: {error}", log_path.display())))?;
        let mut run = Self::default();
        let lines = BufReader::new(child.stderr.take().expect("the pipe was asked for"));
        // Panic messages may quote any bytes.
        for line in lines.split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line);
            run.read_line(&line);
            // A log that cannot be written is no reason to stop.
            let _ = writeln!(log, "{line}");
        }
        let _ = child.wait();
        run.seconds = started.elapsed().as_secs_f64();
        println!(
            "  {} executions, {} edges{}",
            run.executions,
            run.edges,
            if run.found.is_empty() {
                ""
            } else {
                ", FOUND something"
            }
        );
        Ok(run)
    }

    /// Takes in one line of what libFuzzer says.
    fn read_line(&mut self, line: &str) {
        let after = |label: &str| -> Option<u64> {
            let tail = line.split(label).nth(1)?;
            let mut words = tail.trim_start().split(|c: char| !c.is_ascii_digit());
            words.next()?.parse().ok()
        };
        if let Some(edges) = after(" cov: ") {
            self.edges = edges;
        }
        if let Some(all) = after("Loaded 1 modules   (") {
            self.all_edges = all;
        }
        if let Some(executions) = after("stat::number_of_executed_units:") {
            self.executions = executions;
        }
        if let Some(path) = line.split("Test unit written to ").nth(1) {
            let top = format!("{}/", root().display());
            self.found.push(path.trim().replace(&top, ""));
        }
    }
}

/// Replaces the inputs of the project by the fewest that together pass as many edges as they and
/// all that were found since.
///
/// # Errors
/// Where a folder cannot be written, or the target cannot be started.
pub fn keep(target: &Target) -> Result<(), Failure> {
    let kept = root().join("fuzz/corpus").join(target.name);
    let chosen = folder().join("kept").join(target.name);
    let failed = |error: io::Error| Failure::new(format!("{}: {error}", chosen.display()));
    // Of an earlier run; mostly there is none.
    let _ = fs::remove_dir_all(&chosen);
    fs::create_dir_all(&chosen).map_err(failed)?;
    step(
        &format!("Keeping what reaches new code: {}", target.name),
        fuzzer(target)
            // How often an edge is passed matters to the fuzzer, but would keep ten times as much.
            .args(["-set_cover_merge=1", "-use_counters=0"])
            .arg("-rss_limit_mb=4096")
            .args([&chosen, &folder().join("corpus").join(target.name)])
            .args(committed("corpus", target)),
    )?;
    let _ = fs::remove_dir_all(&kept);
    fs::rename(&chosen, &kept).map_err(failed)
}

/// The program of a target, built with the fuzzer in it.
fn fuzzer(target: &Target) -> std::process::Command {
    let build = folder().join("build");
    // One folder is named after the platform.
    let built = fs::read_dir(&build).into_iter().flatten().flatten();
    let path = built
        .map(|entry| entry.path().join("release").join(target.name))
        .find(|path| path.is_file());
    let mut command = program("nice");
    command.args(["-n", NICENESS]);
    command.arg(path.unwrap_or_else(|| build.join(target.name)));
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_the_fuzzer_are_understood() {
        let mut run = TargetRun::default();
        for line in [
            "INFO: Loaded 1 modules   (5123 inline 8-bit counters): 5123 [0x5, 0x6), ",
            "#2\tINITED cov: 90 ft: 91 corp: 1/1b exec/s: 0 rss: 30Mb",
            "#524288\tpulse  cov: 712 ft: 2301 corp: 240/9Kb lim: 43 exec/s: 262144 rss: 40Mb",
            "Test unit written to fuzz/artifacts/g2o/crash-0a1b",
            "stat::number_of_executed_units: 1234567",
        ] {
            run.read_line(line);
        }
        assert_eq!((run.edges, run.all_edges), (712, 5123));
        assert_eq!(run.executions, 1_234_567);
        assert_eq!(run.found, ["fuzz/artifacts/g2o/crash-0a1b"]);
    }
}
