//! Instruction counts: they repeat where clocks do not, so that a slower core fails the build.
//!
//! A workload runs twice in one process under callgrind (Nethercote & Seward 2007), which collects
//! during the second run only: without preparation, start and end of the process, and with the
//! workspaces that the first run has grown. Until then it translates the process without counters,
//! which takes a third of the time.

use std::collections::BTreeMap;
use std::env::{self, consts::ARCH};
use std::fs;
use std::hint::{self, black_box};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{self, Command, Stdio};

use measuring::skip::tell;
use slam2d_bench::measure::find;
use slam2d_bench::{Run, workloads};

/// A count may rise by this share over the recorded one.
const ALLOWED_RISE: f64 = 0.10;

/// Instructions of one run of each workload, by its name.
pub type Counts = BTreeMap<String, u64>;

/// Where the accepted counts stand: every architecture needs instructions of its own.
fn record(architecture: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("instructions-{architecture}.json"))
}

/// Whether callgrind can be run here.
pub fn is_available() -> bool {
    let version = Command::new("valgrind").arg("--version").output();
    version.is_ok_and(|output| output.status.success())
}

/// Counts every workload; `said` is told each count as it comes.
///
/// # Errors
/// One sentence where valgrind fails, where its counts do not repeat, or where `said` fails.
pub fn count_all(said: &dyn Fn(&str, u64) -> Result<(), String>) -> Result<Counts, String> {
    let mut counts = Counts::new();
    for workload in workloads() {
        let count = count(workload.id)?;
        said(workload.id, count)?;
        counts.insert(workload.id.to_owned(), count);
    }
    Ok(counts)
}

/// Runs a workload twice; callgrind knows the second time by the name of [`counted_run`].
///
/// # Errors
/// Where there is no such workload, or no callgrind around this process.
pub fn run_twice(id: &str) -> Result<(), String> {
    let mut run = (find(id)?.prepare)();
    run.once();
    start_counting()?;
    counted_run(run.as_mut());
    Ok(())
}

/// Has the callgrind around this process count from here on, by valgrind's own remote control.
fn start_counting() -> Result<(), String> {
    let failed = |error: std::io::Error| format!("vgdb, a part of valgrind: {error}");
    let mut request = Command::new("vgdb")
        .arg(format!("--pid={}", process::id()))
        // It may not stop this process from outside: some containers forbid that.
        .arg("--max-invoke-ms=0")
        .args(["instrumentation", "on"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(failed)?;
    // Callgrind listens while this process computes, and not while it waits.
    loop {
        match request.try_wait().map_err(failed)? {
            None => hint::spin_loop(),
            Some(status) if status.success() => return Ok(()),
            Some(_) => return Err("a workload is counted under callgrind only".to_owned()),
        }
    }
}

#[inline(never)]
fn counted_run(run: &mut dyn Run) {
    run.once();
    // So that this function lasts as long as the run: no jump into it as the last act.
    black_box(());
}

/// The counts divided as the medians are: by the repetitions of a run.
pub fn of_one_repetition(mut counts: Counts) -> Counts {
    for workload in workloads() {
        if let Some(count) = counts.get_mut(workload.id) {
            *count /= u64::from(workload.repetitions);
        }
    }
    counts
}

/// Writes the counts down as the accepted ones.
pub fn accept(counts: &Counts) -> Result<(), String> {
    let json = serde_json::to_string_pretty(counts).map_err(|error| error.to_string())?;
    let record = record(ARCH);
    fs::write(&record, json + "\n").map_err(|error| format!("{}: {error}", record.display()))
}

/// Compares counts with the accepted ones and names every workload that got slower.
pub fn compare(counts: &Counts) -> Result<(), String> {
    let Some(accepted) = accepted(ARCH)? else {
        return tell(
            "instruction counts",
            &format!("none are recorded for {ARCH}; `cargo xtask record-counts` records them"),
        );
    };
    let complaints = complaints(counts, &accepted);
    if complaints.is_empty() {
        Ok(())
    } else {
        Err(complaints.join("\n"))
    }
}

/// The accepted counts of an architecture, where it has any.
fn accepted(architecture: &str) -> Result<Option<Counts>, String> {
    let record = record(architecture);
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", record.display());
    match fs::read_to_string(&record) {
        Ok(text) => serde_json::from_str(&text).map_err(|error| failed(&error)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(failed(&error)),
    }
}

fn complaints(counts: &Counts, accepted: &Counts) -> Vec<String> {
    let judge = |(id, count): (&String, &u64)| match accepted.get(id) {
        None => Some(format!(
            "{id}: no instruction count is recorded; `cargo xtask record-counts` records it"
        )),
        Some(accepted) => {
            let rise = *count as f64 / *accepted as f64 - 1.0;
            (rise > ALLOWED_RISE).then(|| {
                format!(
                    "{id}: {count} instructions, {:.0} % more than the recorded {accepted}",
                    100.0 * rise
                )
            })
        }
    };
    counts.iter().filter_map(judge).collect()
}

/// Instructions of one run of a workload.
fn count(id: &str) -> Result<u64, String> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--instr-atstart=no")
        .arg("--toggle-collect=*counted_run*")
        .arg(program)
        .args(["--run", id])
        .output()
        .map_err(|error| format!("valgrind: {error}"))?;
    let report = String::from_utf8_lossy(&output.stderr);
    collected(&report).ok_or_else(|| format!("valgrind counted nothing for {id}:\n{report}"))
}

/// What callgrind says that it collected.
fn collected(report: &str) -> Option<u64> {
    let (_, count) = report
        .lines()
        .find_map(|line| line.split_once("Collected : "))?;
    count.trim().parse().ok().filter(|&count| count > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_recorded_for_the_architecture_of_the_build_machines_and_not_for_every_one() {
        let recorded = accepted("x86_64").unwrap().expect("in the repository");
        assert!(recorded.contains_key("lap"));
        assert_eq!(accepted("pdp11"), Ok(None));
    }

    #[test]
    fn a_rise_of_more_than_a_tenth_is_named_and_a_fall_is_not() {
        let counts = |pairs: &[(&str, u64)]| -> Counts {
            let pairs = pairs.iter().map(|(id, count)| ((*id).to_owned(), *count));
            pairs.collect()
        };
        let accepted = counts(&[("lap", 1000), ("grid", 1000), ("solve", 1000)]);
        let now = counts(&[("lap", 1101), ("grid", 1099), ("solve", 500), ("new", 1)]);
        let complaints = complaints(&now, &accepted);
        assert_eq!(complaints.len(), 2, "{complaints:?}");
        assert!(complaints[0].starts_with("lap: 1101 instructions, 10 % more"));
        assert!(complaints[1].starts_with("new: no instruction count"));
    }

    #[test]
    fn a_run_of_no_instructions_is_one_that_was_not_found() {
        let report = |count: &str| format!("==7== Events    : Ir\n==7== Collected : {count}\n");
        assert_eq!(collected(&report("113000000")), Some(113_000_000));
        assert_eq!(collected(&report("0")), None);
        assert_eq!(collected("==7== nothing"), None);
    }

    #[test]
    fn a_count_is_divided_as_its_median_is() {
        let counts = Counts::from([("nearest".to_owned(), 783_239), ("lap".to_owned(), 5)]);
        let divided = of_one_repetition(counts);
        assert_eq!((divided["nearest"], divided["lap"]), (783, 5));
    }
}
