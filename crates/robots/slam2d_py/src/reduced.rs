//! Pickling: a result is reduced to its fields, what can be computed again to its arguments.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// What `__reduce__` returns: the function that restores, and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// A class whose attributes restore it.
pub trait Restorable: PyClass {
    /// Names of these attributes.
    const ATTRIBUTES: &'static [&'static str];

    /// An object with these attributes.
    fn restore<'py>(py: Python<'py>, fields: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>>;
}

/// Implements [`Restorable`] for a class by its fields.
macro_rules! restorable {
    ($class:ident { $($field:ident),+ $(,)? }) => {
        impl $crate::reduced::Restorable for $class {
            const ATTRIBUTES: &'static [&'static str] = &[$(stringify!($field)),+];

            fn restore<'py>(
                py: Python<'py>,
                fields: &Bound<'py, pyo3::types::PyDict>,
            ) -> PyResult<Bound<'py, PyAny>> {
                use pyo3::types::PyDictMethods as _;
                let field = |name: &str| {
                    fields.get_item(name)?.ok_or_else(|| {
                        $crate::errors::ChoiceError::new_err(format!(
                            "the pickled {} has no {name}",
                            stringify!($class)
                        ))
                    })
                };
                let made = $class { $($field: field(stringify!($field))?.extract()?),+ };
                Ok(Bound::new(py, made)?.into_any())
            }
        }
    };
}

pub(crate) use restorable;

/// Reduces a result to its attributes.
pub fn by_attributes<'py, T: Restorable>(thing: &Bound<'py, T>) -> PyResult<Reduced<'py>> {
    let fields = PyDict::new(thing.py());
    for name in T::ATTRIBUTES {
        fields.set_item(name, thing.as_any().getattr(*name)?)?;
    }
    let class = thing.as_any().get_type().name()?.to_string();
    by_keywords(&class, fields)
}

/// Reduces an object to keywords of the function that makes it.
pub fn by_keywords<'py>(class: &str, keywords: Bound<'py, PyDict>) -> PyResult<Reduced<'py>> {
    let py = keywords.py();
    let restored = py.import("rustslam2d._rustslam2d")?.getattr("_restored")?;
    Ok((restored, (class, keywords).into_pyobject(py)?))
}
