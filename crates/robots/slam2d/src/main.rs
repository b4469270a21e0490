//! The command `slam2d`: the chapter's numbers on the command line.
//!
//! Each subcommand is one file with its arguments, its run and its output. Wrong arguments and
//! unusable files give one line on standard error and exit code 2.

mod basin;
mod buildings;
mod convert;
mod doctor;
mod evaluate;
mod grade;
mod in_file;
mod info;
mod interrupt;
mod lap;
mod lap_options;
mod laps;
mod localize;
mod log_file;
mod logs;
mod map;
mod mark;
mod numbers;
mod optimize;
mod output;
mod places;
mod recordings;
mod register;
mod relocalize;
mod robots;
mod run_folder;
mod run_log;
mod run_output;
mod session_file;
mod sweep;
mod table;
mod terrain;
mod tick_costs;
mod world;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

use output::say;

/// The numbers of the chapter on scan matching and pose-graph SLAM.
#[derive(Debug, Parser)]
#[command(name = "slam2d", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Lap(lap::LapArgs),
    Laps(laps::LapsArgs),
    Basin(basin::BasinArgs),
    Terrain(terrain::TerrainArgs),
    Table(table::TableArgs),
    Register(register::RegisterArgs),
    Places(places::PlacesArgs),
    Buildings(buildings::BuildingsArgs),
    Sweep(sweep::SweepArgs),
    Optimize(optimize::OptimizeArgs),
    Info(info::InfoArgs),
    Doctor(doctor::DoctorArgs),
    Run(run_log::RunArgs),
    Localize(localize::LocalizeArgs),
    Relocalize(relocalize::RelocalizeArgs),
    Logs(logs::LogsArgs),
    Recordings(recordings::RecordingsArgs),
    Evaluate(evaluate::EvaluateArgs),
    Convert(convert::ConvertArgs),
    Map(map::MapArgs),
    Mark(mark::MarkArgs),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return reject_arguments(&error),
    };
    match run(&cli.command) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("slam2d: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(command: &Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Lap(args) => lap::run(args)?,
        Command::Laps(args) => laps::run(args)?,
        Command::Basin(args) => basin::run(args),
        Command::Terrain(args) => terrain::run(args),
        Command::Table(args) => table::run(args),
        Command::Register(args) => register::run(args)?,
        Command::Buildings(args) => buildings::run(args)?,
        Command::Places(args) => places::run(args)?,
        Command::Sweep(args) => sweep::run(args)?,
        Command::Optimize(args) => optimize::run(args)?,
        Command::Doctor(args) => return doctor::run(args),
        Command::Info(args) => info::run(args)?,
        Command::Run(args) => return run_log::run(args),
        Command::Localize(args) => return localize::run(args),
        Command::Relocalize(args) => relocalize::run(args)?,
        Command::Logs(args) => logs::run(args)?,
        Command::Recordings(args) => recordings::run(args)?,
        Command::Evaluate(args) => evaluate::run(args)?,
        Command::Convert(args) => convert::run(args)?,
        Command::Map(args) => map::run(args)?,
        Command::Mark(args) => mark::run(args)?,
    }
    Ok(ExitCode::SUCCESS)
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
    eprintln!("slam2d: {} (try slam2d --help)", one_line(error));
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
