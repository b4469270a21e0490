//! `--set NAME=VALUE`: a parameter of the estimator.

/// Parses `NAME=VALUE`.
///
/// # Errors
/// If there is no `=`, or no number after it.
pub fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    let value = value
        .parse()
        .map_err(|_| format!("{value} is not a number"))?;
    Ok((name.to_owned(), value))
}
