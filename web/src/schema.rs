//! The constant description of a widget as JSON: title, texts, parameters, buttons, presets.
//!
//! It is the source of the native controls beside the canvas, the checks of links and attributes, the types
//! of the custom element and the tables in the docs.

use serde_json::{Value, json};
use widget_kit::model::{Model, text_alternative};
use widget_kit::param::{ParamKind, ParamSpec};

/// The schema of one widget; it needs a new model for the description of its initial state.
#[must_use]
pub fn widget(model: &dyn Model) -> Value {
    let spec = model.spec();
    let buttons = spec
        .buttons
        .iter()
        .map(|button| json!({ "id": button.id, "label": button.label, "help": button.help }));
    let keys = model
        .keys()
        .iter()
        .map(|(key, button)| json!({ "key": key, "button": button }));
    let presets = spec
        .presets
        .iter()
        .map(|preset| json!({ "id": preset.id, "label": preset.label, "help": preset.help }));
    json!({
        "id": spec.id,
        "name": spec.name,
        "title": spec.title,
        "claim": spec.claim,
        "gesture": spec.gesture,
        "notice": spec.notice,
        "params": spec.params.iter().map(|spec| param(spec)).collect::<Vec<_>>(),
        "buttons": buttons.collect::<Vec<_>>(),
        "presets": presets.collect::<Vec<_>>(),
        "keys": keys.collect::<Vec<_>>(),
        "opening": widget_kit::controls::shown(model),
        "summary": text_alternative(model, true),
        "takesFiles": model.takes_files(),
    })
}

fn param(spec: &ParamSpec) -> Value {
    let (min, max) = spec.range();
    let (kind, options) = match spec.kind {
        ParamKind::Slider { .. } => ("slider", None),
        ParamKind::Timeline { .. } => ("timeline", None),
        ParamKind::Seed { .. } => ("seed", None),
        ParamKind::Choice { options } => ("choice", Some(options)),
        ParamKind::Switch => ("switch", None),
        ParamKind::Text { .. } => ("text", None),
    };
    // For a text, the largest number of characters replaces the largest value.
    let max = match spec.kind {
        ParamKind::Text { most } => most as f64,
        _ => max,
    };
    let options = options.unwrap_or_default().iter();
    let options: Vec<_> = options
        .map(|choice| json!({ "id": choice.id, "label": choice.label }))
        .collect();
    json!({
        "id": spec.id,
        "label": spec.label,
        "unit": spec.unit,
        "kind": kind,
        "min": min,
        "max": max,
        "step": spec.step(),
        "decimals": spec.decimals(),
        "default": spec.default,
        "options": options,
        "help": spec.help,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use widgets::registry::{MODELS, SPECS};

    /// Names that an HTML element already has: an attribute or property of that name would break it.
    const TAKEN: [&str; 24] = [
        "name",
        "id",
        "class",
        "style",
        "title",
        "hidden",
        "slot",
        "lang",
        "dir",
        "role",
        "part",
        "value",
        "theme",
        "linked",
        "autostart",
        "src",
        "draggable",
        "translate",
        "inert",
        "popover",
        "nonce",
        "width",
        "height",
        "children",
    ];

    #[test]
    fn every_name_is_a_valid_and_free_attribute_name() {
        for spec in SPECS {
            let (name, mut seen) = (spec.id, HashSet::new());
            for param in spec.params {
                let id = param.id;
                let fits = id.starts_with(|c: char| c.is_ascii_lowercase())
                    && id.chars().all(|c| {
                        c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_'
                    });
                assert!(fits, "{name}: `{id}` is no attribute name");
                assert!(!TAKEN.contains(&id), "{name}: `{id}` has a meaning already");
                assert!(seen.insert(id), "{name}: `{id}` is there twice");
            }
        }
    }

    #[test]
    fn every_control_has_a_help_text() {
        for make in MODELS {
            let schema = widget(make().as_ref());
            let name = schema["id"].as_str().unwrap();
            for list in ["params", "buttons", "presets"] {
                for item in schema[list].as_array().unwrap() {
                    for word in ["id", "label", "help"] {
                        let text = item[word].as_str().unwrap();
                        assert!(!text.is_empty(), "{name}: {item} has no {word}");
                    }
                }
            }
            assert!(schema["summary"].as_str().unwrap().len() > 40, "{name}");
        }
    }
}
