//! Reads a session from a file, or from the folder of a run.

use std::fs;
use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use anyhow::ensure;
use robot_io::session::{FILE_NAME, MAX_BYTES, Session, SessionError};

use command_line::log_file::open;

/// The session file of a path: the file itself, or the one in the folder of a run.
pub fn session_path(path: &Path) -> PathBuf {
    if path.is_dir() {
        path.join(FILE_NAME)
    } else {
        path.to_owned()
    }
}

/// Whether a path is a session and not a log, by its name, its folder or its first bytes.
pub fn is_session(path: &Path) -> bool {
    if path.is_dir() {
        return path.join(FILE_NAME).is_file();
    }
    let named = path.extension().is_some_and(|end| end == "slam2d");
    // What is read from a pipe is gone.
    let may_look = path.is_file();
    named || may_look && open(path).is_ok_and(|mut file| file.fill_buf().is_ok_and(Session::begins))
}

/// Reads a session and returns it with its size in bytes.
///
/// # Errors
/// If it cannot be used.
pub fn read_session(path: &Path) -> anyhow::Result<(Session, u64)> {
    let file = session_path(path);
    ensure!(
        !path.is_dir() || file.is_file(),
        "{} has no {FILE_NAME}; pass a session, or a folder that slam2d run LOG -o DIR wrote",
        path.display()
    );
    let name = file.display().to_string();
    let source = open(&file)?;
    let bytes = fs::metadata(&file).map_or(0, |about| about.len());
    if bytes > MAX_BYTES {
        return Err(SessionError::TooLarge { name }.into());
    }
    let session = Session::read(source.take(MAX_BYTES + 1), &name)?;
    Ok((session, bytes))
}
