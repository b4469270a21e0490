//! `cargo xtask exercises`: a student's progress, and a check of our solutions.

use std::collections::HashMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, SystemTime};
use std::{fmt, fs};

use anyhow::{Context as _, bail, ensure};
use proc_macro2::{TokenStream, TokenTree};

use crate::run::{cargo, root, run};
use crate::tools::linting;

/// The arguments.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct Exercises {
    /// Run again after every save.
    #[arg(long)]
    watch: bool,
    /// One JSON object for a grader: teaching/guide/exercises.md has its fields.
    #[arg(long, conflicts_with = "watch")]
    json: bool,
    /// The order in which the next one is named.
    #[arg(long, value_enum, default_value_t = Plan::List)]
    plan: Plan,
    /// Check that the solutions pass, and that unwritten exercises fail.
    #[arg(long, conflicts_with_all = ["watch", "json"])]
    solutions: bool,
}

/// An order of the exercises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
enum Plan {
    /// As they are numbered.
    #[default]
    List,
    /// As in the lab of teaching/guide/lectures.md, the two for homework at the end.
    Lab,
}

impl Plan {
    /// Places in [`EXERCISES`].
    fn order(self) -> [usize; EXERCISES.len()] {
        match self {
            Self::List => [0, 1, 2, 3, 4, 5, 6],
            Self::Lab => [0, 5, 2, 3, 4, 1, 6],
        }
    }
}

/// The exercises in their order, each with a hint.
const EXERCISES: [(&str, &str); 7] = [
    (
        "svd_align",
        "Subtract both means first; then only a rotation is left to find, and t follows from the means.",
    ),
    (
        "point_to_plane_step",
        "Sum the outer products of the rows, add the ridge, solve. Then turn about the centroid, not the origin.",
    ),
    (
        "residual",
        "Z⁻¹ comes first in the product. SE2 has inverse, log and adjoint; the product is `*`.",
    ),
    (
        "gauss_newton",
        "Each edge adds four 3×3 blocks and two 3-vectors; leave out those of the held node, and give it a diagonal.",
    ),
    (
        "verify_loop",
        "The belief is in the candidate's frame: T₀ = T_candidate⁻¹ T_node. The gate compares T̂ with T₀, not with the world.",
    ),
    (
        "trimmed_icp",
        "Trim after each association, the first one too. Count what is kept with ceil, and keep at least one.",
    ),
    (
        "range_histogram",
        "A bin is the range times 64/max_range, rounded down, 63 at most. Skip bins that are empty in both.",
    ),
];

/// State of an exercise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Passes,
    Fails,
    NotWritten,
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Passes => "passes",
            Self::Fails => "fails",
            Self::NotWritten => "not written",
        })
    }
}

/// Results of a run of the tests.
struct Report {
    /// Names as `exercise::test`, in the order of the run, and whether each passed.
    tests: Vec<(String, bool)>,
    /// The first message of each test that failed.
    messages: HashMap<String, String>,
}

impl Report {
    /// The results in the log that libtest writes itself, because a student's code can print lines like its own; `None`
    /// unless the log names each of the `expected` tests once and agrees with the end of the process.
    fn with_log(self, log: &str, expected: &[String], is_success: bool) -> Option<Self> {
        let result = |line: &str| {
            let (verdict, name) = line.split_once(' ')?;
            Some((name.to_owned(), verdict == "ok"))
        };
        let tests: Vec<(String, bool)> = log.lines().filter_map(result).collect();
        let mut names: Vec<&String> = tests.iter().map(|(name, _)| name).collect();
        let mut wanted: Vec<&String> = expected.iter().collect();
        names.sort();
        wanted.sort();
        let agrees = tests.iter().all(|(_, passed)| *passed) == is_success;
        (names == wanted && agrees).then_some(Self { tests, ..self })
    }

    /// Parses the output of libtest; `None` if it is incomplete.
    fn read(printed: &str) -> Option<Self> {
        let result = |line: &str| {
            let (name, verdict) = line.strip_prefix("test ")?.rsplit_once(" ... ")?;
            Some((name.to_owned(), verdict == "ok"))
        };
        let sections = printed.split("\n---- ").skip(1);
        let message = |section: &str| {
            let (name, text) = section.split_once(" stdout ----")?;
            let text = text
                .split_once(" panicked at ")?
                .1
                .split("\nnote: ")
                .next()?;
            Some((name.to_owned(), text.trim().to_owned()))
        };
        printed.contains("\ntest result: ").then(|| Self {
            tests: printed.lines().filter_map(result).collect(),
            messages: sections.filter_map(message).collect(),
        })
    }

    /// Adds tests that fail, each with this message.
    fn fail(&mut self, names: &[String], message: &str) {
        for name in names {
            self.tests.push((name.clone(), false));
            self.messages.insert(name.clone(), message.to_owned());
        }
    }

    fn of<'a>(&'a self, exercise: &'a str) -> impl Iterator<Item = (&'a str, bool)> + Clone {
        self.tests.iter().filter_map(move |(name, passed)| {
            let test = name.strip_prefix(exercise)?.strip_prefix("::")?;
            Some((test, *passed))
        })
    }

    fn state(&self, exercise: &str) -> State {
        let mut tests = self.of(exercise).peekable();
        if tests.peek().is_some() && tests.all(|(_, passed)| passed) {
            State::Passes
        } else if is_untouched(exercise) {
            State::NotWritten
        } else {
            State::Fails
        }
    }

    /// The unwritten exercise without which this one fails, if it is written itself.
    fn waits_for(&self, exercise: &str) -> Option<&'static str> {
        let message = |test: &str| self.messages.get(&format!("{exercise}::{test}"));
        let mut failed = self.of(exercise).filter(|(_, passed)| !passed).peekable();
        failed.peek()?;
        let texts: Option<Vec<&String>> = failed.map(|(test, _)| message(test)).collect();
        let mut others = EXERCISES.into_iter().map(|(name, _)| name);
        let texts = texts?;
        others.find(|other| {
            let missing = format!("{other} is not written yet");
            *other != exercise && texts.iter().all(|text| text.contains(&missing))
        })
    }

    /// A list, a bar, and the next exercise of the plan that does not pass, with its hint.
    fn print(&self, plan: Plan) {
        for (exercise, _) in EXERCISES {
            let (passed, all) = self.passed(exercise);
            let state = match self.waits_for(exercise) {
                Some(other) => format!("waits for {other}"),
                None => self.state(exercise).to_string(),
            };
            println!("  {exercise:<20}  {passed} of {all} tests  {state}");
        }
        let passes = |(exercise, _): &(&str, &str)| self.state(exercise) == State::Passes;
        let done = EXERCISES.iter().filter(|exercise| passes(exercise)).count();
        let bar = "█".repeat(4 * done) + &"░".repeat(4 * (EXERCISES.len() - done));
        println!("\n{bar}  {done} of {} exercises", EXERCISES.len());
        let mut ordered = plan.order().into_iter().map(|at| EXERCISES[at]);
        let next = ordered.find(|one| !passes(one) && self.waits_for(one.0).is_none());
        let Some((exercise, hint)) = next else {
            println!("\nSee them drive: cargo run -p ch16 --features exercises -- lap --exercises");
            return;
        };
        println!("\nNext: teaching/exercises/src/{exercise}.rs\nHint: {hint}");
        println!("Run:  cargo test -p exercises {exercise}::");
        let failed = self.of(exercise).find(|(_, passed)| !passed);
        let message = failed.and_then(|(test, _)| {
            let message = self.messages.get(&format!("{exercise}::{test}"))?;
            Some((test, message))
        });
        if let Some((test, message)) = message {
            println!("\n{test}\n  {}", message.replace('\n', "\n  "));
        }
    }

    /// Tests that passed, and all tests.
    fn passed(&self, exercise: &str) -> (usize, usize) {
        let tests = self.of(exercise);
        (
            tests.clone().filter(|(_, passed)| *passed).count(),
            tests.count(),
        )
    }

    /// The JSON for a grader. Names are identifiers of Rust, so they need no escapes.
    fn json(report: Option<&Self>) -> String {
        let exercise = |report: &Self, name: &str| {
            let tests = report.of(name);
            let tests =
                tests.map(|(test, passed)| format!(r#"{{"name":"{test}","passed":{passed}}}"#));
            let tests = tests.collect::<Vec<_>>().join(",");
            let state = report.state(name);
            format!(r#"{{"name":"{name}","state":"{state}","tests":[{tests}]}}"#)
        };
        let of_all = |report: &Self| EXERCISES.map(|(name, _)| exercise(report, name)).join(",");
        let passes = |report: &Self| {
            let states = EXERCISES.iter().map(|(name, _)| report.state(name));
            states.filter(|state| *state == State::Passes).count()
        };
        format!(
            r#"{{"schema":1,"ran":{},"passed":{},"total":{},"exercises":[{}]}}"#,
            report.is_some(),
            report.map_or(0, passes),
            EXERCISES.len(),
            report.map_or_else(String::new, of_all)
        )
    }
}

fn source(exercise: &str) -> PathBuf {
    root().join(format!("teaching/exercises/src/{exercise}.rs"))
}

/// Whether the file still contains the original stub.
fn is_untouched(exercise: &str) -> bool {
    fs::read_to_string(source(exercise)).is_ok_and(|text| text.contains("not_written("))
}

/// The test program of the student's functions with these arguments.
fn test_program(arguments: &[&str]) -> Command {
    let mut tests = cargo();
    tests
        .args(["test", "--quiet", "--package", "exercises"])
        .args(["--test", "exercises", "--"])
        .args(arguments)
        .env("RUST_BACKTRACE", "0")
        .stderr(Stdio::inherit());
    tests
}

/// What an exercise has no use for: with these a file could end the test program, or write the log that judges it.
const FORBIDDEN: [&str; 8] = [
    "process",
    "fs",
    "env",
    "net",
    "unsafe",
    "extern",
    "include",
    "include_str",
];

/// The first word of a source that an exercise may not have, or the attribute `path`. Comments are no tokens.
fn forbidden(source: TokenStream) -> Option<&'static str> {
    let mut is_attribute = false;
    source.into_iter().find_map(|token| match token {
        TokenTree::Group(group) => {
            let names_path = group.stream().to_string().starts_with("path");
            if core::mem::take(&mut is_attribute) && names_path {
                return Some("path");
            }
            forbidden(group.stream())
        }
        TokenTree::Ident(ident) => {
            let name = ident.to_string();
            let name = name.strip_prefix("r#").unwrap_or(&name);
            FORBIDDEN.into_iter().find(|word| *word == name)
        }
        TokenTree::Punct(punct) => {
            is_attribute = punct.as_char() == '#';
            None
        }
        TokenTree::Literal(_) => None,
    })
}

/// Runs the tests on the student's functions, each exercise in a process of its own: one that ends it hides no other.
/// `None` if they do not compile.
fn run_tests() -> anyhow::Result<Option<Report>> {
    const NO_CARGO: &str = "cargo cannot be started";
    let listed = test_program(&["--list"]).output().context(NO_CARGO)?;
    if !listed.status.success() {
        return Ok(None);
    }
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let names = listed
        .lines()
        .filter_map(|line| line.strip_suffix(": test"));
    let names: Vec<String> = names.map(str::to_owned).collect();
    let log = root().join(format!("target/exercises-{}.log", std::process::id()));
    let log_name = log.display().to_string();
    let mut all = Report {
        tests: Vec::new(),
        messages: HashMap::new(),
    };
    for (exercise, _) in EXERCISES {
        let filter = format!("{exercise}::");
        let own = names.iter().filter(|name| name.starts_with(&filter));
        let own: Vec<String> = own.cloned().collect();
        let text = fs::read_to_string(source(exercise)).unwrap_or_default();
        // What is no Rust does not compile, and never comes here.
        if let Some(word) = forbidden(text.parse().unwrap_or_default()) {
            let file = format!("teaching/exercises/src/{exercise}.rs");
            all.fail(
                &own,
                &format!("{file} names `{word}`: no exercise needs it, so its tests do not run"),
            );
            continue;
        }
        let arguments = [filter.as_str(), "--color", "never", "--logfile", &log_name];
        let output = test_program(&arguments).output().context(NO_CARGO)?;
        let written = fs::read_to_string(&log).unwrap_or_default();
        let _ = fs::remove_file(&log);
        let report = Report::read(&String::from_utf8_lossy(&output.stdout));
        let is_success = output.status.success();
        match report.and_then(|report| report.with_log(&written, &own, is_success)) {
            Some(report) => {
                all.tests.extend(report.tests);
                all.messages.extend(report.messages);
            }
            None => all.fail(
                &own,
                "the test program ended before its tests: does the code end the process, or call itself without end?",
            ),
        }
    }
    Ok(Some(all))
}

/// The command.
///
/// # Errors
/// If cargo is missing, the tests do not run, or, with `--solutions`, the check fails.
pub fn exercises(args: Exercises) -> anyhow::Result<()> {
    if args.solutions {
        return check(Lints::Allowed);
    }
    loop {
        let saved = last_save();
        let report = run_tests()?;
        match (&report, args.json) {
            (_, true) => println!("{}", Report::json(report.as_ref())),
            (Some(report), false) => report.print(args.plan),
            (None, false) if args.watch => println!("\nThe tests did not run: see above"),
            (None, false) => bail!("the tests did not run: see above"),
        }
        if !args.watch {
            return Ok(());
        }
        println!("\nWaiting for a save in teaching/exercises/src; Ctrl-C ends it");
        while last_save() == saved {
            sleep(Duration::from_millis(300));
        }
    }
}

/// Time of the latest change of a student's file.
fn last_save() -> Option<SystemTime> {
    let saved = |(exercise, _)| fs::metadata(source(exercise)).ok()?.modified().ok();
    EXERCISES.into_iter().filter_map(saved).max()
}

/// Packages outside of `default-members`, except the exercises. With the same packages as in the native tests every
/// crate has the same features, and is not compiled again.
const EXCLUDED_PACKAGES: [&str; 7] = [
    "solver_peers",
    "slam2d_py",
    "web_bindgen",
    "slam_desktop",
    "slam_web_module",
    "slam_robot_module",
    "slam2d_bench_module",
];

/// Whether lints are errors, as in the suite, in which crates are compiled as for the native tests.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Lints {
    /// For a student's code.
    Allowed,
    /// For ours.
    Denied,
}

/// The command of the tests named `exercises`: those of the exercises and of `ch16 lap --exercises`.
fn all_tests(features: &str, lints: Lints) -> anyhow::Result<Command> {
    let mut tests = cargo();
    if lints == Lints::Denied {
        linting(&mut tests)?;
    }
    tests
        .args([
            "test",
            "--workspace",
            "--test",
            "exercises",
            "--no-fail-fast",
        ])
        .args(
            EXCLUDED_PACKAGES
                .iter()
                .flat_map(|package| ["--exclude", package]),
        )
        .args(["--features", features])
        .env("RUST_BACKTRACE", "0");
    Ok(tests)
}

/// Checks that the solutions pass and drive a lap, and that every test of an unwritten exercise fails.
///
/// # Errors
/// The first check that fails.
pub fn check(lints: Lints) -> anyhow::Result<()> {
    let solved = "exercises/solutions,ch16/exercise_solutions";
    run(
        "Solutions of the exercises",
        all_tests(solved, lints)?.arg("--quiet"),
    )?;
    println!("\n── Exercises as they are");
    let output = all_tests("ch16/exercises", lints)?
        .stderr(Stdio::piped())
        .output();
    let output = output.context("cargo cannot be started")?;
    let report = Report::read(&String::from_utf8_lossy(&output.stdout));
    let report = report.with_context(|| String::from_utf8_lossy(&output.stderr).into_owned())?;
    for (exercise, _) in EXERCISES.iter().filter(|(name, _)| is_untouched(name)) {
        let (passed, all) = report.passed(exercise);
        ensure!(all > 0, "{exercise} has no test");
        ensure!(
            passed == 0,
            "{passed} tests of {exercise} pass, but it is not written"
        );
    }
    // Tests of the command are in no module.
    let of_command = report.tests.iter().filter(|(name, _)| !name.contains("::"));
    for (name, passed) in of_command {
        ensure!(*passed, "ch16 lap --exercises: {name} fails");
    }
    let written = EXERCISES.iter().filter(|(name, _)| !is_untouched(name));
    println!(
        "── {} written, and no test of the others passes",
        written.count()
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRINTED: &str = "running 3 tests
test residual::a ... ok
test svd_align::b ... FAILED
test svd_align::c ... ok

failures:

---- svd_align::b stdout ----

thread 'svd_align::b' (7) panicked at teaching/exercises/tests/svd_align.rs:3:5:
off by 2
note: run with `RUST_BACKTRACE=1`


failures:
    svd_align::b

test result: FAILED. 2 passed; 1 failed
";

    #[test]
    fn the_output_of_libtest_is_parsed() {
        let report = Report::read(PRINTED).unwrap();
        assert_eq!(report.passed("svd_align"), (1, 2));
        assert_eq!(report.state("residual"), State::Passes);
        assert_ne!(report.state("svd_align"), State::Passes);
        assert_ne!(
            report.state("gauss_newton"),
            State::Passes,
            "it has no test"
        );
        let message = &report.messages["svd_align::b"];
        assert_eq!(
            message,
            "teaching/exercises/tests/svd_align.rs:3:5:\noff by 2"
        );
        let aborted = PRINTED.split("failures:").next().unwrap();
        assert!(Report::read(aborted).is_none());
    }

    #[test]
    fn printed_lines_earn_nothing() {
        let names = ["residual::a", "svd_align::b", "svd_align::c"].map(str::to_owned);
        let log = "ok residual::a\nfailed svd_align::b\nok svd_align::c\n";
        let read = |printed: &str, log: &str, is_success| {
            Report::read(printed)?.with_log(log, &names, is_success)
        };
        let forged = PRINTED.replace("svd_align::b ... FAILED", "svd_align::b ... ok");
        let report = read(&forged, log, false).unwrap();
        assert_eq!(report.passed("svd_align"), (1, 2));
        for (log, is_success) in [
            (log, true),
            ("ok residual::a\nok svd_align::c\n", true),
            (
                "ok residual::a\nok svd_align::b\nok svd_align::b\nok svd_align::c\n",
                true,
            ),
        ] {
            assert!(
                read(PRINTED, log, is_success).is_none(),
                "{log} {is_success}"
            );
        }
    }

    #[test]
    fn what_waits_for_another_exercise_is_not_the_next_one() {
        let printed = PRINTED.replace(
            "off by 2",
            "residual is not written yet: its task is elsewhere",
        );
        let report = Report::read(&printed).unwrap();
        assert_eq!(report.waits_for("svd_align"), Some("residual"));
        assert_eq!(Report::read(PRINTED).unwrap().waits_for("svd_align"), None);
        let mut lab = Plan::Lab.order();
        assert_eq!(EXERCISES[lab[1]].0, "trimmed_icp");
        lab.sort_unstable();
        assert_eq!(lab, Plan::List.order());
    }

    #[test]
    fn a_file_may_not_reach_for_the_process_or_for_files() {
        for (source, word) in [
            ("fn f() { std::process::exit(0) }", Some("process")),
            ("use std::{r#fs as files, mem};", Some("fs")),
            ("use std as s; fn f() { s::env::args(); }", Some("env")),
            (
                "let a = ('\"', r\"\\\", \"//\"); unsafe { f() }",
                Some("unsafe"),
            ),
            (
                "macro_rules! m { () => { include!(\"x\") } }",
                Some("include"),
            ),
            ("# [ path = \"x.rs\" ] mod x;", Some("path")),
            (
                "// The process of a net\nlet path = [path, \"process\"]; /* env */",
                None,
            ),
        ] {
            assert_eq!(forbidden(source.parse().unwrap()), word, "{source}");
        }
        for folder in ["src", "solutions/src"] {
            for file in fs::read_dir(root().join("teaching/exercises").join(folder)).unwrap() {
                let path = file.unwrap().path();
                let text = fs::read_to_string(&path).unwrap();
                assert_eq!(forbidden(text.parse().unwrap()), None, "{}", path.display());
            }
        }
    }

    #[test]
    fn an_exercise_that_ends_its_process_fails_alone() {
        let mut report = Report::read(PRINTED).unwrap();
        report.fail(&["trimmed_icp::a".to_owned()], "it ended");
        assert_eq!(report.state("residual"), State::Passes);
        assert_ne!(report.state("trimmed_icp"), State::Passes);
        assert_eq!(report.messages["trimmed_icp::a"], "it ended");
    }

    #[test]
    fn the_json_names_every_exercise_and_reports_if_no_test_ran() {
        let json = Report::json(Report::read(PRINTED).as_ref());
        assert!(
            json.starts_with(r#"{"schema":1,"ran":true,"passed":1,"total":7,"#),
            "{json}"
        );
        let residual =
            r#"{"name":"residual","state":"passes","tests":[{"name":"a","passed":true}]}"#;
        assert!(json.contains(residual), "{json}");
        assert!(EXERCISES.iter().all(|(name, _)| json.contains(name)));
        let none = r#"{"schema":1,"ran":false,"passed":0,"total":7,"exercises":[]}"#;
        assert_eq!(Report::json(None), none);
    }

    #[test]
    fn every_exercise_has_its_file_and_its_tests() {
        let main = fs::read_to_string(root().join("teaching/exercises/tests/main.rs")).unwrap();
        for (name, _) in EXERCISES {
            assert!(source(name).is_file(), "{name}");
            assert!(main.contains(&format!("mod {name};")), "{name}");
        }
        let files = fs::read_dir(root().join("teaching/exercises/src"))
            .unwrap()
            .count();
        assert_eq!(files, EXERCISES.len() + 1, "lib.rs and the exercises");
    }
}
