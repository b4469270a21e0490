//! The values that the parameters of a widget have.

use crate::param::{MORE, ParamError, ParamKind, ParamSpec, printable};

/// The current value of every parameter of a list, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    specs: &'static [ParamSpec],
    values: Vec<f64>,
    /// Of the same index; empty where the parameter is no text.
    texts: Vec<String>,
}

impl Values {
    /// Every parameter at its default.
    #[must_use]
    pub fn defaults(specs: &'static [ParamSpec]) -> Self {
        Self {
            specs,
            values: specs.iter().map(|spec| spec.default).collect(),
            texts: vec![String::new(); specs.len()],
        }
    }

    /// Puts every parameter back to its default, but for [`MORE`]: what the reader has opened stays
    /// open.
    pub fn reset(&mut self) {
        for (spec, value) in self.specs.iter().zip(&mut self.values) {
            if spec.id != MORE.id {
                *value = spec.default;
            }
        }
        self.texts.fill(String::new());
    }

    /// The list these values belong to.
    #[must_use]
    pub fn specs(&self) -> &'static [ParamSpec] {
        self.specs
    }

    /// The parameter of that name with its value.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<(&'static ParamSpec, f64)> {
        let index = self.specs.iter().position(|spec| spec.id == id)?;
        Some((&self.specs[index], self.values[index]))
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

    /// The value of a parameter that the widget itself declares.
    ///
    /// # Panics
    /// Where the list has no such name: a bug of the widget.
    #[must_use]
    pub fn get(&self, id: &str) -> f64 {
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
        let Some(index) = self.specs.iter().position(|spec| spec.id == id) else {
            return Err(self.unknown(widget, id));
        };
        let spec = &self.specs[index];
        let value = spec.check(value)?;
        if value.to_bits() == self.values[index].to_bits() {
            return Ok(Changed::No);
        }
        if matches!(spec.kind, ParamKind::Text { .. }) {
            // A number can only take a text away.
            if value != 0.0 {
                return Err(ParamError::OutOfRange {
                    id: spec.id,
                    value,
                    min: 0.0,
                    max: 0.0,
                });
            }
            self.texts[index].clear();
        }
        self.values[index] = value;
        Ok(Changed::Yes)
    }

    /// Keeps a value of the widget's own, that lies in its range by construction.
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
        let Some(index) = self.specs.iter().position(|spec| spec.id == id) else {
            return Err(self.unknown(widget, id));
        };
        let value = self.specs[index].parse(text)?;
        if !matches!(self.specs[index].kind, ParamKind::Text { .. }) {
            return self.set(widget, id, value);
        }
        let text = text.trim();
        if self.texts[index] == text {
            return Ok(Changed::No);
        }
        text.clone_into(&mut self.texts[index]);
        self.values[index] = value;
        Ok(Changed::Yes)
    }

    /// The value of a parameter as a link writes it.
    ///
    /// # Panics
    /// Where the list has no such parameter: a bug of the widget.
    #[must_use]
    pub fn to_text(&self, id: &str) -> String {
        let index = self.specs.iter().position(|spec| spec.id == id);
        let Some(index) = index else {
            panic!("no parameter `{id}` in the list");
        };
        match self.specs[index].kind {
            ParamKind::Text { .. } => self.texts[index].clone(),
            _ => self.specs[index].to_text(self.values[index]),
        }
    }

    /// Every parameter with its value, in the list's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, f64)> {
        self.specs.iter().zip(self.values.iter().copied())
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
    fn a_text_is_kept_beside_a_number_that_tells_texts_apart() {
        const TEXTS: &[ParamSpec] = &[ParamSpec {
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
        assert_ne!(values.get("flat"), before.get("flat"));
        assert_eq!(values.set("w", "flat", 0.0), Ok(Changed::Yes));
        assert_eq!(values, Values::defaults(TEXTS));
    }
}
