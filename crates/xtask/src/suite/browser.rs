//! The site in Chromium.

use std::path::Path;

use super::native::Tools;
use super::skipped::SkipList;
use crate::run::{Failure, program, show};

/// Runs the browser tests: all files, or those that are named, such as `drag`. There is no second
/// attempt.
///
/// # Errors
/// Where a test fails.
pub fn run(chromium: &Path, only: &[String], skipped: Option<&SkipList>) -> Result<(), Failure> {
    let mut node = program("node");
    node.arg("tests/browser/run.mjs").env("CHROMIUM", chromium);
    let tools = Tools::BesideTests;
    // The pieces before have compiled it; without them the test that needs it does.
    if tools.path("slam2d").exists() {
        node.env("SLAM_NATIVE", tools.folder());
    }
    if !only.is_empty() {
        node.args(["--only", &only.join(",")]);
    }
    if let Some(skipped) = skipped {
        skipped.told_to(&mut node);
    }
    show("Browser tests", &mut node)
}
