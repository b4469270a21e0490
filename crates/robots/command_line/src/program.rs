//! The frame of a command: its arguments, its errors on standard error, and its exit code.

use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use crate::output::{name, name_program, say};

/// Runs a command. Wrong arguments and unusable files give one line on standard error and exit code 2.
pub fn start<C: Parser>(
    program: &'static str,
    run: impl FnOnce(&C) -> anyhow::Result<ExitCode>,
) -> ExitCode {
    name_program(program);
    let arguments = match C::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return reject_arguments(&error),
    };
    match run(&arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{program}: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints help and version on request, and argument errors as one line.
fn reject_arguments(error: &clap::Error) -> ExitCode {
    if matches!(
        error.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
    ) {
        // Clap's text ends with a newline.
        say!("{}", error.to_string().trim_end());
        return ExitCode::SUCCESS;
    }
    let name = name();
    eprintln!("{name}: {} (try {name} --help)", one_line(error));
    ExitCode::from(2)
}

/// The message of an argument error without usage and tips.
fn one_line(error: &clap::Error) -> String {
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return "a subcommand is required".to_owned();
    }
    let text = error.to_string();
    let message = text.split("\n\n").next().unwrap_or_default();
    let words: Vec<&str> = message.split_whitespace().collect();
    let joined = words.join(" ");
    joined.strip_prefix("error: ").unwrap_or(&joined).to_owned()
}
