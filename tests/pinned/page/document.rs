//! Parses the chapter's source: numbers, links, and their context.
//!
//! A tokenizer for our own HTML: quoted attributes, no comments, no script text.

use std::fs;
use std::path::{Path, PathBuf};

use super::printed::measures;

/// A number of the page that is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name of the result, for example `lap.canonical.rms`.
    pub name: String,
    /// As printed: `0.5857`, `−39`, `three`.
    pub text: String,
}

/// A link in the text that sets a widget.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberLink {
    /// The query: `?w=16.1&heading=60`.
    pub href: String,
    /// The text of the link.
    pub text: String,
    /// The widget's value there, and the figure that prints it: `rmse_m=basin.p2p.75.rmse …`.
    pub shows: Option<String>,
    /// The verdict of the widget, if the sentence has no number.
    pub verdict: Option<String>,
    /// The source of the paragraph or item around the link.
    pub around: String,
}

/// A question to the reader before the widget shows the answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prediction {
    /// The widget with the answer.
    pub widget: String,
    /// Its state: `heading=40&tau=1.4`.
    pub state: String,
    /// The fact of its outcome; empty if the question is about the verdict.
    pub fact: String,
    /// The possible verdicts, or the names of the value's choices.
    pub choices: Vec<String>,
    /// The range of the fact for each choice: from the first to below the second.
    pub ranges: Vec<[f64; 2]>,
}

/// The parsed source of the page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Every marked number, in the text and in formulas.
    pub figures: Vec<Figure>,
    /// Every link that sets a widget.
    pub links: Vec<NumberLink>,
    /// Every question, in order.
    pub predictions: Vec<Prediction>,
    /// Names of the widgets on the page.
    pub widgets: Vec<String>,
    /// Targets of links within the page, with their words.
    pub citations: Vec<(String, String)>,
    /// Every `id`, with the text of its element if that is an entry of the references.
    pub references: Vec<(String, String)>,
    /// Unmarked text that contains a number: there should be none.
    pub loose_numbers: Vec<String>,
}

/// The element of the current text.
enum Open {
    Figure(Figure),
    Link(NumberLink),
    Citation(String, String),
    Reference(String, String),
    Formula(String),
    /// Something that the reader can count: items, unknowns, exercises.
    Count,
    /// A command, whose digits are part of its name.
    Code,
}

/// A file of the project, by its path relative to the top level.
pub fn source(path: &str) -> String {
    fs::read_to_string(path_of(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// Where a file of the project is.
pub fn path_of(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The style sheets of the page in their order.
pub fn page_style() -> String {
    let imports = source("web/page/page.css");
    let files = imports
        .lines()
        .filter_map(|line| line.strip_prefix("@import \"./")?.strip_suffix("\";"));
    files
        .map(|file| source(&format!("web/page/{file}")))
        .collect()
}

/// The text of all pages in reading order, by the list of the build.
pub fn companion() -> String {
    let list = source("web/page/pages.mjs");
    let paths = list.split("source: '").skip(1);
    let paths = paths.filter_map(|rest| Some(rest.split_once('\'')?.0));
    let pages: Vec<String> = paths.map(source).collect();
    assert!(pages.len() >= 4, "web/page/pages.mjs has another form");
    pages.concat()
}

impl Document {
    /// Parses the source of a page.
    pub fn parse(html: &str) -> Self {
        let mut document = Self::default();
        let mut open: Option<Open> = None;
        let mut rest = html;
        while let Some(start) = rest.find('<') {
            document.take_text(&mut open, &rest[..start]);
            let end = start + rest[start..].find('>').expect("a tag ends");
            document.take_tag(&mut open, &rest[start + 1..end]);
            if let Some(Open::Link(link)) = &mut open
                && link.around.is_empty()
            {
                link.around = block_around(html, html.len() - rest.len() + start);
            }
            rest = &rest[end + 1..];
        }
        document
    }

    fn take_text(&mut self, open: &mut Option<Open>, text: &str) {
        let text = unescape(text);
        match open {
            Some(
                Open::Figure(Figure { text: words, .. })
                | Open::Link(NumberLink { text: words, .. })
                | Open::Citation(_, words)
                | Open::Reference(_, words)
                | Open::Formula(words),
            ) => words.push_str(&text),
            Some(Open::Count | Open::Code) => {}
            None if measures(&text) => {
                self.loose_numbers.push(text.trim().to_owned());
            }
            None => {}
        }
    }

    fn take_tag(&mut self, open: &mut Option<Open>, tag: &str) {
        let name = tag.split_whitespace().next().unwrap_or_default();
        let attribute = |name: &str| attribute(tag, name);
        let class = attribute("class").unwrap_or_default();
        match name {
            "span" if class == "figure" => {
                let name = attribute("data-figure").expect("a figure has a name");
                let text = String::new();
                *open = Some(Open::Figure(Figure { name, text }));
            }
            "span" if class == "ordinal" || class == "count" => *open = Some(Open::Count),
            "a" if class.split(' ').any(|class| class == "slam-link") => {
                let href = attribute("href").expect("a link has a target");
                *open = Some(Open::Link(NumberLink {
                    href,
                    shows: attribute("data-shows"),
                    verdict: attribute("data-verdict"),
                    ..NumberLink::default()
                }));
            }
            "a" if class == "cite" => {
                let href = attribute("href").expect("a citation has a target");
                *open = Some(Open::Citation(href, String::new()));
            }
            "li" if attribute("id").is_some() => {
                let id = attribute("id").unwrap_or_default();
                *open = Some(Open::Reference(id, String::new()));
            }
            "slam-predict" => self.predictions.push(Prediction {
                widget: attribute("widget").unwrap_or_default(),
                state: attribute("state").unwrap_or_default(),
                fact: attribute("fact").unwrap_or_default(),
                ..Prediction::default()
            }),
            "li" if attribute("data-choice").is_some() => {
                if let Some(prediction) = self.predictions.last_mut() {
                    let end = |name: &str, open: f64| {
                        attribute(name).map_or(open, |text| text.parse().expect("a number"))
                    };
                    prediction.choices.extend(attribute("data-choice"));
                    prediction.ranges.push([
                        end("data-from", f64::NEG_INFINITY),
                        end("data-to", f64::INFINITY),
                    ]);
                }
            }
            "code" => *open = Some(Open::Code),
            "tex" => *open = Some(Open::Formula(String::new())),
            "slam-widget" => self.widgets.extend(attribute("name")),
            "/span" | "/a" | "/tex" | "/li" | "/code" => self.close(open, name),
            _ => {}
        }
    }

    fn close(&mut self, open: &mut Option<Open>, name: &str) {
        let ends = match open {
            Some(Open::Figure(_) | Open::Count) => "/span",
            Some(Open::Link(_) | Open::Citation(..)) => "/a",
            Some(Open::Reference(..)) => "/li",
            Some(Open::Formula(_)) => "/tex",
            Some(Open::Code) => "/code",
            None => return,
        };
        if name != ends {
            return;
        }
        match open.take() {
            Some(Open::Figure(figure)) => self.figures.push(figure),
            Some(Open::Link(link)) => self.links.push(link),
            Some(Open::Citation(href, text)) => self.citations.push((href, text)),
            Some(Open::Reference(id, text)) => self.references.push((id, text)),
            Some(Open::Formula(tex)) => self.take_formula(&tex),
            Some(Open::Count | Open::Code) | None => {}
        }
    }

    /// `\fig{name}{text}` is a figure. The rest may contain exact constants (½, squares), but no
    /// measurements.
    fn take_formula(&mut self, tex: &str) {
        let mut rest = tex;
        let mut unmarked = String::new();
        while let Some(start) = rest.find("\\fig{") {
            unmarked.push_str(&rest[..start]);
            let after = &rest[start + 5..];
            let (name, after) = after.split_once("}{").expect("\\fig has two arguments");
            let (text, after) = after.split_once('}').expect("\\fig ends");
            self.figures.push(Figure {
                name: name.to_owned(),
                text: text.to_owned(),
            });
            unmarked.push(' ');
            rest = after;
        }
        unmarked.push_str(rest);
        let measures = unmarked
            .split(|c: char| !(c.is_ascii_digit() || c == '.'))
            .any(|run| run.len() > 1 && run.contains(|c: char| c.is_ascii_digit()));
        if measures {
            self.loose_numbers.push(tex.to_owned());
        }
    }
}

/// The paragraph or list item around a position of the source.
fn block_around(html: &str, place: usize) -> String {
    let (before, after) = html.split_at(place);
    let starts = ["<p>", "<li>", "<li "].map(|tag| before.rfind(tag));
    let ends = ["</p>", "</li>"].map(|tag| after.find(tag));
    let start = starts.into_iter().flatten().max().unwrap_or_default();
    let end = ends.into_iter().flatten().min().unwrap_or(after.len());
    html[start..place + end].to_owned()
}

/// The numbers in a text, with their signs.
pub fn numbers_in(text: &str) -> Vec<f64> {
    let text = text.replace('\u{2212}', "-");
    text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'))
        .filter_map(|run| run.trim_end_matches(['.', '-']).parse().ok())
        .collect()
}

fn attribute(tag: &str, name: &str) -> Option<String> {
    let key = format!(" {name}=\"");
    let value = &tag[tag.find(&key)? + key.len()..];
    Some(unescape(&value[..value.find('"')?]))
}

/// The text of an attribute.
pub fn unescape(text: &str) -> String {
    text.replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&")
}
