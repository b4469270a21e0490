//! Runs a command in its own tests.

use std::process::{Command, Output};

use serde_json::Value;

/// Defines, for the program that cargo built at this path: a function of this name, which runs it to its end; `json`;
/// and `assert_rejected`.
#[macro_export]
macro_rules! program_under_test {
    ($name:ident, $path:expr) => {
        /// Runs the program to its end.
        pub fn $name(arguments: &[&str]) -> std::process::Output {
            $crate::program::run($path, arguments)
        }

        /// What the program prints, as one JSON value.
        #[track_caller]
        pub fn json(arguments: &[&str]) -> serde_json::Value {
            $crate::program::json($path, arguments)
        }

        /// Asserts exit code 2, empty standard output, and one line on standard error that contains `expected`.
        #[track_caller]
        pub fn assert_rejected(arguments: &[&str], expected: &str) {
            $crate::program::assert_rejected($path, arguments, expected);
        }
    };
}

/// Runs a program to its end.
///
/// # Panics
/// If it is not there.
#[must_use]
pub fn run(program: &str, arguments: &[&str]) -> Output {
    let output = Command::new(program).args(arguments).output();
    output.expect("the binary was built for this test")
}

/// What a program prints, as one JSON value.
///
/// # Panics
/// If it fails or prints anything else.
#[must_use]
#[track_caller]
pub fn json(program: &str, arguments: &[&str]) -> Value {
    let output = run(program, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).expect("one JSON value")
}

/// Asserts exit code 2, empty standard output, and one line on standard error that contains `expected`.
///
/// # Panics
/// If anything of this differs.
#[track_caller]
pub fn assert_rejected(program: &str, arguments: &[&str], expected: &str) {
    let output = run(program, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(message.lines().count(), 1, "{arguments:?}: {message}");
    assert!(message.contains(expected), "{arguments:?}: {message}");
}
