//! The project's commands: `cargo xtask serve`, `build`, `test` and others.
//!
//! Each command first installs what it needs through cargo, npm or apt. If that is not possible, its error message says
//! how to get it. Tools go to `target/tools`; only the wasm target and the browsers go elsewhere, through rustup and apt.

mod bench;
mod exercises;
mod fuzz;
mod python;
mod run;
mod serve;
mod site;
mod suite;
mod tools;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use site::Speed;
use suite::Piece;

#[derive(Debug, Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    arg_required_else_help = true
)]
enum Command {
    /// Build the page and serve it on this machine.
    Serve {
        /// The TCP port.
        #[arg(long, default_value_t = 8016, value_parser = clap::value_parser!(u16).range(1..))]
        port: u16,
        /// Build as published: smaller and faster, but minutes to compile.
        #[arg(long)]
        release: bool,
    },
    /// Build the finished static site into dist/.
    Build,
    /// Build the npm archive, the Python wheels, the SCORM package and the offline zip into target/packages/.
    Package,
    /// Run every check, or some pieces of the suite.
    Test {
        /// The pieces to run, in the order of the suite; all by default.
        pieces: Vec<Piece>,
        /// Only the pieces that need no site: format, licences, native, lints.
        #[arg(long, conflicts_with = "pieces")]
        quick: bool,
    },
    /// Lint and test the crate that benchmarks other solvers.
    Peers,
    /// Lint the program that opens a widget in a desktop window.
    Desktop,
    /// Repeat the browser tests while other work keeps every core busy.
    Soak {
        /// The number of rounds.
        #[arg(value_parser = clap::value_parser!(u32).range(1..))]
        rounds: u32,
        /// Continue after a failed round.
        #[arg(long)]
        go_on: bool,
        /// The test files, without `.test.mjs`.
        #[arg(long, value_delimiter = ',')]
        only: Vec<String>,
    },
    /// Record the present instruction counts of the workloads as the reference.
    RecordCounts,
    /// Run the fuzz targets of all external inputs under libFuzzer.
    Fuzz(fuzz::Fuzz),
    /// Measure times and instructions of the workloads, and write docs/performance.md.
    Bench {
        /// A file for the figures of the workloads as JSON.
        #[arg(long)]
        json: Option<PathBuf>,
    },
    /// Check format, lints and types of what changed before each commit.
    Hooks,
    /// Show how far you are with the exercises in code, and what comes next.
    Exercises(exercises::Exercises),
    /// Measure the effect of each size optimization of the module.
    Sizes,
}

fn main() -> ExitCode {
    let done = match Command::parse() {
        Command::Serve { port, release } => serve::serve(
            port,
            if release {
                Speed::SmallAndFast
            } else {
                Speed::QuickToCompile
            },
        ),
        Command::Build => site::build(Speed::SmallAndFast),
        Command::Package => site::package(),
        Command::Test { pieces, quick } => suite::test(&suite::chosen(pieces, quick)),
        Command::Peers => suite::test_peers(),
        Command::Desktop => suite::lint_desktop(),
        Command::Soak {
            rounds,
            go_on,
            only,
        } => suite::soak(rounds, go_on, &only),
        Command::RecordCounts => suite::record_counts(),
        Command::Fuzz(fuzz) => fuzz::fuzz(&fuzz),
        Command::Bench { json } => bench::bench(json.as_deref()),
        Command::Hooks => run::run(
            "Git runs .githooks/pre-commit before each commit from now on",
            run::program("git").args(["config", "core.hooksPath", ".githooks"]),
        ),
        Command::Exercises(args) => exercises::exercises(args),
        Command::Sizes => site::sizes(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nxtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Command, String> {
        let words = ["xtask"].into_iter().chain(line.split_whitespace());
        Command::try_parse_from(words).map_err(|error| error.to_string())
    }

    #[test]
    fn serve_has_the_documented_defaults() {
        let served = parse("serve").unwrap();
        let expected = Command::Serve {
            port: 8016,
            release: false,
        };
        assert_eq!(format!("{served:?}"), format!("{expected:?}"));
    }

    #[test]
    fn the_documented_lines_are_understood() {
        for line in [
            "serve --release --port 9000",
            "test node counts",
            "test --quick",
            "test python",
            "soak 20 --only drag,embed --go-on",
            "fuzz --target graphs --minutes 30",
            "fuzz --keep",
            "bench --json figures.json",
            "record-counts",
            "exercises --watch",
            "exercises --json",
            "exercises --solutions",
            "test exercises",
        ] {
            assert!(parse(line).is_ok(), "{line}");
        }
    }

    #[test]
    fn a_wrong_word_is_named() {
        for (line, word) in [
            ("sevre", "sevre"),
            ("serve --prot 1", "--prot"),
            ("serve --port 0", "0"),
            ("build now", "now"),
            ("test everything", "everything"),
            ("soak 0", "0"),
            ("fuzz --minutes 0", "0"),
        ] {
            let message = parse(line).unwrap_err();
            assert!(message.contains(&format!("'{word}'")), "{line}: {message}");
        }
    }
}
