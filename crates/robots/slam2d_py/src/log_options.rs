//! Options of a log and of a robot that drives, as Python gives them.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyTuple};
use robot_io::log::{LogOption, LogOptions};
use robot_io::motion::OdometryUse;

use crate::errors::ChoiceError;

/// A dict of the variables, by their names.
macro_rules! keywords {
    ($py:expr; $($name:ident),+ $(,)?) => {{
        let keywords = pyo3::types::PyDict::new($py);
        $(keywords.set_item(stringify!($name), &$name)?;)+
        keywords
    }};
}
pub(crate) use keywords;

/// The options among these keywords; or `ChoiceError`.
pub fn options(keywords: &Bound<'_, PyDict>) -> PyResult<LogOptions> {
    let mut given: Vec<(String, String)> = Vec::new();
    for option in LogOption::ALL {
        let name = option.name().replace('-', "_");
        let value = keywords.get_item(&name)?.filter(|value| !value.is_none());
        if let Some(text) = value.map(|value| text_of(option, &value)).transpose()? {
            given.extend(text.map(|text| (name, text)));
        }
    }
    let pairs = given
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()));
    LogOptions::read(pairs).map_err(ChoiceError::new_err)
}

/// A value as the command reads it; `None` if the option is not set.
fn text_of(option: LogOption, value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if let Ok(is_set) = value.cast::<PyBool>() {
        return Ok(match (option, is_set.is_true()) {
            (LogOption::Odometry, true) => Some(OdometryUse::Check.name().to_owned()),
            (LogOption::Odometry, false) => Some(OdometryUse::Ignore.name().to_owned()),
            (_, is_set) => is_set.then(String::new),
        });
    }
    if let Ok(numbers) = value.cast::<PyTuple>() {
        let words: PyResult<Vec<String>> = numbers.iter().map(|number| word(&number)).collect();
        return Ok(Some(words?.join(",")));
    }
    word(value).map(Some)
}

fn word(value: &Bound<'_, PyAny>) -> PyResult<String> {
    value.str()?.extract()
}
