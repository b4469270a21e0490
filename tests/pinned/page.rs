//! The chapter in `index.html`: every number that it prints is computed here again.
//!
//! A number is a figure (`data-figure`, or `\fig{name}{text}` in a formula), a link that sets a
//! widget, or the year of a citation. Any other digit on the page fails.

pub mod document;
mod figures;

use document::{Document, Figure, NumberLink, numbers_in, source};
use figures::Figures;
use kit::model::Model;
use kit::shell::Shell;
use pr_sim::World;

const WORDS: [&str; 13] = [
    "none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    "eleven", "twelve",
];
const ORDINALS: [&str; 6] = ["zeroth", "first", "second", "third", "fourth", "fifth"];

fn page() -> Document {
    Document::parse(&source("index.html"))
}

/// How a value is printed in the manner of `text`: as a word, or with as many digits.
fn in_the_manner_of(text: &str, value: f64) -> String {
    for words in [WORDS.as_slice(), ORDINALS.as_slice()] {
        if words.contains(&text.to_lowercase().as_str()) {
            let word = (value.fract() == 0.0)
                .then(|| words.get(value as usize))
                .flatten();
            return word.map_or_else(|| value.to_string(), ToString::to_string);
        }
    }
    let decimals = text
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    let printed = format!("{value:.decimals$}");
    // Rounded to nothing, a value has no sign.
    match printed.strip_prefix('-') {
        Some(digits) if digits.contains(|c: char| ('1'..='9').contains(&c)) => printed,
        Some(digits) => digits.to_owned(),
        None => printed,
    }
}

#[test]
fn every_figure_is_what_the_core_computes_at_the_printed_digits() {
    let mut figures = Figures::default();
    let mut wrong = Vec::new();
    for Figure { name, text } in page().figures {
        let printed = text.replace('\u{2212}', "-").to_lowercase();
        let signless = printed.trim_start_matches('+');
        match figures.value(&name) {
            None => wrong.push(format!("{name}: there is no such figure")),
            Some(value) => {
                let computed = in_the_manner_of(signless, value);
                if computed != signless {
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
fn a_figure_that_is_off_by_one_in_the_last_digit_would_be_found() {
    assert_eq!(in_the_manner_of("4.236", 4.235_830_998), "4.236");
    assert_ne!(in_the_manner_of("4.235", 4.235_830_998), "4.235");
    assert_eq!(in_the_manner_of("-39", -39.0), "-39");
    assert_eq!(in_the_manner_of("0", -1e-17), "0");
    assert_eq!(in_the_manner_of("three", 3.0), "three");
    assert_ne!(in_the_manner_of("three", 2.0), "three");
}

#[test]
fn no_number_stands_unmarked() {
    assert_eq!(page().loose_numbers, Vec::<String>::new());
    let doctored = "<p>It ends 0.24 m off.</p><tex>x = 1.5</tex><tex>x^2</tex>";
    assert_eq!(Document::parse(doctored).loose_numbers.len(), 2);
}

#[test]
fn a_number_that_sets_a_widget_says_what_it_sets() {
    let page = page();
    assert!(page.links.len() >= 10, "the page has lost its links");
    for NumberLink { href, text } in &page.links {
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
fn every_link_is_taken_whole_by_a_widget_that_stands_on_the_page() {
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
fn every_question_has_an_answer_in_its_widget() {
    let page = page();
    assert_eq!(page.predictions.len(), 4);
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
        }
    }
}

/// One of each widget.
struct Widgets(Vec<Shell>);

impl Widgets {
    fn new() -> Self {
        Self(vec![
            w16_1_basin_explorer::widget(),
            w16_2_full_lap::widget(),
            w16_3_cost_terraces::widget(),
            w16_4_control_room::widget(),
        ])
    }

    /// Puts a widget into a state such as `heading=40&dx=0`, from its defaults.
    fn set(&mut self, id: &str, state: &str) -> &dyn Model {
        let widget = self
            .0
            .iter_mut()
            .find(|widget| widget.model().spec().id == id);
        let model = widget
            .unwrap_or_else(|| panic!("no widget {id}"))
            .model_mut();
        model.press("defaults").expect("every widget has defaults");
        for pair in state.split('&') {
            let (name, text) = pair.split_once('=').expect("a name and a value");
            let found = model.values().find(name);
            let (spec, _) = found.unwrap_or_else(|| panic!("{id} has no {name}"));
            let value = spec
                .parse(text)
                .unwrap_or_else(|error| panic!("{id}: {error}"));
            model
                .set(name, value)
                .unwrap_or_else(|error| panic!("{id}: {error}"));
        }
        model
    }
}

#[test]
fn a_number_that_sets_a_tick_of_a_loop_is_the_tick_of_that_loop() {
    let html = source("index.html");
    let mut figures = Figures::default();
    let ticks: Vec<_> = html.split("data-tick-of=\"").skip(1).collect();
    assert!(ticks.len() >= 3);
    for tail in ticks {
        let (name, after) = tail.split_once("\">").expect("the attribute comes last");
        let text = &after[..after.find('<').expect("the link ends")];
        let tick = figures
            .value(name)
            .unwrap_or_else(|| panic!("no figure {name}"));
        assert!(numbers_in(text).contains(&tick), "{name}: {text}");
    }
}

#[test]
fn every_citation_leads_to_its_year() {
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

#[test]
fn the_plan_shows_the_walls_of_the_apartment() {
    let path = page().wall_path;
    let mut drawn = Vec::new();
    for line in path.split('M').skip(1) {
        let split = line.find(['H', 'V']).expect("walls run along the axes");
        let from: Vec<f64> = line[..split]
            .split(' ')
            .map(|n| n.parse().unwrap())
            .collect();
        let to: f64 = line[split + 1..].parse().unwrap();
        let end = if line.contains('H') {
            [to, from[1]]
        } else {
            [from[0], to]
        };
        drawn.push([[from[0], from[1]], end]);
    }
    let world = World::apartment();
    let walls: Vec<[[f64; 2]; 2]> = world
        .walls()
        .iter()
        .map(|wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]])
        .collect();
    for wall in &walls {
        assert!(drawn.contains(wall), "{wall:?} is missing in {drawn:?}");
    }
    assert_eq!(drawn.len(), walls.len());
}
