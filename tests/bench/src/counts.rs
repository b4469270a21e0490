//! Instruction counts: they are reproducible where timings are not, so a slower core fails the build.
//!
//! All workloads run in one process under callgrind (Nethercote & Seward 2007), each of them twice. Callgrind
//! collects during the second run only: without preparation, start and end of the process, and with the
//! workspaces that the first run has grown. It writes its counts after each run. In between it translates the
//! process without counters, which takes a third of the time.

use std::collections::BTreeMap;
use std::env::{self, consts::ARCH};
use std::fs;
use std::hint::{self, black_box};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{self, Command, Stdio};

use bench_support::skip::tell;
use slam2d_bench::{Run, workloads};

/// Allowed relative increase over the recorded count.
const ALLOWED_RISE: f64 = 0.10;

/// Instructions of one run of each workload, by its name.
pub type Counts = BTreeMap<String, u64>;

/// File of the accepted counts: each architecture has its own.
fn record(architecture: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("instructions-{architecture}.json"))
}

/// Whether callgrind is available.
pub fn is_available() -> bool {
    let version = Command::new("valgrind").arg("--version").output();
    version.is_ok_and(|output| output.status.success())
}

/// Counts every workload.
///
/// # Errors
/// One sentence if valgrind fails.
pub fn count_all() -> Result<Counts, String> {
    let file = env::temp_dir().join(format!("slam2d-counts-{}", process::id()));
    let counted = count_into(&file);
    let written = fs::read_to_string(&file);
    // It exists only if callgrind got this far; a failure is reported below.
    drop(fs::remove_file(&file));
    counted?;
    let counts = collected(&written.map_err(|error| format!("{}: {error}", file.display()))?);
    let mut ids = workloads().into_iter().map(|workload| workload.id);
    match ids.find(|id| !counts.contains_key(*id)) {
        Some(id) => Err(format!("callgrind counted nothing for {id}")),
        None => Ok(counts),
    }
}

/// Runs every workload twice; callgrind recognizes the second run by the name of [`counted_run`].
///
/// # Errors
/// If this process does not run under callgrind.
pub fn run_all_twice() -> Result<(), String> {
    for workload in workloads() {
        let mut run = (workload.prepare)();
        run.once();
        ask_callgrind(&["instrumentation", "on"])?;
        counted_run(run.as_mut());
        ask_callgrind(&["dump", workload.id])?;
        ask_callgrind(&["instrumentation", "off"])?;
    }
    Ok(())
}

/// Sends a command to the callgrind around this process, by valgrind's remote control.
fn ask_callgrind(what: &[&str]) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("vgdb, a part of valgrind: {error}");
    let mut request = Command::new("vgdb")
        .arg(format!("--pid={}", process::id()))
        // It must not stop this process from outside, because some containers forbid that.
        .arg("--max-invoke-ms=0")
        .args(what)
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
    // Makes this function last as long as the run, by preventing a tail call.
    black_box(());
}

/// Divides the counts by the repetitions of a run, like the medians.
pub fn of_one_repetition(mut counts: Counts) -> Counts {
    for workload in workloads() {
        if let Some(count) = counts.get_mut(workload.id) {
            *count /= u64::from(workload.repetitions);
        }
    }
    counts
}

/// Records the counts as the accepted ones.
pub fn accept(counts: &Counts) -> Result<(), String> {
    let json = serde_json::to_string_pretty(counts).map_err(|error| error.to_string())?;
    let record = record(ARCH);
    fs::write(&record, json + "\n").map_err(|error| format!("{}: {error}", record.display()))
}

/// Compares counts with the accepted ones and lists every workload that got slower.
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

/// The accepted counts of an architecture, if it has any.
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
                    "{id}: {count} instructions, {:.0} % more than the recorded {accepted}; `cargo xtask record-counts` accepts them",
                    100.0 * rise
                )
            })
        }
    };
    counts.iter().filter_map(judge).collect()
}

/// Makes callgrind write the counts of all runs into one file, one part after the other.
fn count_into(file: &Path) -> Result<(), String> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--instr-atstart=no"])
        .args(["--toggle-collect=*counted_run*", "--combine-dumps=yes"])
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(program)
        .arg("--run")
        .output()
        .map_err(|error| format!("valgrind: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let stderr = String::from_utf8_lossy(&output.stderr);
    Err(format!("valgrind counted nothing:\n{stderr}"))
}

/// Parses callgrind's counts, by the requested dump: each part of the file begins with a trigger and ends
/// with a total.
fn collected(file: &str) -> Counts {
    let mut counts = Counts::new();
    let mut id = None;
    for line in file.lines() {
        if let Some(trigger) = line.strip_prefix("desc: Trigger: ") {
            id = trigger.strip_prefix("dump ");
        } else if let Some(total) = line.strip_prefix("totals: ")
            && let (Some(id), Ok(count @ 1..)) = (id, total.trim().parse::<u64>())
        {
            counts.insert(id.to_owned(), count);
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_recorded_only_for_the_architecture_of_the_build_machines() {
        let recorded = accepted("x86_64").unwrap().expect("in the repository");
        assert!(recorded.contains_key("lap"));
        assert_eq!(accepted("pdp11"), Ok(None));
    }

    #[test]
    fn a_rise_of_more_than_a_tenth_is_reported_and_a_fall_is_not() {
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
    fn each_dump_is_a_count_and_the_rest_is_ignored() {
        let part = |trigger: &str, count: &str| {
            format!(
                "part: 1\ndesc: Trigger: {trigger}\nevents: Ir\nfn=(7)\n+3 12\ntotals: {count}\n"
            )
        };
        let file = part("dump lap", "113000000") + &part("dump solve", "4711");
        let counts =
            collected(&(file + &part("dump grid", "0") + &part("Program termination", "5")));
        let expected = [("lap", 113_000_000), ("solve", 4711)];
        assert_eq!(
            counts,
            expected.map(|(id, count)| (id.to_owned(), count)).into()
        );
        assert!(collected("events: Ir\n").is_empty());
    }

    #[test]
    fn a_count_is_divided_as_its_median_is() {
        let counts = Counts::from([("nearest".to_owned(), 783_239), ("lap".to_owned(), 5)]);
        let divided = of_one_repetition(counts);
        assert_eq!((divided["nearest"], divided["lap"]), (783, 5));
    }
}
