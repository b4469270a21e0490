//! The pages of the companion: every number in them is computed again.
//!
//! A number is a figure (`data-figure`, or `\fig{name}{text}` in a formula), a link that sets a widget, the
//! year of a citation, or marked as a count that the reader can make on the page. Any other digit or number
//! word on the page fails.

mod building;
mod challenges;
mod claims;
pub mod document;
mod drawings;
mod figures;
mod gallery;
mod length;
mod notation;
mod printed;
mod registrations;
mod thousand_laps;
pub mod widgets;

use document::{Document, Figure, NumberLink, companion, numbers_in};
use widgets::Widgets;

fn page() -> Document {
    Document::parse(&companion())
}

#[test]
fn every_figure_is_what_the_core_computes_at_the_printed_digits() {
    let mut wrong = Vec::new();
    for Figure { name, text } in page().figures {
        match figures::value(&name) {
            None => wrong.push(format!("{name}: there is no such figure")),
            Some(value) => {
                if let Err(computed) = printed::check(&text, value) {
                    wrong.push(format!(
                        "{name}: printed {text}, computed {computed} ({value})"
                    ));
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} figures:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn no_number_is_unmarked() {
    assert_eq!(page().loose_numbers, Vec::<String>::new());
    let doctored = "<p>It ends 0.24 m off.</p><tex>x = 1.5</tex><tex>x^2</tex>\
        <p>The error falls to a third.</p><p>It has <span class=\"count\">three</span> parts.</p>";
    assert_eq!(Document::parse(doctored).loose_numbers.len(), 3);
}

#[test]
fn a_number_that_sets_a_widget_names_its_values() {
    let page = page();
    assert!(page.links.len() >= 10, "the page has lost its links");
    for NumberLink { href, text, .. } in &page.links {
        let set: Vec<f64> = href
            .split(['&', '?'])
            .filter_map(|pair| pair.split_once('=')?.1.parse().ok())
            .collect();
        for number in numbers_in(text) {
            assert!(
                set.contains(&number),
                "“{text}” does not set {number}: {href}"
            );
        }
    }
}

#[test]
fn every_link_is_valid_for_a_widget_of_the_page() {
    let page = page();
    let mut widgets = Widgets::new();
    for widget in &widgets.0 {
        let id = widget.model().spec().id;
        assert!(
            page.widgets.iter().any(|name| name == id),
            "{id} is not on the page"
        );
    }
    for NumberLink { href, .. } in &page.links {
        let query = href.trim_start_matches("?w=");
        let (number, state) = query.split_once('&').expect("a link sets something");
        widgets.set(&format!("w{number}"), state);
    }
}

#[test]
fn the_widget_of_every_link_agrees_with_its_sentence() {
    let page = page();
    let mut widgets = Widgets::new();
    let mut wrong = Vec::new();
    for link in &page.links {
        let query = link.href.trim_start_matches("?w=");
        let (number, state) = query.split_once('&').expect("a link sets something");
        let outcome = widgets.set(&format!("w{number}"), state).outcome();
        if let Some(verdict) = &link.verdict {
            if outcome.verdict != *verdict {
                wrong.push(format!("{}: {}, not {verdict}", link.href, outcome.verdict));
            }
            continue;
        }
        let shows = link.shows.as_deref().unwrap_or_default();
        if shows.is_empty() {
            wrong.push(format!("{}: nothing says what it shows", link.href));
        }
        for pair in shows.split_whitespace() {
            let (fact, name) = pair.split_once('=').expect("a fact and a figure");
            let figure = page.figures.iter().find(|figure| figure.name == name);
            let stands_beside = link.around.contains(&format!("\"{name}\""))
                || link.around.contains(&format!("{{{name}}}"));
            let found = outcome.facts.iter().find(|found| found.id == fact);
            match (figure, found) {
                (Some(figure), Some(found)) if stands_beside => {
                    // A heading is printed without its sign if only its size matters.
                    let says = |value| printed::check(&figure.text, value);
                    if says(found.value).is_err() && says(-found.value).is_err() {
                        wrong.push(format!(
                            "{}: the text says {}, the widget {fact} = {}",
                            link.href, figure.text, found.value
                        ));
                    }
                }
                _ => wrong.push(format!("{}: {pair} is not in its sentence", link.href)),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_question_has_an_answer_in_its_widget() {
    let page = page();
    assert_eq!(page.predictions.len(), 11);
    let mut widgets = Widgets::new();
    for question in &page.predictions {
        let model = widgets.set(&question.widget, &question.state);
        let outcome = model.outcome();
        if question.fact.is_empty() {
            assert!(
                question.choices.contains(&outcome.verdict),
                "{}: {question:?}",
                outcome.verdict
            );
        } else {
            let fact = outcome.facts.iter().find(|fact| fact.id == question.fact);
            let fact = fact.unwrap_or_else(|| panic!("no such fact: {question:?}"));
            assert!(fact.value.is_finite(), "{question:?}");
            let holds = |[from, to]: &&[f64; 2]| (*from..*to).contains(&fact.value);
            let right = question.ranges.iter().filter(holds).count();
            let asked = usize::from(!question.ranges.is_empty());
            assert_eq!(
                right, asked,
                "{} is {}: {question:?}",
                question.fact, fact.value
            );
        }
    }
}

#[test]
fn a_link_to_a_loop_sets_the_tick_of_that_loop() {
    let html = companion();
    let links: Vec<_> = html.split("href=\"").skip(1).collect();
    let ticks = links.iter().filter_map(|link| {
        let (query, rest) = link.split_once('"')?;
        let (tag, _) = rest.split_once('>')?;
        let (_, name) = tag.split_once("data-tick-of=\"")?;
        Some((query, name.split_once('"')?.0))
    });
    let ticks: Vec<_> = ticks.collect();
    assert!(ticks.len() >= 3);
    for (query, name) in ticks {
        let tick = figures::value(name).unwrap_or_else(|| panic!("no figure {name}"));
        let set = query
            .split("&amp;")
            .filter_map(|pair| pair.strip_prefix("t="));
        let set: Vec<f64> = set.filter_map(|text| text.parse().ok()).collect();
        assert_eq!(set, [tick], "{name}: {query}");
    }
}

#[test]
fn every_citation_has_a_reference_of_its_year() {
    let page = page();
    assert!(page.citations.len() >= 12);
    for (href, text) in &page.citations {
        let id = href.trim_start_matches('#');
        let (_, entry) = page
            .references
            .iter()
            .find(|(reference, _)| reference == id)
            .unwrap_or_else(|| panic!("{text} leads to {href}, which is not there"));
        for year in numbers_in(text) {
            assert!(numbers_in(entry).contains(&year), "{text}: {entry}");
        }
    }
}
