//! The command `ch16`: the chapter's experiments on the command line.
//!
//! Each subcommand is one file with its arguments, its run and its output.

mod basin;
mod lap;
mod lap_options;
mod laps;
mod places;
mod register;
mod sweep;
mod table;
mod terrain;
mod world;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use command_line::program;

/// The experiments of the chapter on scan matching and pose-graph SLAM.
#[derive(Debug, Parser)]
#[command(name = "ch16", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Table(table::TableArgs),
    Lap(lap::LapArgs),
    Laps(laps::LapsArgs),
    Basin(basin::BasinArgs),
    Terrain(terrain::TerrainArgs),
    Register(register::RegisterArgs),
    Places(places::PlacesArgs),
    Sweep(sweep::SweepArgs),
}

fn main() -> ExitCode {
    program::start("ch16", |cli: &Cli| run(&cli.command))
}

fn run(command: &Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Table(args) => table::run(args),
        Command::Lap(args) => lap::run(args)?,
        Command::Laps(args) => laps::run(args)?,
        Command::Basin(args) => basin::run(args),
        Command::Terrain(args) => terrain::run(args),
        Command::Register(args) => register::run(args)?,
        Command::Places(args) => places::run(args)?,
        Command::Sweep(args) => sweep::run(args)?,
    }
    Ok(ExitCode::SUCCESS)
}
