//! The command `slam2d-dev`: writes the tables of the documentation.
//!
//! Each subcommand is one file with its arguments, its run and its output.

mod buildings;
mod logs;
mod recordings;
mod relocalize;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use command_line::program;

/// Measures the estimator on logs, recordings and simulated buildings, and writes the tables of the documentation.
#[derive(Debug, Parser)]
#[command(name = "slam2d-dev", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Logs(logs::LogsArgs),
    Recordings(recordings::RecordingsArgs),
    Relocalize(relocalize::RelocalizeArgs),
    Buildings(buildings::BuildingsArgs),
}

fn main() -> ExitCode {
    program::start("slam2d-dev", |cli: &Cli| run(&cli.command))
}

fn run(command: &Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Logs(args) => logs::run(args)?,
        Command::Recordings(args) => recordings::run(args)?,
        Command::Relocalize(args) => relocalize::run(args)?,
        Command::Buildings(args) => buildings::run(args)?,
    }
    Ok(ExitCode::SUCCESS)
}
