//! The project's commands: `cargo xtask serve`, `build`, `package`, `test`, `peers`, `desktop`, `soak`,
//! `fuzz`, `bench`, `sizes`.
//!
//! Everything that a step needs is checked first and installed where cargo, npm or apt can do it;
//! what cannot be installed is named in one line, with the way to get it. Tools of cargo go to
//! `target/tools`; the wasm target goes into rustup's toolchain and Chromium where apt puts it.

mod args;
mod bench;
mod chromium;
mod committed;
mod fuzz;
mod http;
mod ledger;
mod linted;
mod load;
mod package;
mod run;
mod serve;
mod site;
mod sizes;
mod suite;
mod tools;
mod unwaited;

use std::process::ExitCode;

use args::Command;
use suite::Beside;

fn main() -> ExitCode {
    if let Some(ended) = linted::before_rustc() {
        return ended;
    }
    let command = match args::parse(std::env::args().skip(1)) {
        Ok(command) => command,
        Err(message) => {
            eprintln!("{message}\n\n{}", args::USAGE);
            return ExitCode::from(2);
        }
    };
    let result = match command {
        Command::Help => {
            println!("{}", args::USAGE);
            Ok(())
        }
        Command::Build => site::build(site::Speed::SmallAndFast),
        Command::Package => package::package(),
        Command::Serve { port, speed } => serve::serve(port, speed),
        Command::Test(pieces) => suite::test(&pieces),
        Command::Peers => suite::beside(Beside::Peers),
        Command::Desktop => suite::beside(Beside::Desktop),
        Command::Soak(soak) => suite::soak(&soak),
        Command::RecordCounts => suite::record_counts(),
        Command::Fuzz(fuzz) => fuzz::fuzz(&fuzz),
        Command::Bench { json } => bench::bench(json.as_deref()),
        Command::Sizes => sizes::sizes(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("\nxtask: {failure}");
            ExitCode::FAILURE
        }
    }
}
