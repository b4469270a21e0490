//! What `teaching/guide` says: its figures are those of the page, and its links show what they promise.

use crate::page::document::{Document, companion, source};
use crate::page::widgets::Widgets;

const PAGES: [&str; 3] = ["widgets", "lectures", "questions"];

fn text(page: &str) -> String {
    source(&format!("teaching/guide/{page}.md"))
}

/// The page's are compared with the core.
#[test]
fn every_figure_of_the_teaching_pages_is_one_of_the_page() {
    let known = Document::parse(&companion()).figures;
    for page in PAGES {
        let figures = Document::parse(&text(page)).figures;
        assert!(figures.len() >= 10, "{page} has lost its figures");
        for figure in figures {
            assert!(known.contains(&figure), "{page}: {figure:?}");
        }
    }
}

/// Whether a page, `../../index` from the guide, has the widget.
fn holds(page: &str, number: &str) -> bool {
    let root = env!("CARGO_MANIFEST_DIR");
    let html = std::fs::read_to_string(format!("{root}/../teaching/guide/{page}.html"));
    html.is_ok_and(|html| html.contains(&format!("<slam-widget name=\"w{number}\"")))
}

/// `[words](../../index.html?w=16.1&heading=60): the verdict is “quarter turn”`.
#[test]
fn every_link_of_a_script_sets_its_widget_and_has_the_verdict_that_it_says() {
    let script = text("widgets");
    let mut widgets = Widgets::new();
    let mut wrong = Vec::new();
    let (mut links, mut verdicts) = (0, 0);
    let parts: Vec<&str> = script.split(".html?w=").collect();
    for pair in parts.windows(2) {
        let (_, page) = pair[0].rsplit_once("](").expect("a link begins");
        let (query, after) = pair[1].split_once(')').expect("a link ends");
        let (number, state) = query.split_once('&').expect("a link sets something");
        assert!(holds(page, number), "w{number} is not on {page}.html");
        let outcome = widgets.set(&format!("w{number}"), state).outcome();
        links += 1;
        let after: Vec<&str> = after.split_whitespace().take(12).collect();
        let after = after.join(" ");
        let said = after
            .strip_prefix(": the verdict is “")
            .and_then(|said| said.split_once('”'));
        if let Some((said, _)) = said {
            verdicts += 1;
            if said != outcome.verdict {
                wrong.push(format!("{query}: {}, not {said}", outcome.verdict));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(
        links > 30 && verdicts > 10,
        "{links} links, {verdicts} verdicts"
    );
    for widget in &widgets.0 {
        let title = format!(
            "## {} {}\n",
            widget.model().spec().id,
            widget.model().spec().title
        );
        assert!(script.contains(&title), "{title}");
    }
}
