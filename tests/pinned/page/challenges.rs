//! The challenge of each section can be met: its `data-proof` is a state that does, which `data-holds` describes.

use super::document::{companion, unescape};
use super::widgets::Widgets;

struct Challenge {
    widget: String,
    proof: String,
    /// A verdict of the widget, or a fact compared with a number or another fact.
    holds: String,
}

/// The challenges that a widget can show to be met.
fn challenges() -> (usize, Vec<Challenge>) {
    let html = companion();
    let tags: Vec<&str> = html.split("<p class=\"challenge\"").skip(1).collect();
    let of_widgets = tags.iter().filter_map(|tag| {
        let (tag, _) = tag.split_once("\">")?;
        let attribute = |name: &str| {
            let (_, value) = tag.split_once(&format!("{name}=\""))?;
            Some(unescape(value.split('"').next()?))
        };
        Some(Challenge {
            widget: attribute("data-widget")?,
            proof: attribute("data-proof")?,
            holds: attribute("data-holds")?,
        })
    });
    (tags.len(), of_widgets.collect())
}

#[test]
fn every_challenge_can_be_met() {
    let (all, challenges) = challenges();
    // The ten loop candidates are judged outside of a widget: right answers are right.
    assert_eq!(challenges.len(), all - 1);
    assert!(challenges.len() >= 13, "{}", challenges.len());
    let mut widgets = Widgets::new();
    let mut wrong = Vec::new();
    for Challenge {
        widget,
        proof,
        holds,
    } in challenges
    {
        let outcome = widgets.set(&widget, &proof).outcome();
        let value = |name: &str| {
            let fact = outcome.facts.iter().find(|fact| fact.id == name);
            let number = || name.parse().unwrap_or_else(|_| panic!("no fact {name}"));
            fact.map_or_else(number, |fact| fact.value)
        };
        let is_met = match holds.split(' ').collect::<Vec<_>>()[..] {
            [less, "<", more] | [more, ">", less] => value(less) < value(more),
            _ => outcome.verdict == holds,
        };
        if !is_met {
            wrong.push(format!(
                "{widget} {proof}: {}, not {holds}",
                outcome.verdict
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
