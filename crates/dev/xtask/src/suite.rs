//! `cargo xtask test`: runs every check, cheapest first. `docs/testing.md` describes them.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, hint, thread};

use anyhow::{Context as _, bail};
use clap::ValueEnum;

use crate::exercises;
use crate::python::{self, Environment};
use crate::run::{cargo, is_set, program, root, run};
use crate::site::{self, Speed};
use crate::tools::{self, TARGET, linting};

/// A piece of the suite, in the order in which they run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Piece {
    /// `cargo fmt --check`
    Format,
    /// The licences of all crates and npm packages
    Licences,
    /// Everything native: compiled and linted in one pass, then tested
    Native,
    /// The exercises in code: the solutions pass and drive a lap, unwritten ones fail
    Exercises,
    /// Lints of code for WebAssembly only
    Lints,
    /// Counted instructions against the recorded ones
    Counts,
    /// The site as it is published, and the types of its element
    Site,
    /// The module in Node
    Node,
    /// The package for Python as a wheel, and the notebooks that use it
    Python,
    /// The site in Chromium, and its three engines in one list of tests
    Browser,
}

/// Returns the chosen pieces in the order of the suite.
pub fn chosen(named: Vec<Piece>, quick: bool) -> Vec<Piece> {
    use Piece::{Format, Licences, Lints, Native};
    let named = if quick {
        vec![Format, Licences, Native, Lints]
    } else {
        named
    };
    let all = Piece::value_variants().iter().copied();
    all.filter(|piece| named.is_empty() || named.contains(piece))
        .collect()
}

/// Runs the pieces, stops at the first check that fails, and lists what was skipped.
///
/// # Errors
/// The check that failed.
pub fn test(pieces: &[Piece]) -> anyhow::Result<()> {
    // Report missing tools before many minutes of compiling and testing.
    let is_native = |piece| {
        use Piece::{Counts, Exercises, Format, Native, Python};
        matches!(piece, &Format | &Native | &Exercises | &Counts | &Python)
    };
    if !pieces.iter().all(is_native) {
        tools::ensure_web_tools()?;
    }
    let chromium = if pieces.contains(&Piece::Browser) {
        tools::ensure_node_modules("tests/browser")?;
        tools::ensure_engines()?;
        Some(tools::ensure_chromium_for_tests()?)
    } else {
        None
    };
    let uses_python = |piece| {
        matches!(
            piece,
            &Piece::Native | &Piece::Node | &Piece::Python | &Piece::Browser
        )
    };
    let python = if pieces.iter().any(uses_python) {
        python::ensure_environment()?
    } else {
        None
    };
    let skipped = root().join("target/xtask/skipped.txt");
    fs::create_dir_all(root().join("target/xtask"))?;
    fs::write(&skipped, "")?;
    let mut pieces = pieces.iter();
    let tools = Tools {
        chromium,
        python,
        skipped,
    };
    let done = pieces.try_for_each(|piece| test_piece(*piece, &tools));
    println!("\n── {}", summary(&fs::read_to_string(&tools.skipped)?));
    done
}

/// The environment of the pieces.
struct Tools {
    chromium: Option<PathBuf>,
    python: Option<Environment>,
    /// The list of what was skipped.
    skipped: PathBuf,
}

fn test_piece(piece: Piece, tools: &Tools) -> anyhow::Result<()> {
    let prepare = |command: &mut Command| {
        // Tests append a line for each skip.
        command.env("SLAM_SKIPPED", &tools.skipped);
        if let Some(python) = &tools.python {
            python.pass_to(command);
        }
    };
    match piece {
        Piece::Format => run("Format", cargo().args(["fmt", "--check"])),
        Piece::Licences => run("Licences", program("node").arg("web/licences/check.mjs")),
        Piece::Native => {
            let mut compile = cargo();
            // `--all-targets` would also link test programs of packages without tests.
            linting(&mut compile)?
                .args(["test", "--quiet", "--no-run"])
                .args(["--tests", "--examples"]);
            run("Compiling and linting natively", &mut compile)?;
            let mut test = cargo();
            prepare(linting(&mut test)?.args(["test", "--quiet"]));
            run("Native tests", &mut test)
        }
        Piece::Exercises => exercises::check(exercises::Lints::Denied),
        Piece::Lints => {
            let modules = [
                "--package=slam_web",
                "--package=slam_robot",
                "--target",
                TARGET,
            ];
            run("Linting code for WebAssembly only", &mut lint(&modules))?;
            let mut scripts = program(tools::npm());
            scripts.args(["run", "--silent", "lint"]);
            run("Linting scripts", scripts.current_dir(root().join("web")))
        }
        Piece::Counts => {
            compile_programs()?;
            let mut count = program(programs().join("slam2d_bench"));
            prepare(count.args(["--counts", "check"]));
            run("Counting instructions", &mut count)
        }
        Piece::Site => {
            site::build(Speed::SmallAndFast)?;
            check_generated()?;
            let mut check = program(tools::npm());
            check.args(["run", "--silent", "check"]);
            run("Types", check.current_dir(root().join("web")))
        }
        Piece::Node => {
            compile_programs()?;
            let mut node = program("node");
            node.arg("--test").args(test_files("tests/wasm")?);
            prepare(node.env("SLAM_NATIVE", programs()));
            run("Node tests", &mut node)
        }
        Piece::Python => {
            compile_programs()?;
            python::test(tools.python.as_ref(), &programs(), &tools.skipped)
        }
        Piece::Browser => {
            let chromium = tools.chromium.as_deref();
            let mut node = browser_tests(chromium.context("no Chromium was looked for")?, &[]);
            prepare(&mut node);
            run("Browser tests", &mut node)
        }
    }
}

/// Committed files that the build writes.
const GENERATED: [&str; 3] = [
    "web/slam-widget.d.ts",
    "docs/parameters.md",
    "docs/model.md",
];

/// Fails if the build has changed a generated file, on a build machine.
fn check_generated() -> anyhow::Result<()> {
    if !is_set("CI") {
        return Ok(());
    }
    let mut diff = program("git");
    diff.args(["diff", "--exit-code", "--stat", "--"])
        .args(GENERATED);
    run("Generated files", &mut diff)
        .context("commit what `cargo xtask build` writes: the files above are out of date")
}

/// The programs that other parts of the suite run.
const PROGRAMS: [&str; 5] = ["slam2d", "ch16", "ch16-mark", "states", "slam2d_bench"];

/// Compiles the programs that are counted or compared with the module in Node: with the whole workspace and an example,
/// because the crates then have the same features as for the tests and are compiled once.
fn compile_programs() -> anyhow::Result<()> {
    let mut compile = cargo();
    linting(&mut compile)?
        .args(["build", "--quiet", "--example=write_your_own_matcher"])
        .args(PROGRAMS.map(|name| format!("--bin={name}")))
        .arg("--target-dir")
        .arg(root().join("target"));
    run(&format!("Compiling {}", PROGRAMS.join(", ")), &mut compile)
}

fn programs() -> PathBuf {
    root().join("target/debug")
}

/// Returns the test files of a folder by name, because `node --test FOLDER` differs by version.
fn test_files(folder: &str) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(root().join(folder))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.to_string_lossy().ends_with(".test.mjs"));
    files.sort();
    Ok(files)
}

/// Returns the command of the browser tests: all files, or the given ones, such as `drag`.
fn browser_tests(chromium: &Path, only: &[String]) -> Command {
    let mut node = program("node");
    node.arg("tests/browser/run.mjs").env("CHROMIUM", chromium);
    // Earlier pieces have compiled it; without them the test that needs it does.
    if PROGRAMS.iter().all(|name| programs().join(name).exists()) {
        node.env("SLAM_NATIVE", programs());
    }
    if !only.is_empty() {
        node.args(["--only", &only.join(",")]);
    }
    node
}

/// `cargo xtask soak`: repeats the browser tests while a busy thread for each core loads the machine.
///
/// # Errors
/// The failed rounds; the output above has the failed tests.
pub fn soak(rounds: u32, go_on: bool, only: &[String]) -> anyhow::Result<()> {
    if !root().join("dist/schema.json").is_file() {
        bail!("dist/ does not contain a site: `cargo xtask build` makes one");
    }
    tools::ensure_node_modules("tests/browser")?;
    tools::ensure_engines()?;
    let chromium = tools::ensure_chromium_for_tests()?;
    for _ in 0..thread::available_parallelism()?.get() {
        thread::spawn(|| {
            loop {
                hint::black_box(0);
            }
        });
    }
    let mut failed = Vec::new();
    for round in 1..=rounds {
        let what = format!("Round {round} of {rounds}");
        if let Err(error) = run(&what, &mut browser_tests(&chromium, only)) {
            println!("{error}");
            failed.push(round);
            if !go_on {
                break;
            }
        }
    }
    if failed.is_empty() {
        println!("\nNo failure in {rounds} rounds");
        return Ok(());
    }
    bail!("these rounds failed: {failed:?}")
}

/// `cargo xtask record-counts`: records the present instruction counts as the suite's reference.
///
/// # Errors
/// If they do not compile, or valgrind is missing.
pub fn record_counts() -> anyhow::Result<()> {
    compile_programs()?;
    let mut count = program(programs().join("slam2d_bench"));
    count.args(["--counts", "accept"]).env("SLAM_NO_SKIP", "1");
    run("Recording the instruction counts", &mut count)
}

/// `cargo xtask peers`: lints and tests the solvers of others, which the suite leaves out, because they take minutes to
/// compile and no other package depends on them.
///
/// # Errors
/// The step that failed.
pub fn test_peers() -> anyhow::Result<()> {
    for (what, options) in [
        ("Lints of", &["--no-run", "--all-targets"][..]),
        ("Tests of", &[]),
    ] {
        let mut command = cargo();
        linting(&mut command)?.args(["test", "--quiet", "--package=solver_peers"]);
        run(&format!("{what} solver_peers"), command.args(options))?;
    }
    Ok(())
}

/// `cargo xtask desktop`: lints the window of the desktop without compiling what it opens, whose tests the suite runs.
///
/// # Errors
/// A warning or an error in it.
pub fn lint_desktop() -> anyhow::Result<()> {
    run(
        "Linting the desktop window",
        &mut lint(&["--package=slam_desktop"]),
    )
}

/// Lints what no other piece compiles; warnings are errors.
fn lint(what: &[&str]) -> Command {
    let mut lint = cargo();
    lint.args(["clippy", "--quiet"])
        .args(what)
        .args(["--", "-D", "warnings"])
        .env("CARGO_INCREMENTAL", "0");
    lint
}

fn summary(skipped: &str) -> String {
    let mut lines: Vec<_> = skipped.lines().filter(|line| !line.is_empty()).collect();
    lines.sort_unstable();
    lines.dedup();
    if lines.is_empty() {
        return "Nothing was skipped".to_owned();
    }
    let title = "Skipped (SLAM_NO_SKIP=1 makes these failures):";
    format!("{title}\n   {}", lines.join("\n   "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::output;

    #[test]
    fn pieces_run_in_the_order_of_the_suite() {
        assert_eq!(
            chosen(vec![Piece::Node, Piece::Counts], false),
            [Piece::Counts, Piece::Node]
        );
        assert_eq!(chosen(Vec::new(), false), Piece::value_variants());
        let quick = chosen(Vec::new(), true);
        assert!(quick.contains(&Piece::Lints) && !quick.contains(&Piece::Site));
    }

    #[test]
    fn what_was_skipped_is_listed_once_and_in_order() {
        assert_eq!(summary("\n"), "Nothing was skipped");
        assert_eq!(
            summary("b: no data\na: no valgrind\nb: no data\n"),
            "Skipped (SLAM_NO_SKIP=1 makes these failures):\n   a: no valgrind\n   b: no data"
        );
    }

    #[test]
    fn git_knows_the_generated_files() {
        let listed = output(program("git").args(["ls-files", "--"]).args(GENERATED));
        // Without git there is no check: an unpacked archive has no history.
        if let Some(listed) = listed {
            assert_eq!(listed.lines().count(), GENERATED.len());
        }
    }

    #[test]
    fn the_test_files_are_found_and_the_helpers_left_out() {
        let files = test_files("tests/browser").unwrap();
        assert!(files.iter().any(|file| file.ends_with("manners.test.mjs")));
        assert!(!files.iter().any(|file| file.ends_with("harness.mjs")));
    }
}
