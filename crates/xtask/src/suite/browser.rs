//! The site in Chromium.

use std::path::Path;

use super::skipped::SkipList;
use super::test_files;
use crate::run::{Failure, program, root, show};

/// Runs the browser tests: all files, or those that are named, such as `drag`. There is no second
/// attempt.
///
/// # Errors
/// Where a test fails.
pub fn run(chromium: &Path, only: &[String], skipped: Option<&SkipList>) -> Result<(), Failure> {
    let node = |words: &[&str]| {
        let mut node = program("node");
        node.args(words).env("CHROMIUM", chromium);
        if let Some(skipped) = skipped {
            skipped.told_to(&mut node);
        }
        node
    };
    if root().join("tests/browser/run.mjs").is_file() {
        let mut words = vec!["tests/browser/run.mjs"];
        let names = only.join(",");
        if !only.is_empty() {
            words.extend(["--only", names.as_str()]);
        }
        return show("Browser tests", &mut node(&words));
    }
    for file in test_files("tests/browser")? {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let is_named = |wanted: &String| name.strip_suffix(".test.mjs") == Some(wanted);
        if only.is_empty() || only.iter().any(is_named) {
            let words = ["--test", &file.to_string_lossy()];
            show(&format!("Browser tests: {name}"), &mut node(&words))?;
        }
    }
    Ok(())
}
