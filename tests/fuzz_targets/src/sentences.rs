//! Guarantees of every error message.

/// A file name for the input.
pub const NAME: &str = "it.file";
/// A recording's topics are listed, up to twenty with their types.
const MOST_BYTES: usize = 3000;

/// An error message is one line that begins with the file's name.
pub fn assert_refusal(said: &str) {
    assert!(said.starts_with(NAME), "{said:?}");
    assert_sentence(said);
}

/// A message can be printed on one line.
pub fn assert_sentence(said: &str) {
    assert!((10..MOST_BYTES).contains(&said.len()), "{said:?}");
    assert!(!said.contains(char::is_control), "{said:?}");
}
