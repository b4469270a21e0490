//! The symbols of the formulas: each has its line in the table of the notation.

use std::collections::BTreeSet;

use super::document::{companion, source};

/// Commands that are symbols with a meaning; all others are operators, brackets, accents and layout.
const GREEK: [&str; 14] = [
    "theta", "omega", "tau", "sigma", "mu", "chi", "delta", "xi", "kappa", "rho", "ell", "Omega",
    "Sigma", "Delta",
];

/// The letters and Greek letters of all formulas in `html`.
fn symbols(html: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    // `<tex` also begins the `<text>` of a drawing.
    for formula in html.split("<tex").skip(1) {
        let Some(rest) = formula
            .strip_prefix('>')
            .or_else(|| formula.strip_prefix(" display>"))
        else {
            continue;
        };
        let tex = rest.split("</tex>").next().unwrap_or_default();
        found.extend(symbols_of(tex));
    }
    found
}

fn symbols_of(tex: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = tex;
    while let Some(letter) = rest.chars().next() {
        rest = &rest[letter.len_utf8()..];
        if letter == '\\' {
            let end = rest
                .find(|c: char| !c.is_ascii_alphabetic())
                .unwrap_or(rest.len());
            let (command, after) = rest.split_at(end);
            rest = after;
            // A name, an environment or a printed number is no symbol; nor is the length of a line break.
            let skipped = match command {
                "operatorname" | "mathrm" | "text" | "begin" | "end" => 1,
                "fig" => 2,
                _ => 0,
            };
            for _ in 0..skipped {
                rest = rest.split_once('}').map_or("", |(_, after)| after);
            }
            if command.is_empty() {
                rest = rest.strip_prefix("\\[1ex]").unwrap_or(rest);
            } else if GREEK.contains(&command) {
                found.push(command.to_owned());
            }
        } else if letter == '[' && rest.starts_with("1ex]") {
            rest = &rest[4..];
        } else if letter.is_ascii_alphabetic() {
            found.push(letter.to_string());
        }
    }
    found
}

#[test]
fn every_symbol_of_a_page_has_its_line_in_the_notation() {
    let reference = source("web/page/reference.html");
    let table = reference
        .split("<table class=\"notation\">")
        .nth(1)
        .expect("the table");
    let table = table.split("</table>").next().expect("its end");
    let heads: String = table
        .split("<th scope=\"row\">")
        .skip(1)
        .filter_map(|row| row.split("</th>").next())
        .collect();
    let known = symbols(&heads);
    let missing: Vec<_> = symbols(&companion()).difference(&known).cloned().collect();
    assert!(missing.is_empty(), "without a line: {missing:?}");
}

#[test]
fn a_symbol_is_found_beside_commands_and_numbers() {
    let found = symbols(
        "<text>a</text><tex>\\operatorname{atan2}(S, \\theta)\\\\[1ex] \\fig{x.y}{2} \\sum_i</tex>",
    );
    let found: Vec<_> = found.into_iter().collect();
    assert_eq!(found, ["S", "i", "theta"]);
}
