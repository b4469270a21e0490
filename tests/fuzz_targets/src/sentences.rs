//! Invariants of every error message.

/// File name of the input.
pub const NAME: &str = "it.file";
/// Longest message: it may list twenty topics of a recording with their types.
const MAX_BYTES: usize = 3000;

/// Asserts that an error is one line that starts with the file name.
pub fn assert_rejection(text: &str) {
    assert!(text.starts_with(NAME), "{text:?}");
    assert_sentence(text);
}

/// Asserts that a message can be printed on one line.
pub fn assert_sentence(text: &str) {
    assert!((10..MAX_BYTES).contains(&text.len()), "{text:?}");
    assert!(!text.contains(char::is_control), "{text:?}");
}
