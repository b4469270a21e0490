//! Runs the command in tests.

use std::process::{Command, Output};

use serde_json::Value;

/// Runs the command to its end.
pub fn slam2d(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slam2d"))
        .args(arguments)
        .output()
        .expect("the binary was built for this test")
}

/// What the command prints, as one JSON value.
pub fn json(arguments: &[&str]) -> Value {
    let output = slam2d(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).expect("one JSON value")
}

/// Asserts exit code 2, empty standard output, and one line on standard error that contains `expected`.
#[track_caller]
pub fn assert_rejected(arguments: &[&str], expected: &str) {
    let output = slam2d(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(message.lines().count(), 1, "{arguments:?}: {message}");
    assert!(message.contains(expected), "{arguments:?}: {message}");
}
