//! The words of a table's rows, and the numbers in them.

/// The words of a row, without quotes and outer brackets: empty ones count between commas, not between spaces. A comma
/// beside semicolons or tabs is the decimal sign. A list in quotes or brackets is one word.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    let text = unwrapped(text.trim());
    let is_outside = outside_of_lists(text);
    let separates = |c: char| text.match_indices(c).any(|(at, _)| is_outside[at]);
    let separator = ['\t', ';', ','].into_iter().find(|c| separates(*c));
    let wanted = separator.unwrap_or(' ');
    let mut at = 0;
    text.split(move |c: char| {
        let is_end = c == wanted && is_outside[at];
        at += c.len_utf8();
        is_end
    })
    .map(|word| word.trim_matches([' ', '"', '\'', '[', ']', '(', ')']))
    .filter(move |word| separator.is_some() || !word.is_empty())
}

/// A row without the brackets around all of it, as Python prints a tuple.
fn unwrapped(text: &str) -> &str {
    let inner = text.strip_prefix(['(', '[']);
    let inner = inner.and_then(|inner| inner.strip_suffix([')', ']']));
    // Otherwise these are the brackets of two lists, or of a list of lists.
    let is_one = |inner: &&str| {
        let mut depth = 0_i32;
        !inner.starts_with(['(', '['])
            && inner.bytes().all(|byte| {
                depth += i32::from(b"([".contains(&byte)) - i32::from(b")]".contains(&byte));
                depth >= 0
            })
    };
    inner.filter(is_one).unwrap_or(text)
}

/// For each byte, whether it is outside of quotes and brackets; all are if one of them is not closed.
fn outside_of_lists(text: &str) -> Vec<bool> {
    let (mut depth, mut is_quoted, mut is_balanced) = (0_usize, false, true);
    let mut outside = Vec::with_capacity(text.len());
    for byte in text.bytes() {
        match byte {
            b'"' => is_quoted = !is_quoted,
            b'[' | b'(' if !is_quoted => depth += 1,
            b']' | b')' if !is_quoted => {
                is_balanced &= depth > 0;
                depth = depth.saturating_sub(1);
            }
            _ => {}
        }
        outside.push(depth == 0 && !is_quoted);
    }
    if depth > 0 || is_quoted || !is_balanced {
        outside.fill(true);
    }
    outside
}

/// The items of a word: one, or those of a list such as `[1.5, 1.6]`, `(1.5 1.6)` or `array('f', [1.5, 1.6])`.
pub fn list(word: &str) -> impl Iterator<Item = &str> {
    let is_one = number(word).is_some();
    let inner = word.rsplit(['[', '(']).next().unwrap_or(word);
    let separator = [';', ',']
        .into_iter()
        .find(|c| !is_one && inner.contains(*c));
    let wanted = separator.unwrap_or(' ');
    inner
        .split(wanted)
        .map(|item| item.trim_matches([' ', '"', '\'', ']', ')']))
        .filter(move |item| is_one || separator.is_some() || !item.is_empty())
}

/// Whether an item of a list stands for a reading that is missing.
pub fn is_missing(item: &str) -> bool {
    let item = item.trim_start_matches(['#', '-']).trim_end_matches('-');
    let words = ["", "none", "null", "nil", "na", "n/a", "<na>"];
    words.iter().any(|word| item.eq_ignore_ascii_case(word))
}

/// The number of a word, with a point or a comma before its decimals.
pub fn number(word: &str) -> Option<f64> {
    let number = word.parse().ok();
    number.or_else(|| word.replacen(',', ".", 1).parse().ok())
}
