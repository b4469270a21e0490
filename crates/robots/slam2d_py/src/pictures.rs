//! Pictures by matplotlib, which is optional: `python/rustslam2d/_pictures.py` draws them.

use pyo3::prelude::*;

/// Draws `thing` by the function of that name into `ax`, or into new axes, which it returns.
pub fn draw(
    name: &str,
    thing: Bound<'_, PyAny>,
    ax: Option<Bound<'_, PyAny>>,
) -> PyResult<Py<PyAny>> {
    let pictures = thing.py().import("rustslam2d._pictures")?;
    Ok(pictures.call_method1(name, (thing, ax))?.unbind())
}
