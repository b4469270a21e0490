//! The length of the pages without their exercises and references.

use super::document::companion;

/// Largest number of words, folded text included; a formula counts as one word, code as none.
const MAX_WORDS: usize = 7_000;
/// Largest number of words outside of folded text.
const MAX_SEEN_WORDS: usize = 5_300;

/// The source between two positions without the elements in `dropped`, including nested ones.
fn without(html: &str, dropped: &str) -> String {
    let (open, close) = (format!("<{dropped}"), format!("</{dropped}>"));
    let mut kept = String::new();
    let mut rest = html;
    while let Some(start) = rest.find(&open) {
        kept.push_str(&rest[..start]);
        let end = rest[start..].find(&close).expect("it is closed");
        rest = &rest[start + end + close.len()..];
    }
    kept + rest
}

fn words(html: &str) -> usize {
    let mut text = String::new();
    let mut rest = html;
    while let Some(start) = rest.find('<') {
        text.push_str(&rest[..start]);
        let end = start + rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..end];
        // Inline tags do not end a word.
        if ![
            "span", "/span", "em", "/em", "b", "/b", "i", "/i", "small", "/small",
        ]
        .contains(&tag.split(' ').next().unwrap_or_default())
        {
            text.push(' ');
        }
        rest = &rest[end + 1..];
    }
    text.push_str(rest);
    let text = text.replace("&nbsp;", " ");
    text.split_whitespace()
        .filter(|word| word.contains(char::is_alphanumeric))
        .count()
}

#[test]
fn the_pages_are_short_without_their_exercises() {
    let pages = companion();
    let (before, _) = pages
        .split_once("<section id=\"references\">")
        .expect("the references");
    let before = without(before, "article");
    let formulas_as_words = before.replace("<tex", " formula <tex");
    let before = without(&formulas_as_words, "tex");
    let (all, seen) = (words(&before), words(&without(&before, "details")));
    println!("{all} words without the exercises, {seen} of them unfolded");
    assert!(all <= MAX_WORDS, "{all} words");
    assert!(seen <= MAX_SEEN_WORDS, "{seen} words unfolded");
    let counted = words("<p>A <b>bold</b> word, 0.24&nbsp;m – and <i>one</i></p><p>more.</p>");
    assert_eq!(counted, 8);
}
