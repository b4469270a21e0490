//! The length of the pages without their exercises, notation and references.

use super::document::{companion, source};

/// Largest number of words, folded text included; a formula counts as one word, code as none.
const MAX_WORDS: usize = 9_400;
/// Largest number of words outside of folded text.
const MAX_SEEN_WORDS: usize = 5_750;

/// The same for the chapter's page alone.
const MAX_CHAPTER_WORDS: usize = 6_500;
const MAX_SEEN_CHAPTER_WORDS: usize = 4_000;

/// The source between two positions without the elements in `dropped`, including nested ones.
fn without(html: &str, dropped: &str) -> String {
    let close = format!("</{dropped}>");
    // `<tex` also begins the `<text>` of a drawing.
    let opens = |text: &str| {
        let tags = [format!("<{dropped}>"), format!("<{dropped} ")];
        let mut places: Vec<usize> = tags
            .iter()
            .flat_map(|tag| text.match_indices(tag.as_str()).map(|(at, _)| at))
            .collect();
        places.sort_unstable();
        places
    };
    let mut kept = String::new();
    let mut rest = html;
    while let Some(&start) = opens(rest).first() {
        kept.push_str(&rest[..start]);
        let (mut end, mut depth) = (start + 1, 1);
        while depth > 0 {
            let closed = end + rest[end..].find(&close).expect("it is closed");
            depth += opens(&rest[end..closed]).len();
            depth -= 1;
            end = closed + close.len();
        }
        rest = &rest[end..];
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
    // A table of symbols is looked up, not read.
    let (text, rest) = before
        .split_once("<section id=\"notation\">")
        .expect("the notation");
    let (_, rest) = rest.split_once("</section>").expect("its end");
    let before = without(&format!("{text}{rest}"), "article");

    let formulas_as_words = before.replace("<tex", " formula <tex");
    let before = without(&formulas_as_words, "tex");
    let (all, seen) = (words(&before), words(&without(&before, "details")));
    println!("{all} words without the exercises, {seen} of them unfolded");
    assert!(all <= MAX_WORDS, "{all} words");
    assert!(seen <= MAX_SEEN_WORDS, "{seen} words unfolded");
    let chapter = without(&source("index.html"), "article");
    let chapter = without(&chapter.replace("<tex", " formula <tex"), "tex");
    let (all, seen) = (words(&chapter), words(&without(&chapter, "details")));
    println!("{all} words of the chapter, {seen} of them unfolded");
    assert!(all <= MAX_CHAPTER_WORDS, "{all} words in the chapter");
    assert!(
        seen <= MAX_SEEN_CHAPTER_WORDS,
        "{seen} words in the chapter unfolded"
    );
    let counted = words("<p>A <b>bold</b> word, 0.24&nbsp;m – and <i>one</i></p><p>more.</p>");
    assert_eq!(counted, 8);
}

/// Words that a screen holds beside a widget.
const SCREEN_WORDS: usize = 200;
/// Largest number of figures on a screen.
const MAX_NUMBERS: usize = 10;

/// The parts of a text that are seen at once: what is unfolded in windows of a screen, and each fold.
fn screens(html: &str) -> Vec<String> {
    let mut screens: Vec<String> = Vec::new();
    let folds = html.split("<details").skip(1);
    screens.extend(folds.map(|fold| {
        fold.split("</details>")
            .next()
            .unwrap_or_default()
            .to_owned()
    }));
    let seen = without(html, "details");
    let blocks: Vec<&str> = seen.split_inclusive("</p>").collect();
    for start in 0..blocks.len() {
        let mut screen = String::new();
        for block in &blocks[start..] {
            if !screen.is_empty() && words(&screen) + words(block) > SCREEN_WORDS {
                break;
            }
            screen.push_str(block);
        }
        screens.push(screen);
    }
    screens
}

#[test]
fn no_screen_of_the_limits_or_of_an_exercise_has_more_than_ten_numbers() {
    let pages = companion();
    let limits = pages
        .split("<section id=\"limits\">")
        .nth(1)
        .expect("the section");
    let limits = without(
        limits.split("</section>").next().expect("its end"),
        "article",
    );
    let articles = pages.split("<article class=\"exercise\"").skip(1);
    let exercises = articles.map(|text| text.split("</article>").next().unwrap_or_default());
    let mut crowded = Vec::new();
    for text in exercises.chain([limits.as_str()]) {
        for screen in screens(text) {
            let numbers = screen.matches("data-figure=").count() + screen.matches("\\fig{").count();
            if numbers > MAX_NUMBERS {
                let start: String = screen.chars().take(300).collect();
                crowded.push(format!("{numbers} numbers: {start}"));
            }
        }
    }
    assert!(crowded.is_empty(), "{}", crowded.join("\n\n"));
    let eleven = "<p><span data-figure=\"a\">1</span></p>".repeat(11);
    assert_eq!(screens(&eleven)[0].matches("data-figure=").count(), 11);
}
