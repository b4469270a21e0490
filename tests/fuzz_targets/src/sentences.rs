//! Invariants of every error message.

/// File name of the input.
pub const NAME: &str = "it.file";
/// Longest message: it may list twenty topics of a recording with their types.
const MAX_BYTES: usize = 3000;

/// Asserts that an error is one line that starts with the file name.
pub fn assert_refusal(said: &str) {
    assert!(said.starts_with(NAME), "{said:?}");
    assert_sentence(said);
}

/// Asserts that a message can be printed on one line.
pub fn assert_sentence(said: &str) {
    assert!((10..MAX_BYTES).contains(&said.len()), "{said:?}");
    assert!(!said.contains(char::is_control), "{said:?}");
}
