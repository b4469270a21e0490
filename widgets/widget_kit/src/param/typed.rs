//! Declarations with the type of their value.

use core::marker::PhantomData;
use core::ops::Deref;

use super::spec::{Choice, ParamKind, ParamSpec};

/// A declaration with the type of its value: [`Param`] or [`OneOf`].
pub trait Typed {
    /// The type that a model reads.
    type Value;

    /// The untyped declaration.
    fn spec(&self) -> &ParamSpec;

    /// Converts a number of the list to the value.
    fn read(&self, number: f64) -> Self::Value;

    /// Converts a value to its number in the list.
    fn number(&self, value: Self::Value) -> f64;
}

/// A type that the value of a [`Param`] may have.
pub trait Number: Copy {
    /// Converts a number of the list to the value.
    fn read(number: f64) -> Self;

    /// Converts the value to its number in the list.
    fn number(self) -> f64;
}

impl Number for f64 {
    fn read(number: f64) -> Self {
        number
    }

    fn number(self) -> f64 {
        self
    }
}

impl Number for usize {
    fn read(number: f64) -> Self {
        number as Self
    }

    fn number(self) -> f64 {
        self as f64
    }
}

impl Number for u32 {
    fn read(number: f64) -> Self {
        number as Self
    }

    fn number(self) -> f64 {
        f64::from(self)
    }
}

impl Number for bool {
    fn read(number: f64) -> Self {
        number != 0.0
    }

    fn number(self) -> f64 {
        f64::from(u8::from(self))
    }
}

/// A parameter whose value is a number or a switch.
#[derive(Clone, Copy, Debug)]
pub struct Param<T> {
    /// The untyped declaration.
    pub spec: ParamSpec,
    value: PhantomData<T>,
}

impl<T> Param<T> {
    const fn new(id: &'static str, label: &'static str, kind: ParamKind) -> Self {
        let spec = ParamSpec {
            id,
            label,
            unit: "",
            kind,
            default: 0.0,
            help: "",
        };
        Self {
            spec,
            value: PhantomData,
        }
    }

    /// A number between two limits, moved in steps.
    #[must_use]
    pub const fn slider(
        id: &'static str,
        label: &'static str,
        [min, max]: [f64; 2],
        step: f64,
    ) -> Self {
        Self::new(id, label, ParamKind::Slider { min, max, step })
    }

    /// A position on the widget's timeline.
    #[must_use]
    pub const fn timeline(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Timeline { max })
    }

    /// A whole number that is typed.
    #[must_use]
    pub const fn typed(id: &'static str, label: &'static str, max: f64) -> Self {
        Self::new(id, label, ParamKind::Seed { max })
    }

    /// Sets the unit.
    #[must_use]
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.spec.unit = unit;
        self
    }

    /// Sets a default other than 0.
    #[must_use]
    pub const fn default(mut self, default: f64) -> Self {
        self.spec.default = default;
        self
    }

    /// Sets the sentence on its effect.
    #[must_use]
    pub const fn help(mut self, help: &'static str) -> Self {
        self.spec.help = help;
        self
    }
}

impl Param<u32> {
    /// A seed of the core's generator.
    #[must_use]
    pub const fn seed(label: &'static str, default: u32) -> Self {
        Self::new("seed", label, ParamKind::SEED).default(default as f64)
    }

    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: u32) -> (&'static str, f64) {
        (self.spec.id, value as f64)
    }
}

impl Param<usize> {
    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: usize) -> (&'static str, f64) {
        (self.spec.id, value as f64)
    }
}

impl Param<f64> {
    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: f64) -> (&'static str, f64) {
        (self.spec.id, value)
    }
}

impl Param<String> {
    /// Letters, digits, `-` and `_`, up to that many.
    #[must_use]
    pub const fn text(id: &'static str, label: &'static str, most: usize) -> Self {
        Self::new(id, label, ParamKind::Text { most })
    }
}

impl Param<bool> {
    /// A switch that is off.
    #[must_use]
    pub const fn switch(id: &'static str, label: &'static str) -> Self {
        Self::new(id, label, ParamKind::Switch)
    }

    /// A switch that is on at the start.
    #[must_use]
    pub const fn on(self) -> Self {
        self.default(1.0)
    }

    /// The value for a preset.
    #[must_use]
    pub const fn to(&self, value: bool) -> (&'static str, f64) {
        (self.spec.id, value as u8 as f64)
    }
}

impl<T: Number> Typed for Param<T> {
    type Value = T;

    fn spec(&self) -> &ParamSpec {
        &self.spec
    }

    fn read(&self, number: f64) -> T {
        T::read(number)
    }

    fn number(&self, value: T) -> f64 {
        value.number()
    }
}

impl<T> Deref for Param<T> {
    type Target = ParamSpec;

    fn deref(&self) -> &ParamSpec {
        &self.spec
    }
}

/// A value, its name in links and its name on screen.
pub type Named<T> = (T, &'static str, &'static str);

/// A parameter with a few named values.
#[derive(Clone, Copy, Debug)]
pub struct OneOf<T: 'static> {
    /// The untyped declaration.
    pub spec: ParamSpec,
    values: &'static [Named<T>],
}

impl<T> OneOf<T> {
    /// A choice between these values; the first one is the default. Declared by [`one_of!`](crate::one_of), which
    /// derives the options.
    #[must_use]
    pub const fn new(
        id: &'static str,
        label: &'static str,
        options: &'static [Choice],
        values: &'static [Named<T>],
    ) -> Self {
        let spec = Param::<T>::new(id, label, ParamKind::Choice { options }).spec;
        Self { spec, values }
    }

    /// Sets a default other than the first option.
    #[must_use]
    pub const fn default(mut self, option: &str) -> Self {
        self.spec.default = self.to(option).1;
        self
    }

    /// Sets the sentence on its effect.
    #[must_use]
    pub const fn help(mut self, help: &'static str) -> Self {
        self.spec.help = help;
        self
    }

    /// The value for a preset, by its option.
    ///
    /// # Panics
    /// If there is no such option: in a `const` at compile time.
    #[must_use]
    pub const fn to(&self, option: &str) -> (&'static str, f64) {
        let ParamKind::Choice { options } = self.spec.kind else {
            panic!("made by `new`");
        };
        let mut index = 0;
        while index < options.len() {
            if is_same(options[index].id.as_bytes(), option.as_bytes()) {
                return (self.spec.id, index as f64);
            }
            index += 1;
        }
        panic!("no such option");
    }
}

/// A table of named values with one more row, without a value, at that index.
///
/// # Panics
/// If `N` is not their number and one: in a constant at compile time.
#[must_use]
pub const fn optional<T: Copy, const N: usize>(
    values: &[Named<T>],
    none_at: usize,
    [name, label]: [&'static str; 2],
) -> [Named<Option<T>>; N] {
    assert!(values.len() + 1 == N, "another number of values");
    let mut all = [(None, name, label); N];
    let mut index = 0;
    while index < values.len() {
        let (value, name, label) = values[index];
        all[index + (index >= none_at) as usize] = (Some(value), name, label);
        index += 1;
    }
    all
}

/// The options of a table of named values.
#[must_use]
pub const fn options<T, const N: usize>(values: &[Named<T>]) -> [Choice; N] {
    let mut options = [Choice::new("", ""); N];
    let mut index = 0;
    while index < N {
        options[index] = Choice::new(values[index].1, values[index].2);
        index += 1;
    }
    options
}

/// `a == b`, for constants.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut index = 0;
    while index < a.len() && index < b.len() && a[index] == b[index] {
        index += 1;
    }
    index == a.len() && index == b.len()
}

impl<T: Copy + PartialEq> Typed for OneOf<T> {
    type Value = T;

    fn spec(&self) -> &ParamSpec {
        &self.spec
    }

    fn read(&self, number: f64) -> T {
        self.values[number as usize].0
    }

    fn number(&self, value: T) -> f64 {
        let index = self.values.iter().position(|(known, ..)| *known == value);
        index.expect("the value is one of the options") as f64
    }
}

impl<T> Deref for OneOf<T> {
    type Target = ParamSpec;

    fn deref(&self) -> &ParamSpec {
        &self.spec
    }
}
