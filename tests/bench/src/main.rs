//! Measures the workloads natively, counts their instructions, prints the report.
//!
//! `cargo xtask bench` calls it; `slam2d_bench --help` lists what it can do.

mod counts;
mod report;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use slam2d_bench::{measure::measure, workloads};

const USAGE: &str = "\
slam2d_bench measure [SECONDS_EACH]      medians of all workloads as JSON
slam2d_bench table NATIVE.json WASM.json PAGE.md
                                         print the report and write it into a page
slam2d_bench --counts check              fail where a workload takes 10 % more instructions than recorded
slam2d_bench --counts accept             record the instruction counts
slam2d_bench --run ID TIMES              run one workload, without a clock";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let done = match args[..] {
        ["measure"] => measure_all("0.5"),
        ["measure", seconds] => measure_all(seconds),
        ["table", native, wasm, page] => report::table(Path::new(native), Path::new(wasm))
            .and_then(|table| {
                println!("{table}");
                report::write_into(Path::new(page), &table)
            }),
        ["--counts", "check"] => count(counts::compare),
        ["--counts", "accept"] => count(counts::accept),
        ["--run", id, times] => run(id, times),
        ["--help"] => {
            println!("{USAGE}");
            Ok(())
        }
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

fn measure_all(seconds: &str) -> Result<(), String> {
    let seconds: f64 = seconds.parse().map_err(|_| USAGE.to_owned())?;
    let start = Instant::now();
    let now_ms = || 1e3 * start.elapsed().as_secs_f64();
    let measured: Vec<_> = workloads()
        .iter()
        .map(|workload| measure(workload, 1e3 * seconds, &now_ms))
        .collect();
    let json = serde_json::to_string(&measured).map_err(|error| error.to_string())?;
    println!("{json}");
    Ok(())
}

fn count(
    then: impl FnOnce(&std::collections::BTreeMap<String, u64>) -> Result<(), String>,
) -> Result<(), String> {
    if !counts::is_available() {
        println!("valgrind is not installed: no instructions were counted");
        return Ok(());
    }
    let counts = counts::count_all(&|id, count| println!("{id:14} {count:>12} instructions"))?;
    then(&counts)
}

fn run(id: &str, times: &str) -> Result<(), String> {
    let times: u32 = times.parse().map_err(|_| USAGE.to_owned())?;
    let workload = workloads()
        .into_iter()
        .find(|workload| workload.id == id)
        .ok_or_else(|| format!("there is no workload `{id}`"))?;
    let mut run = (workload.prepare)();
    for _ in 0..times {
        run.once();
    }
    Ok(())
}
