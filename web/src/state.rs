//! The state of a widget as JSON: values, outcome, timeline, tables.

use serde_json::{Map, Value, json};
use widget_kit::model::{Assessment, Model, Outcome, Table, Timeline};
use widget_kit::shell::Shell;

/// Every parameter in the form of a link: `{"heading": "60", "variant": "point-to-plane"}`.
#[must_use]
pub fn values(model: &dyn Model) -> Value {
    let values = model.values();
    let texts = values.iter().map(|(spec, _)| {
        let text = values.to_text(spec.id);
        (spec.id.to_owned(), Value::String(text))
    });
    Value::Object(texts.collect())
}

/// The complete state after each preset, a line each: native code and WebAssembly must agree on it to the
/// bit.
#[must_use]
pub fn after_each_preset(maker: fn() -> Shell) -> String {
    let mut lines = String::new();
    for preset in maker().model().spec().presets {
        let mut shell = maker();
        let model = shell.model_mut();
        let pressed = model.press(preset.id).is_ok();
        model.finish_work();
        let line = json!({
            "preset": preset.id,
            "pressed": pressed,
            "values": values(model),
            "outcome": outcome(&model.outcome()),
            "timeline": timeline(model.timeline().as_ref()),
            "tables": tables(&model.tables()),
        });
        lines.push_str(&line.to_string());
        lines.push('\n');
    }
    lines
}

/// The result: a sentence, and the numbers by name.
#[must_use]
pub fn outcome(outcome: &Outcome) -> Value {
    let facts: Map<_, _> = outcome
        .facts
        .iter()
        // Values that are not finite become null, because JSON cannot represent them.
        .map(|fact| (fact.id.to_owned(), json!(fact.value)))
        .collect();
    json!({
        "standing": standing(outcome.standing),
        "verdict": outcome.verdict,
        "sentence": outcome.in_full(),
        "facts": facts,
    })
}

/// The buttons that have nothing to do, and those shown as pressed.
#[must_use]
pub fn buttons(shell: &Shell) -> Value {
    let model = shell.model();
    let buttons = model.spec().buttons.iter().map(|button| button.id);
    let pressed: Vec<_> = buttons.filter(|id| model.is_pressed(id)).collect();
    json!({ "disabled": shell.disabled(), "pressed": pressed })
}

/// The facts and tables that stand under More, as they are shown.
#[must_use]
pub fn details(model: &dyn Model) -> Value {
    let outcome = model.outcome();
    let facts = outcome.facts.iter();
    let facts = facts.map(|fact| json!({ "label": fact.label, "text": fact.text() }));
    let tables = model.shown_tables();
    let tables = tables
        .iter()
        .map(|table| json!({ "title": table.title, "columns": table.columns, "rows": table.rows }));
    json!({ "facts": facts.collect::<Vec<_>>(), "tables": tables.collect::<Vec<_>>() })
}

/// The timeline, or null.
#[must_use]
pub fn timeline(timeline: Option<&Timeline>) -> Value {
    let Some(timeline) = timeline else {
        return Value::Null;
    };
    let marks: Vec<_> = timeline
        .marks
        .iter()
        .map(|mark| json!({ "at": mark.at, "label": mark.label, "standing": standing(mark.standing) }))
        .collect();
    json!({
        "param": timeline.param,
        "last": timeline.last,
        "playing": timeline.playing,
        "marks": marks,
    })
}

/// Every table as a CSV file: `[{"id", "title", "csv"}]`.
#[must_use]
pub fn tables(tables: &[Table]) -> Value {
    let files = tables
        .iter()
        .map(|table| json!({ "id": table.id, "title": table.title, "csv": csv(table) }));
    Value::Array(files.collect())
}

/// A table by RFC 4180: fields quoted where they must be, lines end in CR LF.
fn csv(table: &Table) -> String {
    let mut text = String::new();
    for row in std::iter::once(&table.columns).chain(&table.rows) {
        let fields: Vec<_> = row.iter().map(|field| csv_field(field)).collect();
        text.push_str(&fields.join(","));
        text.push_str("\r\n");
    }
    text
}

fn csv_field(field: &str) -> String {
    if field.contains(['"', ',', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

fn standing(standing: Assessment) -> &'static str {
    match standing {
        Assessment::Good => "good",
        Assessment::Bad => "bad",
        Assessment::Doubtful => "doubtful",
        Assessment::Neutral => "neutral",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use widget_kit::model::TablePlace;
    use widgets::registry::SHELLS;

    #[test]
    fn values_as_text_read_back_to_the_same_state() {
        for maker in SHELLS {
            let shell = maker();
            let model = shell.model();
            let name = model.spec().id;
            let json = values(model);
            for (spec, value) in model.values().iter() {
                let text = json[spec.id].as_str().unwrap();
                assert_eq!(spec.parse(text), Ok(value), "{name}: {}", spec.id);
            }
        }
    }

    #[test]
    fn every_preset_can_be_pressed() {
        for maker in SHELLS {
            let name = maker().model().spec().id;
            let lines = after_each_preset(maker);
            assert!(lines.lines().count() >= 2, "{name} has hardly any presets");
            assert!(!lines.contains("\"pressed\":false"), "{name}: {lines}");
        }
    }

    #[test]
    fn a_field_with_a_comma_or_a_quote_remains_one_field() {
        let table = Table {
            id: "t",
            title: String::new(),
            columns: vec!["x (m), world".to_owned(), "note".to_owned()],
            rows: vec![vec!["1.5".to_owned(), "the \"quarter turn\"".to_owned()]],
            place: TablePlace::ExportOnly,
        };
        let expected = "\"x (m), world\",note\r\n1.5,\"the \"\"quarter turn\"\"\"\r\n";
        assert_eq!(csv(&table), expected);
    }
}
