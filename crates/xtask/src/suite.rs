//! `cargo xtask test`: every check there is, cheapest first. `docs/testing.md` says what is where.

mod browser;
pub mod native;
mod piece;
mod skipped;
mod soak;
mod wasm;

use std::path::PathBuf;
use std::process::Command;
use std::{fs, io};

pub use native::{Beside, beside, record_counts};
pub use piece::Piece;
pub use soak::{AfterFailure, Soak, soak};

use crate::chromium;
use crate::ledger::Ledger;
use crate::run::{Failure, cargo, program, root, show};
use crate::tools;
use skipped::SkipList;

/// Runs the pieces in the order of the suite and stops at the first check that fails. Says at the end
/// what took how long and what was skipped, after a failure as well.
///
/// # Errors
/// The check that failed.
pub fn test(pieces: &[Piece]) -> Result<(), Failure> {
    let skipped = SkipList::begin()?;
    let mut ledger = Ledger::default();
    let done = ledger
        .time("tools", || ensure_tools(pieces))
        .and_then(|chromium| {
            in_order(pieces)
                .try_for_each(|piece| run(piece, chromium.as_ref(), &skipped, &mut ledger))
        });
    println!("\n── What took how long\n{ledger}");
    println!("── {skipped}");
    done
}

/// The pieces in the order of the suite. What builds the site lints what only WebAssembly compiles.
fn in_order(pieces: &[Piece]) -> impl Iterator<Item = Piece> {
    let is_told_twice = |piece| piece == Piece::Lints && pieces.contains(&Piece::Site);
    Piece::ALL
        .into_iter()
        .filter(move |piece| pieces.contains(piece) && !is_told_twice(*piece))
}

/// What is missing is better known before many minutes of compiling and testing.
fn ensure_tools(pieces: &[Piece]) -> Result<Option<PathBuf>, Failure> {
    if pieces.iter().any(|piece| piece.needs_the_site()) {
        tools::ensure_build_tools()?;
    }
    if !pieces.contains(&Piece::Browser) {
        return Ok(None);
    }
    tools::ensure_node_modules(&root().join("tests/browser"))?;
    chromium::ensure_chromium(chromium::Wanted::ForTests).map(Some)
}

fn run(
    piece: Piece,
    chromium: Option<&PathBuf>,
    skipped: &SkipList,
    ledger: &mut Ledger,
) -> Result<(), Failure> {
    match piece {
        Piece::Format => timed(ledger, "format", cargo().args(["fmt", "--check"])),
        Piece::Licences => timed(
            ledger,
            "licences",
            program("node").arg("web/licences/check.mjs"),
        ),
        Piece::Native => native::test(skipped, ledger),
        Piece::Lints => wasm::lints(ledger),
        Piece::Counts => native::counts(skipped, ledger),
        Piece::Site => wasm::site(ledger),
        Piece::Node => wasm::node(skipped, ledger),
        Piece::Browser => {
            let chromium = chromium.ok_or_else(|| Failure::new("no Chromium was looked for"))?;
            ledger.time_with_chromium("browser tests", || {
                browser::run(chromium, &[], Some(skipped))
            })
        }
    }
}

/// A program that shows its output, as a step of the ledger.
fn timed(ledger: &mut Ledger, what: &str, command: &mut Command) -> Result<(), Failure> {
    ledger.time(what, || show(what, command))
}

/// The test files of a folder by name: what `node --test` makes of a folder differs by version.
fn test_files(folder: &str) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: io::Error| Failure::new(format!("{folder}: {error}"));
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join(folder)).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.to_string_lossy().ends_with(".test.mjs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lints_have_a_step_of_their_own_where_no_site_is_built() {
        let steps = |pieces: &[Piece]| {
            in_order(pieces)
                .filter(|piece| *piece == Piece::Lints)
                .count()
        };
        assert_eq!(steps(&Piece::QUICK), 1);
        assert_eq!(steps(&Piece::ALL), 0);
    }

    #[test]
    fn the_test_files_are_found_and_the_helpers_left_out() {
        let files = test_files("tests/browser").unwrap();
        assert!(files.iter().any(|file| file.ends_with("manners.test.mjs")));
        assert!(!files.iter().any(|file| file.ends_with("harness.mjs")));
    }
}
