//! The command line, read by hand: a parser crate would double the time of the first build.

use std::path::PathBuf;

use crate::site::Speed;

/// What `cargo xtask` alone prints.
pub const USAGE: &str = "\
cargo xtask serve [--port 8016] [--release]   build the page and serve it
cargo xtask build                             build the finished static site into dist/
cargo xtask test                              every check: format, lints, native, wasm, browser
cargo xtask bench [--json FILE]               time and count the workloads, write docs/performance.md
cargo xtask sizes                             what keeps the module small, each step left out once";

/// One of the commands, with its options.
#[derive(Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the usage.
    Help,
    /// Build `dist/`.
    Build,
    /// Build and serve.
    Serve {
        /// TCP port on the local machine.
        port: u16,
        /// How long the compiler may take.
        speed: Speed,
    },
    /// Run every check.
    Test,
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
        "test" => Command::Test,
        "sizes" => Command::Sizes,
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
    fn a_wrong_word_is_named() {
        for (line, word) in [
            ("sevre", "`sevre`"),
            ("serve --prot 1", "`--prot`"),
            ("serve --port x", "`x`"),
            ("serve --port 0", "`0`"),
            ("build now", "`now`"),
        ] {
            let message = parse_line(line).unwrap_err();
            assert!(message.contains(word), "{line}: {message}");
        }
    }
}
