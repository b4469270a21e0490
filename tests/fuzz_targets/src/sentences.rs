//! What every refusal promises.

/// A name for what comes in, as a reader's file has one.
pub const NAME: &str = "it.file";
/// A recording's topics are listed, twenty of them with their types.
const MOST_BYTES: usize = 3000;

/// A refusal is one line of words that begins with the file's name.
pub fn assert_refusal(said: &str) {
    assert!(said.starts_with(NAME), "{said:?}");
    assert_sentence(said);
}

/// What is said can be printed on one line.
pub fn assert_sentence(said: &str) {
    assert!((10..MOST_BYTES).contains(&said.len()), "{said:?}");
    assert!(!said.contains(char::is_control), "{said:?}");
}
