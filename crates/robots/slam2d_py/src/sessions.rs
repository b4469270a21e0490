//! Sessions: the state of an estimator as a file.

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::PathBuf;

use pyo3::prelude::*;
use robot_io::session::{FILE_NAME, MAX_BYTES, Session};

use crate::errors::{LogError, os_error};

/// Reads a session from its file, or from the folder of a run.
pub fn session(path: PathBuf) -> PyResult<Session> {
    let path = if path.is_dir() {
        path.join(FILE_NAME)
    } else {
        path
    };
    let file = File::open(&path).map_err(|error| os_error(&path, &error))?;
    let file = BufReader::new(file).take(MAX_BYTES + 1);
    let session = Session::read(file, &path.display().to_string());
    session.map_err(|error| LogError::new_err(error.to_string()))
}
