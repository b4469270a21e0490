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
mod info;
mod interrupt;
mod lap;
mod lap_options;
mod localize;
mod log_file;
mod logs;
mod map;
mod mark;
mod numbers;
mod optimize;
mod output;
mod parameters;
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

use std::fmt::Display;
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
    Parameters(parameters::ParametersArgs),
    Evaluate(evaluate::EvaluateArgs),
    Convert(convert::ConvertArgs),
    Map(map::MapArgs),
    Mark(mark::MarkArgs),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return refuse_arguments(&error),
    };
    let outcome = match &cli.command {
        Command::Lap(args) => lap::run(args).map_err(|e| e.to_string()),
        Command::Basin(args) => {
            basin::run(args);
            Ok(())
        }
        Command::Terrain(args) => {
            terrain::run(args);
            Ok(())
        }
        Command::Table(args) => {
            table::run(args);
            Ok(())
        }
        Command::Register(args) => register::run(args).map_err(|e| e.to_string()),
        Command::Buildings(args) => buildings::run(args).map_err(|e| e.to_string()),
        Command::Places(args) => places::run(args).map_err(|e| e.to_string()),
        Command::Sweep(args) => sweep::run(args).map_err(|e| e.to_string()),
        Command::Optimize(args) => optimize::run(args).map_err(|e| e.to_string()),
        Command::Doctor(args) => match doctor::run(args) {
            Ok(code) => return code,
            Err(error) => Err(error.to_string()),
        },
        Command::Info(args) => info::run(args).map_err(|e| e.to_string()),
        Command::Run(args) => return ended(run_log::run(args)),
        Command::Localize(args) => return ended(localize::run(args)),
        Command::Relocalize(args) => relocalize::run(args).map_err(|e| e.to_string()),
        Command::Logs(args) => logs::run(args).map_err(|e| e.to_string()),
        Command::Recordings(args) => recordings::run(args).map_err(|e| e.to_string()),
        Command::Parameters(args) => parameters::run(args).map_err(|e| e.to_string()),
        Command::Evaluate(args) => evaluate::run(args).map_err(|e| e.to_string()),
        Command::Convert(args) => convert::run(args).map_err(|e| e.to_string()),
        Command::Map(args) => map::run(args).map_err(|e| e.to_string()),
        Command::Mark(args) => mark::run(args).map_err(|e| e.to_string()),
    };
    ended(outcome.map(|()| ExitCode::SUCCESS))
}

/// The exit code, after an error was printed.
fn ended(outcome: Result<ExitCode, impl Display>) -> ExitCode {
    match outcome {
        Ok(code) => code,
        Err(message) => {
            eprintln!("slam2d: {message}");
            ExitCode::from(2)
        }
    }
}

/// Prints help and version on request, and argument errors as one line.
fn refuse_arguments(error: &clap::Error) -> ExitCode {
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
