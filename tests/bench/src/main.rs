//! Measures the workloads natively, counts their instructions, writes the blocks of the page.
//!
//! `cargo xtask bench` calls it; `slam2d_bench --help` lists what it can do.

mod clouds;
mod counts;
mod page;
mod peer;
mod registration;
mod report;
mod sweep;

use std::io::{ErrorKind, Write as _, stdout};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use page::{Block, write_into};
use report::Figures;
use serde::Serialize;
use slam2d_bench::{calibration, measure::measure_all, workloads};
use slam2d_tests::skip::tell;

const USAGE: &str = "\
slam2d_bench measure [SECONDS_EACH]      medians of all workloads as JSON
slam2d_bench count                       instructions of one repetition of each workload as JSON;
                                         an empty object without valgrind
slam2d_bench table NATIVE.json WASM.json COUNTS.json PAGE.md
                                         print the table of the workloads and write it into a page;
                                         fail where a row is beyond its limit on a quiet machine
slam2d_bench peer NATIVE.json PAGE.md    check and time the port in JavaScript with Node,
                                         print the table beside NATIVE.json and write it into a page
slam2d_bench clouds FOLDER               write the clouds of the registration table, for slam2d register
slam2d_bench registration SLAM2D FOLDER PAGE.md
                                         write the clouds, register them with the program SLAM2D and
                                         with nanoflann, where a C++ compiler finds it,
                                         print the table and write it into a page
slam2d_bench sweep SLAM2D PAGE.md        run the sweep of 4,000 laps with the program SLAM2D,
                                         print its distribution and write it into a page
slam2d_bench --counts check              fail where a workload takes 10 % more instructions than recorded
slam2d_bench --counts accept             record the instruction counts
slam2d_bench --run ID TIMES              run one workload, without a clock";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let done = match args[..] {
        ["measure"] => measure_all("0.5"),
        ["measure", seconds] => measure_all(seconds),
        ["count"] => count(),
        ["table", native, wasm, counts, page] => {
            table([native, wasm, counts].map(Path::new), Path::new(page))
        }
        ["peer", native, page] => peer::table(Path::new(native))
            .and_then(|table| publish(Path::new(page), Block::Peer, &table)),
        ["clouds", folder] => clouds::write(Path::new(folder)).and_then(|files| {
            let mut names = files.iter().map(|file| file.display().to_string());
            names.try_for_each(|name| say(&name))
        }),
        ["registration", slam2d, folder, page] => {
            registration::table(Path::new(slam2d), Path::new(folder))
                .and_then(|table| publish(Path::new(page), Block::Registration, &table))
        }
        ["sweep", slam2d, page] => sweep::block(Path::new(slam2d))
            .and_then(|block| publish(Path::new(page), Block::Sweep, &block)),
        ["--counts", "check"] => judge_counts(counts::compare),
        ["--counts", "accept"] => judge_counts(counts::accept),
        ["--run", id, times] => run(id, times),
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

/// Prints to standard output. A reader that has seen enough, as `head` has, is no reason to fail
/// or to leave a page unwritten.
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

/// Prints a block and writes it into its place.
fn publish(page: &Path, block: Block, text: &str) -> Result<(), String> {
    say(text)?;
    write_into(page, block, text)
}

fn measure_all(seconds: &str) -> Result<(), String> {
    let seconds: f64 = seconds.parse().map_err(|_| USAGE.to_owned())?;
    let start = Instant::now();
    let now_ms = || 1e3 * start.elapsed().as_secs_f64();
    say_json(&measure_all(1e3 * seconds, &now_ms))
}

fn count() -> Result<(), String> {
    if !counts::is_available() {
        return say_json(&counts::Counts::new());
    }
    let counts = counts::count_all(&|id, count| {
        eprintln!("{id}: {count} instructions");
        Ok(())
    })?;
    say_json(&counts::of_one_repetition(counts))
}

fn table([native, wasm, counts]: [&Path; 3], page: &Path) -> Result<(), String> {
    let figures = Figures::read(native, wasm, counts)?;
    publish(page, Block::Workloads, &figures.table())?;
    if !figures.are_counted() {
        say("valgrind is not installed: no instructions were counted")?;
    }
    figures.judge()
}

fn judge_counts(judge: impl FnOnce(&counts::Counts) -> Result<(), String>) -> Result<(), String> {
    if !counts::is_available() {
        return tell("instruction counts", "valgrind is not installed");
    }
    let counts = counts::count_all(&|id, count| say(&format!("{id:14} {count:>12} instructions")))?;
    judge(&counts)
}

fn run(id: &str, times: &str) -> Result<(), String> {
    let times: u32 = times.parse().map_err(|_| USAGE.to_owned())?;
    let workload = workloads()
        .into_iter()
        .chain([calibration::workload()])
        .find(|workload| workload.id == id)
        .ok_or_else(|| format!("there is no workload `{id}`"))?;
    let mut run = (workload.prepare)();
    for _ in 0..times {
        run.once();
    }
    Ok(())
}
