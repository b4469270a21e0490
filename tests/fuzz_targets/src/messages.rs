//! JSON messages from the page around an embedded widget, as far as they reach the core.
//!
//! The first byte selects the widget, the rest is the message: `{"type": "set", "values": {…}}` or
//! `{"type": "press", "button": "…"}`. Messages that `embed.ts` rejects are rejected here as well.

use serde_json::Value;
use widget_kit::model::Model;

use crate::listener::Listener;
use widgets::registry::SPECS;

/// A rejected value or press changes nothing; an accepted one changes only what it names.
pub fn fuzz(data: &[u8]) {
    let [widget, message @ ..] = data else {
        return;
    };
    let Ok(Value::Object(message)) = serde_json::from_slice(message) else {
        return;
    };
    let mut listener = Listener::new(SPECS[usize::from(*widget) % SPECS.len()]);
    match message.get("type").and_then(Value::as_str) {
        Some("set") => {
            let Some(Value::Object(values)) = message.get("values") else {
                return;
            };
            for (id, value) in values {
                set(&mut listener, id, &as_javascript_writes(value));
            }
        }
        Some("press") => {
            if let Some(button) = message.get("button").and_then(Value::as_str) {
                press(&mut listener, button);
            }
        }
        _ => {}
    }
}

fn set(listener: &mut Listener, id: &str, text: &str) {
    let before = listener.values().clone();
    let answer = listener.set_text(id, text);
    let pairs = before.iter().zip(listener.values().iter());
    for ((param, old), (_, new)) in pairs {
        let may_change = answer.is_ok() && param.id == id;
        assert!(may_change || old.to_bits() == new.to_bits(), "{}", param.id);
    }
    match answer {
        Ok(()) => {
            let (param, value) = listener.values().find(id).expect("it was set");
            assert_eq!(param.parse(text).map(f64::to_bits), Ok(value.to_bits()));
        }
        Err(rejection) => assert!(rejection.to_string().len() < 600, "{rejection}"),
    }
}

fn press(listener: &mut Listener, button: &str) {
    match listener.press(button) {
        Ok(()) => assert_eq!(listener.presses, 1),
        Err(rejection) => {
            assert_eq!(listener.presses, 0);
            assert!(rejection.to_string().len() < 900, "{rejection}");
        }
    }
}

/// `String(value)`.
fn as_javascript_writes(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::String(text) => text.clone(),
        Value::Array(values) => {
            let texts: Vec<_> = values.iter().map(as_javascript_writes).collect();
            texts.join(",")
        }
        Value::Object(_) => "[object Object]".to_owned(),
        plain => plain.to_string(),
    }
}
