//! The command `slam2d`: maps the recorded logs of robots.
//!
//! Each subcommand is one file with its arguments, its run and its output.

mod convert;
mod doctor;
mod evaluate;
mod grade;
mod info;
mod live;
mod localize;
mod map;
mod mapping;
mod moved;
mod optimize;
mod run_folder;
mod run_log;
mod run_output;
mod session_file;
mod shown;
mod tick_costs;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use command_line::program;

/// Maps a robot's recorded log, or a robot while it drives, localizes on the map, and evaluates the result.
#[derive(Debug, Parser)]
#[command(name = "slam2d", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Doctor(doctor::DoctorArgs),
    Info(info::InfoArgs),
    Run(run_log::RunArgs),
    Live(live::LiveArgs),
    Localize(localize::LocalizeArgs),
    Map(map::MapArgs),
    Convert(convert::ConvertArgs),
    Evaluate(evaluate::EvaluateArgs),
    Optimize(optimize::OptimizeArgs),
    /// Any other word, and what follows it.
    #[command(external_subcommand)]
    Other(Vec<String>),
}

fn main() -> ExitCode {
    program::start("slam2d", |cli: &Cli| run(&cli.command))
}

fn run(command: &Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Doctor(args) => return doctor::run(args),
        Command::Info(args) => info::run(args)?,
        Command::Run(args) => return run_log::run(args),
        Command::Live(args) => return live::run(args),
        Command::Localize(args) => return localize::run(args),
        Command::Map(args) => map::run(args)?,
        Command::Convert(args) => convert::run(args)?,
        Command::Evaluate(args) => evaluate::run(args)?,
        Command::Optimize(args) => optimize::run(args)?,
        Command::Other(words) => return Err(moved::error(words)),
    }
    Ok(ExitCode::SUCCESS)
}
