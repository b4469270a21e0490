//! The laps that break: each card of the gallery is driven again, and breaks as its sentence claims.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::document::{numbers_in, source};
use super::widgets::Widgets;

#[derive(Deserialize)]
struct Card {
    id: String,
    title: String,
    caption: String,
    state: String,
    /// What the caption claims: a range for each fact of the widget.
    breaks: BTreeMap<String, [f64; 2]>,
}

fn cards() -> Vec<Card> {
    serde_json::from_str(&source("web/page/gallery.json")).expect("the list of the gallery")
}

#[test]
fn every_lap_of_the_gallery_breaks_as_its_card_says() {
    let cards = cards();
    let ids: BTreeSet<_> = cards.iter().map(|card| &card.id).collect();
    assert!(ids.len() >= 12 && ids.len() == cards.len(), "{ids:?}");
    let mut widgets = Widgets::new();
    let mut wrong = Vec::new();
    for card in &cards {
        let outcome = widgets.set("w16.2", &card.state).outcome();
        assert!(!card.breaks.is_empty(), "{} claims nothing", card.id);
        for (id, [least, most]) in &card.breaks {
            let fact = outcome.facts.iter().find(|fact| fact.id == id);
            let value = fact.unwrap_or_else(|| panic!("no fact {id}")).value;
            if !(*least..=*most).contains(&value) {
                wrong.push(format!("{}: {id} is {value}", card.id));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Its picture prints the numbers as the core computes them in the build.
#[test]
fn no_card_has_a_number_of_its_own() {
    for Card { title, caption, .. } in cards() {
        let words = format!("{title} {caption}");
        assert!(numbers_in(&words).is_empty(), "{words}");
    }
}
