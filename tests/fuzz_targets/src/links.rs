//! Links and attributes: one text for one parameter of one widget.
//!
//! The first byte names the widget, the second the parameter, the rest is the text.

use kit::param::{ParamKind, ParamSpec};
use kit::values::Values;

use widgets::registry::SPECS;

/// A valid text has a value in the range that reads back to the same bits.
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
        Ok(value) => taken(spec.id, param, value, &mut Values::defaults(spec.params)),
        Err(refusal) => {
            let sentence = refusal.to_string();
            assert!(sentence.contains(param.id), "{sentence}");
            assert!(sentence.len() < 400, "{sentence}");
            assert!(!sentence.contains(char::is_control), "{sentence:?}");
        }
    }
}

fn taken(widget: &'static str, param: &ParamSpec, value: f64, values: &mut Values) {
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
