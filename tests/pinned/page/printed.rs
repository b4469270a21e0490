//! Prints a value like the text: in digits, as a number word, or as a rough ratio in words.

const CARDINALS: [(&str, f64); 17] = [
    ("none", 0.0),
    ("one", 1.0),
    ("two", 2.0),
    ("three", 3.0),
    ("four", 4.0),
    ("five", 5.0),
    ("six", 6.0),
    ("seven", 7.0),
    ("eight", 8.0),
    ("nine", 9.0),
    ("ten", 10.0),
    ("eleven", 11.0),
    ("twelve", 12.0),
    ("twenty", 20.0),
    ("hundred", 100.0),
    ("thousand", 1000.0),
    ("million", 1e6),
];
const ORDINALS: [&str; 6] = ["zeroth", "first", "second", "third", "fourth", "fifth"];
const RATIOS: [(&str, f64); 10] = [
    ("half", 0.5),
    ("a third", 1.0 / 3.0),
    ("a quarter", 0.25),
    ("a fifth", 0.2),
    ("a tenth", 0.1),
    ("double", 2.0),
    ("doubles", 2.0),
    ("twofold", 2.0),
    ("threefold", 3.0),
    ("fourfold", 4.0),
];
/// Relative tolerance of a ratio in words: “a third” stands for 0.32 to 0.35.
const ROUGHLY: f64 = 0.05;

/// Words that count or measure. One and two, first and second are missing, because they are references (“the
/// first one”, “the two ends”) far more often than counts.
const MEASURING: [&str; 31] = [
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
    "twenty",
    "thirty",
    "forty",
    "fifty",
    "dozen",
    "hundred",
    "hundreds",
    "thousand",
    "thousands",
    "million",
    "half",
    "third",
    "thirds",
    "quarter",
    "quarters",
    "fourth",
    "fifth",
    "tenth",
    "double",
    "doubles",
    "twice",
];
/// Names of false minima, which are not numbers.
const NAMES: [&str; 2] = ["quarter turn", "half turn"];

/// Checks whether `text` prints `value`; commas between thousands are optional.
///
/// # Errors
/// The value in the form of the text.
pub fn check(text: &str, value: f64) -> Result<(), String> {
    let text = words_of(text).replace(',', "");
    let (relation, amount) = match text.split_once(" than ") {
        Some((relation, amount)) => (relation, amount),
        None => ("", text.as_str()),
    };
    if let Some(ratio) = ratio(amount) {
        let fits = match relation {
            "less" => value < ratio,
            "more" => value > ratio,
            _ => (value / ratio - 1.0).abs() <= ROUGHLY,
        };
        return if fits { Ok(()) } else { Err(value.to_string()) };
    }
    let printed = in_words(&text, value).unwrap_or_else(|| in_digits(&text, value));
    if printed == text {
        Ok(())
    } else {
        Err(printed)
    }
}

/// Whether a text contains a number in digits or words.
pub fn measures(text: &str) -> bool {
    let mut text = words_of(text);
    for name in NAMES {
        text = text.replace(name, "");
    }
    let is_number = |word: &str| MEASURING.contains(&word) || word.ends_with("fold");
    text.contains(|c: char| c.is_ascii_digit())
        || text.split(|c: char| !c.is_alphabetic()).any(is_number)
}

/// In lower case, without a plus sign, with single blanks and a minus that parses.
fn words_of(text: &str) -> String {
    let text = text.replace('\u{2212}', "-").to_lowercase();
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").trim_start_matches('+').to_owned()
}

/// “a third”, “fourfold”; “one true closure in twenty” is 1/20.
fn ratio(text: &str) -> Option<f64> {
    let known = RATIOS.iter().find(|(word, _)| *word == text);
    let in_many = || {
        let (_, many) = text.strip_prefix("one ")?.rsplit_once("in ")?;
        let (_, count) = CARDINALS.iter().find(|(word, _)| *word == many)?;
        Some(1.0 / count)
    };
    known.map(|(_, ratio)| *ratio).or_else(in_many)
}

/// A value in the series of number words to which `text` belongs; `None` if it is not such a word.
fn in_words(text: &str, value: f64) -> Option<String> {
    let (article, bare) = match text.strip_prefix("a ") {
        Some(bare) => ("a ", bare),
        None => ("", text),
    };
    let word = if CARDINALS.iter().any(|(word, _)| *word == bare) {
        let said = CARDINALS.iter().find(|(_, count)| *count == value);
        said.map(|(word, _)| format!("{article}{word}"))
    } else if ORDINALS.contains(&text) {
        let place = (value.fract() == 0.0).then_some(value as usize);
        place
            .and_then(|place| ORDINALS.get(place))
            .map(ToString::to_string)
    } else {
        return None;
    };
    Some(word.unwrap_or_else(|| value.to_string()))
}

/// A value with as many decimals as `text` has.
fn in_digits(text: &str, value: f64) -> String {
    let decimals = text
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    let printed = format!("{value:.decimals$}");
    // A value that rounds to zero has no sign.
    match printed.strip_prefix('-') {
        Some(digits) if digits.contains(|c: char| ('1'..='9').contains(&c)) => printed,
        Some(digits) => digits.to_owned(),
        None => printed,
    }
}

#[test]
fn a_figure_that_is_off_by_one_in_the_last_digit_would_be_found() {
    assert_eq!(check("4.236", 4.235_830_998), Ok(()));
    assert_eq!(check("4.235", 4.235_830_998), Err("4.236".to_owned()));
    assert_eq!(check("\u{2212}39", -39.0), Ok(()));
    assert_eq!(check("0", -1e-17), Ok(()));
    assert_eq!(check("Three", 3.0), Ok(()));
    assert_eq!(check("three", 2.0), Err("two".to_owned()));
    assert_eq!(check("fourth", 4.0), Ok(()));
    assert_eq!(check("a thousand", 1000.0), Ok(()));
    assert_eq!(check("a thousand", 999.0), Err("999".to_owned()));
}

#[test]
fn a_ratio_in_words_holds_to_a_twentieth_and_a_bound_holds_strictly() {
    assert_eq!(check("a third", 0.326), Ok(()));
    assert!(check("a third", 0.3).is_err());
    assert_eq!(check("fourfold", 3.95), Ok(()));
    assert!(check("fourfold", 3.7).is_err());
    assert_eq!(check("less than a third", 0.33), Ok(()));
    assert!(check("less than a third", 0.34).is_err());
    assert!(check("more than half", 0.5).is_err());
    assert_eq!(check("one true closure\n in twenty", 0.05), Ok(()));
    assert!(check("one true closure in twenty", 0.1).is_err());
}

#[test]
fn a_number_is_seen_in_digits_and_in_words() {
    for text in [
        "0.24 m",
        "falls to a third",
        "grows fourfold",
        "one in twenty",
        "A thousand",
    ] {
        assert!(measures(text), "{text}");
    }
    for text in [
        "the quarter\nturn",
        "a half turn",
        "the first one",
        "no number",
    ] {
        assert!(!measures(text), "{text}");
    }
}
