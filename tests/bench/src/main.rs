//! Measures the workloads natively, counts their instructions, and writes the tables of the page.
//!
//! `cargo xtask bench` calls it; `slam2d_bench --help` lists its commands.

mod clouds;
mod counts;
mod measured;
mod page;
mod registration;
mod report;

use std::io::{ErrorKind, Write as _, stdin, stdout};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use bench_support::skip::{NO_VALGRIND, tell};
use measured::Measured;
use page::{PageBlock, write_into};
use serde::Serialize;
use slam2d_bench::measure::{self, PreparedWorkloads};

const USAGE: &str = "\
slam2d_bench names                       the names of all that is measured, as JSON
slam2d_bench turns                       for each line `ID MILLISECONDS` of standard input: run that
                                         workload so long, and print its time as a line of JSON
slam2d_bench count                       instructions of one repetition of each workload as JSON;
                                         an empty object without valgrind
slam2d_bench table TURNS.json COUNTS.json PAGE.md
                                         print the table of the workloads, from what measure.mjs
                                         printed, and write it into a page
slam2d_bench clouds FOLDER               write the clouds of the registration table, for ch16 register
slam2d_bench registration SLAM2D FOLDER PAGE.md
                                         write the clouds, register them with the program SLAM2D and
                                         with nanoflann, where a C++ compiler finds it,
                                         print the table and write it into a page
slam2d_bench --counts check              fail where a workload takes 10 % more instructions than recorded
slam2d_bench --counts accept             record the instruction counts
slam2d_bench --run                       run each workload twice; callgrind counts the second time";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let done = match args[..] {
        ["names"] => say_json(&measure::names()),
        ["turns"] => turns(),
        ["count"] => count(),
        ["table", turns, counts, page] => table(Path::new(turns), Path::new(counts), page),
        ["clouds", folder] => clouds::write(Path::new(folder)).and_then(|files| {
            let mut names = files.iter().map(|file| file.display().to_string());
            names.try_for_each(|name| say(&name))
        }),
        ["registration", ch16, folder, page] => {
            registration::table(Path::new(ch16), Path::new(folder))
                .and_then(|table| publish(Path::new(page), PageBlock::Registration, &table))
        }
        ["--counts", "check"] => judge_counts(counts::compare),
        ["--counts", "accept"] => judge_counts(counts::accept),
        ["--run"] => counts::run_all_twice(),
        ["--help"] => say(USAGE),
        _ => Err(USAGE.to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

/// Prints to standard output. A closed pipe, such as that of `head`, is not an error and does not stop the
/// page from being written.
fn say(text: &str) -> Result<(), String> {
    match writeln!(stdout().lock(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("standard output: {error}"))
        }
        _ => Ok(()),
    }
}

fn say_json(value: &impl Serialize) -> Result<(), String> {
    say(&serde_json::to_string(value).map_err(|error| error.to_string())?)
}

/// Prints a block and writes it into the page.
fn publish(page: &Path, block: PageBlock, text: &str) -> Result<(), String> {
    say(text)?;
    write_into(page, block, text)
}

/// Answers each line of standard input with one turn of one workload.
fn turns() -> Result<(), String> {
    let start = Instant::now();
    let now_ms = || 1e3 * start.elapsed().as_secs_f64();
    let mut turns = PreparedWorkloads::default();
    for line in stdin().lines() {
        let line = line.map_err(|error| format!("standard input: {error}"))?;
        let words = line.split_once(' ');
        let turn = words.and_then(|(id, budget)| Some((id, budget.parse::<f64>().ok()?)));
        let (id, budget_ms) = turn.ok_or_else(|| format!("`{line}` is not `ID MILLISECONDS`"))?;
        say_json(&turns.take(id, budget_ms, &now_ms)?)?;
    }
    Ok(())
}

fn count() -> Result<(), String> {
    if !counts::is_available() {
        return say_json(&counts::Counts::new());
    }
    let counts = counts::count_all()?;
    say_json(&counts::of_one_repetition(counts))
}

fn table(turns: &Path, counts: &Path, page: &str) -> Result<(), String> {
    let measured: Measured = measured::read(turns)?;
    let counts = measured::read(counts)?;
    let table = report::table(&measured, &counts);
    publish(Path::new(page), PageBlock::Workloads, &table)?;
    if counts.is_empty() {
        say(&format!("no instructions were counted: {NO_VALGRIND}"))?;
    }
    Ok(())
}

fn judge_counts(judge: impl FnOnce(&counts::Counts) -> Result<(), String>) -> Result<(), String> {
    if !counts::is_available() {
        return tell("instruction counts", NO_VALGRIND);
    }
    let counts = counts::count_all()?;
    for (id, count) in &counts {
        say(&format!("{id:16} {count:>10} instructions"))?;
    }
    judge(&counts)
}
