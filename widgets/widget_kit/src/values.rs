//! The current values of a widget's parameters.

use crate::param::{MORE, ParamError, ParamKind, ParamSpec, Typed, printable};

/// The current value of every parameter of a list, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    specs: &'static [&'static ParamSpec],
    values: Vec<Value>,
}

/// The value of one parameter.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    /// A number, the index of an option, or 0 or 1 for a switch.
    Number(f64),
    /// A text.
    Text(String),
}

impl Value {
    fn default_of(spec: &ParamSpec) -> Self {
        match spec.kind {
            ParamKind::Text { .. } => Self::Text(String::new()),
            _ => Self::Number(spec.default),
        }
    }

    /// 0 for a text.
    fn number(&self) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Text(_) => 0.0,
        }
    }
}

impl Values {
    /// Every parameter at its default.
    #[must_use]
    pub fn defaults(specs: &'static [&'static ParamSpec]) -> Self {
        Self {
            specs,
            values: specs.iter().map(|spec| Value::default_of(spec)).collect(),
        }
    }

    /// Resets every parameter to its default, except [`MORE`], so that opened parts stay open.
    pub fn reset(&mut self) {
        for (spec, value) in self.specs.iter().zip(&mut self.values) {
            if spec.id != MORE.id {
                *value = Value::default_of(spec);
            }
        }
    }

    /// The parameter of that name with its value.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<(&'static ParamSpec, f64)> {
        let index = self.index(id)?;
        Some((self.specs[index], self.values[index].number()))
    }

    /// The parameter of that name with its value; the error lists the valid names.
    ///
    /// # Errors
    /// [`ParamError::UnknownParam`].
    pub fn find_for(
        &self,
        widget: &'static str,
        id: &str,
    ) -> Result<(&'static ParamSpec, f64), ParamError> {
        self.find(id).ok_or_else(|| self.unknown(widget, id))
    }

    fn unknown(&self, widget: &'static str, id: &str) -> ParamError {
        let known: Vec<_> = self.specs.iter().map(|spec| spec.id).collect();
        ParamError::UnknownParam {
            widget,
            id: printable(id),
            known: known.join(", "),
        }
    }

    fn index(&self, id: &str) -> Option<usize> {
        self.specs.iter().position(|spec| spec.id == id)
    }

    /// The value of a declared parameter.
    ///
    /// # Panics
    /// If the list lacks it: a bug of the widget.
    #[must_use]
    pub fn get<P: Typed>(&self, param: &P) -> P::Value {
        param.read(self.number(param.spec().id))
    }

    /// The number for the value of the parameter of that name.
    ///
    /// # Panics
    /// If the list lacks the name: a bug of the widget.
    #[must_use]
    pub fn number(&self, id: &str) -> f64 {
        match self.find(id) {
            Some((_, value)) => value,
            None => panic!("no parameter `{id}` in the list"),
        }
    }

    /// Sets a parameter after checking name and range. Returns whether the value changed.
    ///
    /// # Errors
    /// [`ParamError::UnknownParam`] or [`ParamError::OutOfRange`]; no value changes then.
    pub fn set(
        &mut self,
        widget: &'static str,
        id: &str,
        value: f64,
    ) -> Result<Changed, ParamError> {
        let Some(index) = self.index(id) else {
            return Err(self.unknown(widget, id));
        };
        let spec = self.specs[index];
        let value = match (spec.kind, spec.check(value)?) {
            // A text has only the number 0, which clears it.
            (ParamKind::Text { .. }, _) => Value::Text(String::new()),
            (_, number) => Value::Number(number),
        };
        Ok(self.keep(index, value))
    }

    fn keep(&mut self, index: usize, value: Value) -> Changed {
        let is_same = match (&self.values[index], &value) {
            // Distinguishes −0 from 0, because links write it.
            (Value::Number(old), Value::Number(new)) => old.to_bits() == new.to_bits(),
            (old, new) => old == new,
        };
        if is_same {
            return Changed::No;
        }
        self.values[index] = value;
        Changed::Yes
    }

    /// Stores a value that the widget computed, which is in its range by construction.
    ///
    /// # Panics
    /// If the value is invalid: a bug of the widget.
    pub fn put<P: Typed>(&mut self, param: &P, value: P::Value) -> Changed {
        self.store(param.spec().id, param.number(value))
    }

    /// [`Values::put`] by the parameter's name and the value's number.
    ///
    /// # Panics
    /// If the value is invalid: a bug of the widget.
    pub fn store(&mut self, id: &str, value: f64) -> Changed {
        match self.set("the widget", id, value) {
            Ok(changed) => changed,
            Err(error) => panic!("the widget computed an invalid value: {error}"),
        }
    }

    /// Sets a parameter from the output of [`Values::to_text`]. Returns whether it changed.
    ///
    /// # Errors
    /// [`ParamError`]; no value changes then.
    pub fn set_text(
        &mut self,
        widget: &'static str,
        id: &str,
        text: &str,
    ) -> Result<Changed, ParamError> {
        let Some(index) = self.index(id) else {
            return Err(self.unknown(widget, id));
        };
        let value = match (self.specs[index].kind, self.specs[index].parse(text)?) {
            (ParamKind::Text { .. }, _) => Value::Text(text.trim().to_owned()),
            (_, number) => Value::Number(number),
        };
        Ok(self.keep(index, value))
    }

    /// The value of a parameter in the form of a link.
    ///
    /// # Panics
    /// If the list lacks the parameter: a bug of the widget.
    #[must_use]
    pub fn to_text(&self, id: &str) -> String {
        let Some(index) = self.index(id) else {
            panic!("no parameter `{id}` in the list");
        };
        match &self.values[index] {
            Value::Text(text) => text.clone(),
            Value::Number(number) => self.specs[index].to_text(*number),
        }
    }

    /// Every parameter with its value, in the list's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, f64)> {
        let numbers = self.values.iter().map(Value::number);
        self.specs.iter().copied().zip(numbers)
    }
}

/// Whether a call changed anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changed {
    /// A value changed: compute again.
    Yes,
    /// No change.
    No,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::param::tests::SPECS;

    #[test]
    fn a_rejected_value_changes_no_state_and_names_the_remedy() {
        let mut values = Values::defaults(SPECS);
        for bad in [f64::NAN, f64::INFINITY, 181.0, -1e300] {
            assert!(values.set("w", "heading", bad).is_err(), "{bad} was taken");
        }
        let error = values.set("w", "headin", 3.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "w has no parameter `headin`; it has heading, variant"
        );
        assert_eq!(values, Values::defaults(SPECS));
        let error = values.find_for("w", "headin").unwrap_err();
        assert!(error.to_string().starts_with("w has no parameter `headin`"));
    }

    #[test]
    fn a_text_is_stored_unchanged_and_cleared_by_a_number() {
        const TEXTS: &[&ParamSpec] = &[&ParamSpec {
            id: "flat",
            label: "flat",
            unit: "",
            kind: ParamKind::Text { most: 8 },
            default: 0.0,
            help: "",
        }];
        let mut values = Values::defaults(TEXTS);
        assert_eq!(values.set_text("w", "flat", " Aa0-_ "), Ok(Changed::Yes));
        assert_eq!(values.to_text("flat"), "Aa0-_");
        let before = values.clone();
        for bad in ["123456789", "a b", "é", "a+b"] {
            let error = values.set_text("w", "flat", bad).unwrap_err().to_string();
            assert!(
                error.starts_with("`flat` takes at most 8 letters"),
                "{error}"
            );
        }
        assert!(values.set("w", "flat", 1.0).is_err());
        assert_eq!(values, before);
        assert_eq!(values.set_text("w", "flat", "Aa0-A"), Ok(Changed::Yes));
        assert_ne!(values, before);
        assert_eq!(values.set("w", "flat", 0.0), Ok(Changed::Yes));
        assert_eq!(values, Values::defaults(TEXTS));
    }
}
