//! The reference values, and functions to read and compare them.
//!
//! The JSON files in `reference/` were computed by an independent implementation of the same system; the code
//! contains no copies of them.

use std::fs;
use std::path::Path;

use serde::de::DeserializeOwned;

/// The cases of one reference file, for example `reference::<Vec<Case>>("rng.json")`.
///
/// # Panics
/// If the file is missing or lacks the fields of `T`: a fault of the suite itself.
#[must_use]
pub fn reference<T: DeserializeOwned>(file: &str) -> T {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("reference")
        .join(file);
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Asserts |actual − expected| ≤ tolerance; a NaN on either side fails.
///
/// # Panics
/// If they differ by more.
#[track_caller]
pub fn assert_close(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let difference = (actual - expected).abs();
    assert!(
        difference <= tolerance,
        "{what}: {actual} differs from {expected} by {difference:e}, more than {tolerance:e}"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "differs")]
    fn a_difference_of_either_sign_fails() {
        assert_close("x", -1.0, 1.0, 0.1);
    }

    #[test]
    #[should_panic(expected = "differs")]
    fn not_a_number_fails() {
        assert_close("x", f64::NAN, 1.0, 0.1);
    }
}
