//! The values that the parameters of a widget have.

use crate::param::{MORE, ParamError, ParamKind, ParamSpec, Typed, printable};

/// The current value of every parameter of a list, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    specs: &'static [&'static ParamSpec],
    values: Vec<Value>,
}

/// What one parameter has.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    /// A number, the index of an option, or 0 or 1 of a switch.
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

    /// A text has no number but 0.
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

    /// Puts every parameter back to its default, but for [`MORE`]: what the reader has opened stays
    /// open.
    pub fn reset(&mut self) {
        for (spec, value) in self.specs.iter().zip(&mut self.values) {
            if spec.id != MORE.id {
                *value = Value::default_of(spec);
            }
        }
    }

    /// The list these values belong to.
    #[must_use]
    pub fn specs(&self) -> &'static [&'static ParamSpec] {
        self.specs
    }

    /// The parameter of that name with its value.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<(&'static ParamSpec, f64)> {
        let index = self.index(id)?;
        Some((self.specs[index], self.values[index].number()))
    }

    /// The parameter of that name with its value, or words that name what there is.
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

    /// The value of a parameter that the widget itself declares.
    ///
    /// # Panics
    /// Where the list lacks it: a bug of the widget.
    #[must_use]
    pub fn get<P: Typed>(&self, param: &P) -> P::Value {
        param.read(self.number(param.spec().id))
    }

    /// The number that stands for the value of the parameter of that name.
    ///
    /// # Panics
    /// Where the list has no such name: a bug of the widget.
    #[must_use]
    pub fn number(&self, id: &str) -> f64 {
        match self.find(id) {
            Some((_, value)) => value,
            None => panic!("no parameter `{id}` in the list"),
        }
    }

    /// Sets a parameter after checking name and range; says whether the value changed.
    ///
    /// # Errors
    /// [`ParamError::UnknownParam`] or [`ParamError::OutOfRange`]; nothing changes then.
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
            // The range of a text is 0, which takes it away.
            (ParamKind::Text { .. }, _) => Value::Text(String::new()),
            (_, number) => Value::Number(number),
        };
        Ok(self.keep(index, value))
    }

    fn keep(&mut self, index: usize, value: Value) -> Changed {
        let is_same = match (&self.values[index], &value) {
            // −0 is another number: a link writes it.
            (Value::Number(old), Value::Number(new)) => old.to_bits() == new.to_bits(),
            (old, new) => old == new,
        };
        if is_same {
            return Changed::No;
        }
        self.values[index] = value;
        Changed::Yes
    }

    /// Keeps a value of the widget's own, that lies in its range by construction.
    ///
    /// # Panics
    /// Where the list refuses it: a bug of the widget.
    pub fn put<P: Typed>(&mut self, param: &P, value: P::Value) -> Changed {
        self.store(param.spec().id, param.number(value))
    }

    /// [`Values::put`] by the parameter's name and the number that stands for the value.
    ///
    /// # Panics
    /// Where the list refuses it: a bug of the widget.
    pub fn store(&mut self, id: &str, value: f64) -> Changed {
        match self.set("the widget", id, value) {
            Ok(changed) => changed,
            Err(error) => panic!("a value of our own was refused: {error}"),
        }
    }

    /// Sets a parameter to what [`Values::to_text`] writes; says whether it changed.
    ///
    /// # Errors
    /// [`ParamError`]; nothing changes then.
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

    /// The value of a parameter as a link writes it.
    ///
    /// # Panics
    /// Where the list has no such parameter: a bug of the widget.
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
    /// Something is new: compute again.
    Yes,
    /// All is as it was.
    No,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::param::tests::SPECS;

    #[test]
    fn a_refused_value_changes_nothing_and_names_the_remedy() {
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
    fn a_text_is_kept_as_it_is_and_taken_away_by_a_number() {
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
