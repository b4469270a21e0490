//! How often each target was executed on this machine, over all runs.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use super::folder;
use crate::run::Failure;

/// Executions and seconds by target: one line each in a text file.
#[derive(Debug, Default, PartialEq)]
pub struct Tally(BTreeMap<String, (u64, f64)>);

impl Tally {
    /// The tally so far; empty where there is none.
    pub fn read() -> Self {
        Self::parse(&fs::read_to_string(path()).unwrap_or_default())
    }

    /// Adds a run.
    pub fn add(&mut self, target: &str, executions: u64, seconds: f64) {
        let entry = self.0.entry(target.to_owned()).or_default();
        entry.0 += executions;
        entry.1 += seconds;
    }

    /// Keeps it for the next run.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn write(&self) -> Result<(), Failure> {
        let path = path();
        fs::write(&path, self.text())
            .map_err(|error| Failure::new(format!("{}: {error}", path.display())))
    }

    /// Executions of a target.
    pub fn executions(&self, target: &str) -> u64 {
        self.0.get(target).map_or(0, |entry| entry.0)
    }

    /// Executions of all targets.
    pub fn all_executions(&self) -> u64 {
        self.0.values().map(|entry| entry.0).sum()
    }

    /// Wall time of all targets, s.
    pub fn all_seconds(&self) -> f64 {
        self.0.values().map(|entry| entry.1).sum()
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (target, (executions, seconds)) in &self.0 {
            writeln!(text, "{target} {executions} {seconds:.1}").expect("writing to memory");
        }
        text
    }

    /// Lines that do not fit are left out: the file is only a tally.
    fn parse(text: &str) -> Self {
        let entries = text.lines().filter_map(|line| {
            let mut words = line.split_whitespace();
            let target = words.next()?.to_owned();
            Some((
                target,
                (words.next()?.parse().ok()?, words.next()?.parse().ok()?),
            ))
        });
        Self(entries.collect())
    }
}

fn path() -> PathBuf {
    folder().join("tally.txt")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tally_reads_back_and_adds_up() {
        let mut tally = Tally::parse("g2o 100 2.0\nbroken\n");
        tally.add("g2o", 50, 1.0);
        tally.add("links", 1000, 0.5);
        assert_eq!(Tally::parse(&tally.text()), tally);
        assert_eq!(tally.executions("g2o"), 150);
        assert_eq!(tally.all_executions(), 1150);
        assert_eq!(tally.all_seconds(), 3.5);
    }
}
