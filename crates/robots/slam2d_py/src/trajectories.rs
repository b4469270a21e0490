//! Trajectories as files.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::PathBuf;

use pyo3::prelude::*;

use crate::errors::os_error;
use crate::evaluation::trajectory;

/// Writes poses as lines of TUM, `stamp x y 0 0 0 sin(θ/2) cos(θ/2)`, which evo reads.
///
/// stamps: s, shape (n,), ascending.
/// poses: shape (n, 3), m, m, rad.
///
/// Raises ArrayError for a wrong shape, OSError if the file cannot be written.
#[pyfunction]
pub fn save_tum(
    py: Python<'_>,
    path: PathBuf,
    stamps: &Bound<'_, PyAny>,
    poses: &Bound<'_, PyAny>,
) -> PyResult<()> {
    let trajectory = trajectory(["stamps", "poses"], stamps, poses)?;
    py.detach(|| {
        let write = || {
            let mut file = BufWriter::new(File::create(&path)?);
            trajectory.write_tum(&mut file)?;
            file.flush()
        };
        write().map_err(|error| os_error(&path, &error))
    })
}
