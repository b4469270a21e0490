//! Links and attributes: a text for a parameter of a widget.
//!
//! The first byte selects the widget, the second the parameter, the rest is the text.

use widget_kit::param::{ParamKind, ParamSpec};
use widget_kit::values::Values;

use widgets::registry::SPECS;

/// A text is accepted or rejected. An accepted value is in its range and survives a round trip to the same bits.
pub fn fuzz(data: &[u8]) {
    let [widget, param, text @ ..] = data else {
        return;
    };
    let Ok(text) = core::str::from_utf8(text) else {
        return;
    };
    let spec = SPECS[usize::from(*widget) % SPECS.len()];
    let param = &spec.params[usize::from(*param) % spec.params.len()];
    match param.parse(text) {
        Ok(_) if matches!(param.kind, ParamKind::Text { .. }) => {
            let mut values = Values::defaults(spec.params);
            assert!(values.set_text(spec.id, param.id, text).is_ok());
            assert_eq!(values.to_text(param.id), text.trim());
        }
        Ok(value) => accepted(spec.id, param, value, &mut Values::defaults(spec.params)),
        Err(rejection) => {
            let sentence = rejection.to_string();
            assert!(sentence.contains(param.id), "{sentence}");
            assert!(sentence.len() < 400, "{sentence}");
            assert!(!sentence.contains(char::is_control), "{sentence:?}");
        }
    }
}

fn accepted(widget: &'static str, param: &ParamSpec, value: f64, values: &mut Values) {
    let (min, max) = param.range();
    assert!((min..=max).contains(&value), "{} at {value}", param.id);
    if !matches!(param.kind, ParamKind::Slider { .. }) {
        assert_eq!(value.fract(), 0.0, "{} at {value}", param.id);
    }
    let back = param.parse(&param.to_text(value));
    assert_eq!(back.map(f64::to_bits), Ok(value.to_bits()), "{}", param.id);
    assert!(!param.to_text(value).is_empty());
    assert!(values.set(widget, param.id, value).is_ok());
    assert_eq!(values.number(param.id).to_bits(), value.to_bits());
}
