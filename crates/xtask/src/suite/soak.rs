//! `cargo xtask soak N`: the browser tests again and again on a machine that is busy with other work.

use std::time::Instant;

use super::browser;
use crate::chromium;
use crate::load::Load;
use crate::run::{Failure, root};
use crate::tools;

/// What to repeat, and how often.
#[derive(Debug, PartialEq, Eq)]
pub struct Soak {
    /// How often the tests run.
    pub rounds: u32,
    /// The files by their names without `.test.mjs`; all of them where none is named.
    pub only: Vec<String>,
    /// Whether later rounds run.
    pub after_failure: AfterFailure,
}

/// What a failure means for the rounds that are left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AfterFailure {
    /// They are not run.
    Stop,
    /// They are run, and all failures are told at the end.
    GoOn,
}

/// Runs the browser tests round after round while a busy thread for each core loads the machine.
/// The site must have been built.
///
/// # Errors
/// The rounds that failed; what failed in them stands in the output above.
pub fn soak(soak: &Soak) -> Result<(), Failure> {
    if !root().join("dist/schema.json").is_file() {
        return Err(Failure::new(
            "dist/ holds no site: `cargo xtask build` makes one",
        ));
    }
    tools::ensure_node_modules(&root().join("tests/browser"))?;
    let chromium = chromium::ensure_chromium(chromium::Wanted::ForTests)?;
    let load = Load::on_every_core();
    println!("{} busy threads load the machine", load.threads());
    let mut failed = Vec::new();
    for round in 1..=soak.rounds {
        println!("\n── Round {round} of {}", soak.rounds);
        let started = Instant::now();
        let done = browser::run(&chromium, &soak.only, None);
        println!("── Round {round}: {:.0} s", started.elapsed().as_secs_f64());
        if let Err(failure) = done {
            println!("── Round {round} failed: {failure}");
            failed.push(format!("round {round}: {failure}"));
            if soak.after_failure == AfterFailure::Stop {
                break;
            }
        }
    }
    verdict(soak.rounds, &failed)
}

fn verdict(rounds: u32, failed: &[String]) -> Result<(), Failure> {
    if failed.is_empty() {
        println!("\nNo failure in {rounds} rounds");
        return Ok(());
    }
    Err(Failure::new(failed.join("\n       ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_round_that_failed_is_named() {
        assert!(verdict(20, &[]).is_ok());
        let failed = ["round 3: drag".to_owned(), "round 7: embed".to_owned()];
        let message = verdict(20, &failed).unwrap_err().to_string();
        assert!(message.contains("round 3: drag") && message.contains("round 7: embed"));
    }
}
