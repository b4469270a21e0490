//! The command line, read by hand: a parser crate would double the time of the first build.

use std::path::PathBuf;

use crate::fuzz::{self, Fuzz};
use crate::site::Speed;
use crate::suite::{AfterFailure, Piece, Soak};

/// What `cargo xtask` alone prints.
pub const USAGE: &str = "\
cargo xtask serve [--port 8016] [--release]   build the page and serve it
cargo xtask build                             build the finished static site into dist/
cargo xtask package                           build what people install into target/packages/: npm and Python
cargo xtask test                              every check: format, lints, native, wasm, browser
cargo xtask test --quick                      format, licences, lints and native tests
cargo xtask test PIECE...                     of: format native lints counts site node browser
cargo xtask peers                             lints and tests of what times other people's solvers
cargo xtask desktop                           lints and tests of what opens widgets in a desktop's window
cargo xtask soak N [--go-on] [--only a,b]     the browser tests N times on a busy machine
cargo xtask record-counts                     accept the instruction counts of the workloads
cargo xtask fuzz [--minutes N] [--target T] [--keep]
                                              every door from outside, under libFuzzer
cargo xtask bench [--json FILE]               time and count the workloads, write docs/performance.md
cargo xtask sizes                             what keeps the module small, each step left out once";

/// One of the commands, with its options.
#[derive(Debug, PartialEq)]
pub enum Command {
    /// Print the usage.
    Help,
    /// Build `dist/`.
    Build,
    /// Build the site and the archives that people install.
    Package,
    /// Build and serve.
    Serve {
        /// TCP port on the local machine.
        port: u16,
        /// How long the compiler may take.
        speed: Speed,
    },
    /// Run these checks, in the order of the suite.
    Test(Vec<Piece>),
    /// Check what times other people's solvers.
    Peers,
    /// Check what opens a widget in a window.
    Desktop,
    /// Repeat the browser tests.
    Soak(Soak),
    /// Accept the instruction counts as they are.
    RecordCounts,
    /// Look for inputs that break a promise.
    Fuzz(Fuzz),
    /// Time the workloads.
    Bench {
        /// Where the measurements go besides the table.
        json: Option<PathBuf>,
    },
    /// Weigh builds of the module.
    Sizes,
}

/// Reads the words after `cargo xtask`.
///
/// # Errors
/// One line that names the word that does not fit.
pub fn parse(words: impl Iterator<Item = String>) -> Result<Command, String> {
    let mut words = words.peekable();
    let Some(name) = words.next() else {
        return Ok(Command::Help);
    };
    let command = match name.as_str() {
        "help" | "--help" | "-h" => Command::Help,
        "build" => Command::Build,
        "package" => Command::Package,
        "test" => Command::Test(parse_pieces(&mut words)?),
        "peers" => Command::Peers,
        "desktop" => Command::Desktop,
        "soak" => Command::Soak(parse_soak(&mut words)?),
        "record-counts" => Command::RecordCounts,
        "sizes" => Command::Sizes,
        "fuzz" => Command::Fuzz(fuzz::parse(&mut words)?),
        "bench" => Command::Bench {
            json: match words.next_if_eq("--json") {
                Some(_) => Some(words.next().ok_or("--json takes a file name")?.into()),
                None => None,
            },
        },
        "serve" => {
            let (mut port, mut speed) = (8016, Speed::QuickToCompile);
            while let Some(word) = words.next() {
                match word.as_str() {
                    "--release" => speed = Speed::SmallAndFast,
                    "--port" => port = parse_port(words.next())?,
                    _ => return Err(format!("serve does not take `{word}`")),
                }
            }
            Command::Serve { port, speed }
        }
        _ => return Err(format!("there is no command `{name}`")),
    };
    match words.next() {
        Some(word) => Err(format!("{name} does not take `{word}`")),
        None => Ok(command),
    }
}

/// Nothing means everything.
fn parse_pieces(words: &mut impl Iterator<Item = String>) -> Result<Vec<Piece>, String> {
    let mut pieces = Vec::new();
    for word in words {
        match Piece::named(&word) {
            Some(piece) => pieces.push(piece),
            None if word == "--quick" => pieces.extend(Piece::QUICK),
            None => return Err(format!("test does not take `{word}`")),
        }
    }
    if pieces.is_empty() {
        pieces.extend(Piece::ALL);
    }
    Ok(pieces)
}

fn parse_soak(words: &mut impl Iterator<Item = String>) -> Result<Soak, String> {
    const ROUNDS: &str = "soak takes the number of rounds, such as 20";
    let word = words.next().ok_or(ROUNDS)?;
    let mut soak = Soak {
        rounds: match word.parse() {
            Ok(rounds) if rounds > 0 => rounds,
            _ => return Err(format!("{ROUNDS}, not `{word}`")),
        },
        only: Vec::new(),
        after_failure: AfterFailure::Stop,
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--go-on" => soak.after_failure = AfterFailure::GoOn,
            "--only" => {
                let names = words
                    .next()
                    .ok_or("--only takes names, such as drag,embed")?;
                soak.only = names.split(',').map(str::to_owned).collect();
            }
            _ => return Err(format!("soak does not take `{word}`")),
        }
    }
    Ok(soak)
}

fn parse_port(word: Option<String>) -> Result<u16, String> {
    let word = word.ok_or("--port takes a number from 1 to 65535")?;
    match word.parse() {
        Ok(port) if port > 0 => Ok(port),
        _ => Err(format!(
            "--port takes a number from 1 to 65535, not `{word}`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_line(line: &str) -> Result<Command, String> {
        parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn serve_has_the_documented_defaults() {
        let expected = Command::Serve {
            port: 8016,
            speed: Speed::QuickToCompile,
        };
        assert_eq!(parse_line("serve"), Ok(expected));
    }

    #[test]
    fn options_are_taken_in_any_order() {
        let expected = Command::Serve {
            port: 9000,
            speed: Speed::SmallAndFast,
        };
        assert_eq!(parse_line("serve --release --port 9000"), Ok(expected));
    }

    #[test]
    fn the_suite_runs_whole_or_in_named_pieces() {
        let pieces = |line| match parse_line(line) {
            Ok(Command::Test(pieces)) => pieces,
            other => panic!("{line}: {other:?}"),
        };
        assert_eq!(pieces("test"), Piece::ALL);
        assert_eq!(pieces("test --quick"), Piece::QUICK);
        assert_eq!(pieces("test node counts"), [Piece::Node, Piece::Counts]);
        for piece in Piece::ALL {
            assert!(USAGE.contains(piece.name()));
        }
    }

    #[test]
    fn a_soak_stops_at_the_first_failure_unless_told_to_go_on() {
        let soak = |line| match parse_line(line) {
            Ok(Command::Soak(soak)) => soak,
            other => panic!("{line}: {other:?}"),
        };
        let plain = soak("soak 20");
        assert_eq!(
            (plain.rounds, plain.after_failure),
            (20, AfterFailure::Stop)
        );
        assert!(plain.only.is_empty());
        let named = soak("soak 3 --only drag,embed --go-on");
        assert_eq!(named.only, ["drag", "embed"]);
        assert_eq!(named.after_failure, AfterFailure::GoOn);
    }

    #[test]
    fn a_wrong_word_is_named() {
        for (line, word) in [
            ("sevre", "`sevre`"),
            ("serve --prot 1", "`--prot`"),
            ("serve --port x", "`x`"),
            ("serve --port 0", "`0`"),
            ("build now", "`now`"),
            ("test everything", "`everything`"),
            ("soak forever", "`forever`"),
            ("soak 0", "`0`"),
            ("soak 2 --fiels a", "`--fiels`"),
        ] {
            let message = parse_line(line).unwrap_err();
            assert!(message.contains(word), "{line}: {message}");
        }
    }
}
