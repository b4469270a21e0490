//! What the tests of the exercises gave, for a student and for a grader.

use std::collections::HashMap;
use std::fmt;

use super::list::{EXERCISES, Plan, is_untouched};

/// State of an exercise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
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
pub struct Report {
    /// Names as `exercise::test`, in the order of the run, and whether each passed.
    pub tests: Vec<(String, bool)>,
    /// The first message of each test that failed.
    pub messages: HashMap<String, String>,
}

impl Report {
    /// The results in the log that libtest writes itself, because a student's code can print lines like its own; `None`
    /// unless the log names each of the `expected` tests once and agrees with the end of the process.
    pub fn with_log(self, log: &str, expected: &[String], is_success: bool) -> Option<Self> {
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
    pub fn read(printed: &str) -> Option<Self> {
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
    pub fn fail(&mut self, names: &[String], message: &str) {
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
    pub fn print(&self, plan: Plan) {
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
    pub fn passed(&self, exercise: &str) -> (usize, usize) {
        let tests = self.of(exercise);
        (
            tests.clone().filter(|(_, passed)| *passed).count(),
            tests.count(),
        )
    }

    /// The JSON for a grader. Names are identifiers of Rust, so they need no escapes.
    pub fn json(report: Option<&Self>) -> String {
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
}
