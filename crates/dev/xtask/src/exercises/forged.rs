//! Forgeries of a mark: functions that try to pass by other means than by what they compute.

use anyhow::{Context as _, ensure};

use super::list::EXERCISES;
use super::test_run::{Code, Lints, run_tests};

/// Number of tests that a forgery passes by what it computes, or `None` for the honest function among them, and a part of
/// the message of each other test.
const EARNED: [(Option<usize>, &str); EXERCISES.len()] = [
    (Some(0), "svd_align.rs names `process`"),
    (Some(2), "point_to_plane_step.rs"),
    (None, ""),
    (Some(0), "the test program ended before its tests"),
    (Some(0), "verify_loop.rs names `mod …;`"),
    (Some(0), ""),
    (
        Some(0),
        "range_histogram.rs names `a text that is not Rust`",
    ),
];

/// Checks that each forgery of `teaching/exercises/forged` is marked by what it computes, and hides no other exercise.
///
/// # Errors
/// The first forgery that earns more or less.
pub fn check(lints: Lints) -> anyhow::Result<()> {
    println!("\n── Forged marks of the exercises");
    let report = run_tests(Code::Forged, lints)?.context("the forgeries do not compile")?;
    for ((exercise, _), (earned, why)) in EXERCISES.into_iter().zip(EARNED) {
        let (passed, all) = report.passed(exercise);
        ensure!(all > 0, "{exercise} has no test");
        ensure!(
            passed == earned.unwrap_or(all),
            "the forged {exercise} passes {passed} of {all} tests"
        );
        let tests = report.tests.iter();
        let failed = tests.filter(|(name, passed)| name.starts_with(exercise) && !passed);
        for (name, _) in failed {
            let message = report.messages.get(name).map_or("", String::as_str);
            ensure!(message.contains(why), "{name} fails with {message:?}");
        }
    }
    println!("── each is marked by what it computes");
    Ok(())
}
