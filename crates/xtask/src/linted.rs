//! Lints what only WebAssembly compiles, while the site is compiled.
//!
//! The lints of a crate need the crates below it, and the site has these compiled for the same target. So this
//! program stands before the compiler, as cargo's `RUSTC_WRAPPER`: a crate that holds code for
//! WebAssembly alone goes through clippy first, and what clippy finds ends its compilation. A crate that
//! cargo takes for up to date has passed. The compiler itself makes the module, since clippy's leaves
//! optimizations out.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

use crate::run::{Failure, root};
use crate::tools;

/// The crates that have code for WebAssembly alone.
const LINTED: [&str; 3] = ["slam_web", "slam_robot", "pr_geom"];

/// Tells this program that it stands before the compiler, and where clippy is.
const CLIPPY: &str = "SLAM_CLIPPY_BEFORE_RUSTC";

/// Lints [`LINTED`] where that command has cargo compile them.
///
/// # Errors
/// Where clippy or this program cannot be found.
pub fn linted(command: &mut Command) -> Result<&mut Command, Failure> {
    let this = env::current_exe()
        .map_err(|error| Failure::new(format!("this program does not find itself: {error}")))?;
    Ok(tools::deny_warnings(command)
        .env("RUSTC_WRAPPER", this)
        .env(CLIPPY, tools::clippy_driver()?))
}

/// Where cargo runs this program before the compiler: lints, compiles, and says how it ended.
pub fn before_rustc() -> Option<ExitCode> {
    let clippy = env::var_os(CLIPPY)?;
    let mut words = env::args_os().skip(1);
    let rustc = words.next()?;
    let words: Vec<OsString> = words.collect();
    let mut passes = Vec::new();
    if is_linted(&words) {
        let folder = root().join("target/xtask/lints");
        if let Err(error) = fs::create_dir_all(&folder) {
            eprintln!("{}: {error}", folder.display());
            return Some(ExitCode::FAILURE);
        }
        let mut lint = Command::new(clippy);
        lint.arg(&rustc).args(without_code(&words, &folder));
        passes.push(lint);
    }
    let mut compile = Command::new(&rustc);
    compile.args(&words);
    passes.push(compile);
    for mut pass in passes {
        match pass.status() {
            Ok(status) if status.success() => {}
            // What it found, it has said.
            Ok(_) => return Some(ExitCode::FAILURE),
            Err(error) => {
                let program = pass.get_program().display();
                eprintln!("{program} cannot be started: {error}");
                return Some(ExitCode::FAILURE);
            }
        }
    }
    Some(ExitCode::SUCCESS)
}

/// Whether the compiler is asked for one of [`LINTED`], for WebAssembly.
fn is_linted(words: &[OsString]) -> bool {
    let after = |option: &str| {
        let at = words.iter().position(|word| word == option)?;
        words.get(at + 1)?.to_str()
    };
    after("--target") == Some(tools::TARGET)
        && after("--crate-name").is_some_and(|name| LINTED.contains(&name))
}

/// The same words, for a compiler that only looks: it writes into a folder of its own, and tells cargo of
/// nothing that it has written.
fn without_code(words: &[OsString], folder: &Path) -> Vec<OsString> {
    let mut lint: Vec<OsString> = Vec::with_capacity(words.len());
    for word in words {
        let is_folder = lint.last().is_some_and(|last| last == "--out-dir");
        lint.push(match word.to_str() {
            _ if is_folder => folder.into(),
            Some(emit) if emit.starts_with("--emit=") => "--emit=metadata".into(),
            Some(json) if json.starts_with("--json=") => json.replace(",artifacts", "").into(),
            _ => word.clone(),
        });
    }
    lint
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn what_is_compiled_for_webassembly_is_linted_and_nothing_else() {
        let target = "--target wasm32-unknown-unknown";
        let asked = |line: &str| is_linted(&words(line));
        assert!(asked(&format!("--crate-name slam_web lib.rs {target}")));
        assert!(!asked("--crate-name slam_web lib.rs"));
        assert!(!asked(&format!("--crate-name egui lib.rs {target}")));
        assert!(!asked(&format!("- --print=cfg {target}")));
    }

    #[test]
    fn the_lint_writes_apart_and_announces_nothing() {
        let compile = "--json=diagnostic-rendered-ansi,artifacts,future-incompat \
                       --emit=dep-info,link --out-dir deps -C lto";
        let expected = "--json=diagnostic-rendered-ansi,future-incompat \
                        --emit=metadata --out-dir lints -C lto";
        let lint = without_code(&words(compile), Path::new("lints"));
        assert_eq!(lint, words(expected));
    }

    #[test]
    fn every_crate_with_code_for_webassembly_alone_is_named() {
        let packages =
            ["crates", "widgets"].map(|folder| fs::read_dir(root().join(folder)).unwrap());
        let packages = packages
            .into_iter()
            .flatten()
            .map(|package| package.unwrap());
        let mut holding: Vec<String> = packages
            .filter(|package| holds_webassembly(&package.path().join("src")))
            .map(|package| package.file_name().into_string().unwrap())
            .collect();
        // This file asks as well, and the two modules are nothing else.
        holding.retain(|name| name != "xtask");
        holding.extend(["slam_web", "slam_robot"].map(str::to_owned));
        holding.sort_unstable();
        let mut linted = LINTED;
        linted.sort_unstable();
        assert_eq!(holding, linted);
    }

    /// Whether a library has code for WebAssembly.
    fn holds_webassembly(folder: &Path) -> bool {
        fs::read_dir(folder).into_iter().flatten().any(|entry| {
            let path = entry.unwrap().path();
            if path.is_dir() {
                return holds_webassembly(&path);
            }
            let text = fs::read_to_string(&path).unwrap();
            ["cfg(", "all("]
                .iter()
                .any(|asks| text.contains(&format!("{asks}target_arch = \"wasm32\"")))
        })
    }
}
