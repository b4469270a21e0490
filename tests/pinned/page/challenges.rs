//! The challenge of each section can be met: its `data-proof` is a state that does, which `data-holds` describes.

use widget_kit::model::Model;

use super::document::{companion, unescape};
use super::widgets::Widgets;

struct Challenge {
    widget: String,
    proof: String,
    /// Clauses joined by "and": a verdict of the widget, or a comparison of facts, parameters and numbers, as
    /// `web/page/holds.ts` reads them.
    holds: String,
    /// Other parameters of the same state, and what holds with them.
    unlike: Option<(String, String)>,
}

/// Whether the current state of a widget meets a condition.
fn is_met(model: &dyn Model, condition: &str) -> bool {
    let outcome = model.outcome();
    let values = model.values();
    let value = |name: &str| {
        let fact = outcome.facts.iter().find(|fact| fact.id == name);
        let parameter = || values.find(name).map(|(_, value)| value);
        let number = || name.parse().unwrap_or_else(|_| panic!("no fact {name}"));
        fact.map(|fact| fact.value)
            .or_else(parameter)
            .unwrap_or_else(number)
    };
    let mut clauses = condition.split(" and ");
    clauses.all(|clause| match clause.split(' ').collect::<Vec<_>>()[..] {
        [less, "<", more] | [more, ">", less] => value(less) < value(more),
        [name, "=", text] => values.to_text(name) == text,
        _ => match clause.strip_prefix("not ") {
            Some(verdict) => outcome.verdict != verdict,
            None => outcome.verdict == clause,
        },
    })
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
            unlike: attribute("data-unlike").zip(attribute("data-unlike-holds")),
        })
    });
    (tags.len(), of_widgets.collect())
}

/// A challenge that ticks itself before the reader acts would be none.
#[test]
fn no_challenge_is_met_at_the_start() {
    let mut widgets = Widgets::new();
    for Challenge { widget, holds, .. } in challenges().1 {
        let more = if widget == "w16.2" { "t=0" } else { "more=off" };
        let model = widgets.set(&widget, more);
        assert!(!is_met(model, &holds), "{widget}: {holds}");
    }
}

#[test]
fn every_challenge_can_be_met() {
    let (all, challenges) = challenges();
    // The ten loop candidates are judged outside of a widget: right answers are right.
    assert_eq!(challenges.len(), all - 1);
    assert!(challenges.len() >= 13, "{}", challenges.len());
    let mut widgets = Widgets::new();
    let mut wrong = Vec::new();
    for challenge in challenges {
        let Challenge {
            widget,
            proof,
            holds,
            unlike,
        } = challenge;
        let mut check = |state: &str, holds: &str| {
            let model = widgets.set(&widget, state);
            if !is_met(model, holds) {
                let verdict = model.outcome().verdict;
                wrong.push(format!("{widget} {state}: {verdict}, not {holds}"));
            }
        };
        check(&proof, &holds);
        if let Some((other, holds)) = unlike {
            check(&format!("{proof}&{other}"), &holds);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
