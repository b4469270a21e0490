//! Atomic file writing: a reader sees either the old file or the new one.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Most symbolic links in a chain, as on Linux.
const MAX_LINKS: usize = 40;

/// Writes a file atomically.
///
/// # Errors
/// If the system cannot write it; the old file is unchanged then.
pub fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(content)?;
    file.finish()
}

/// A file being written, invisible before [`WholeFile::finish`].
///
/// A temporary file next to it replaces it, with its permissions. Symbolic links are kept and their target is
/// written. An existing target that is not a regular file, such as a pipe or a terminal, is written directly.
pub struct WholeFile {
    file: BufWriter<File>,
    /// Temporary file and target; `None` once it was renamed, or if the target is written directly.
    part: Option<[PathBuf; 2]>,
}

impl WholeFile {
    /// Creates the file; if it is dropped before it is finished, the old file is unchanged.
    ///
    /// # Errors
    /// If the system cannot create it.
    pub fn create(path: &Path) -> io::Result<Self> {
        let (path, old) = match fs::metadata(path) {
            Ok(old) if old.is_file() => (fs::canonicalize(path)?, Some(old)),
            Ok(_) => {
                let file = File::options().write(true).open(path)?;
                return Ok(Self {
                    file: BufWriter::new(file),
                    part: None,
                });
            }
            Err(error) if error.kind() == ErrorKind::NotFound => (end_of_links(path)?, None),
            Err(error) => return Err(error),
        };
        let mut part = path.as_os_str().to_owned();
        part.push(format!(".{}.part", std::process::id()));
        let part = PathBuf::from(part);
        let file = File::create(&part)?;
        let begun = Self {
            file: BufWriter::new(file),
            part: Some([part, path]),
        };
        if let Some(old) = old {
            // Before the content is written: it must not be readable with wider permissions than the old file.
            begun.file.get_ref().set_permissions(old.permissions())?;
        }
        Ok(begun)
    }

    /// Renames the temporary file to its target.
    ///
    /// # Errors
    /// If the system cannot rename it; the old file is unchanged then.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        if let Some([part, path]) = &self.part {
            self.file.get_ref().sync_all()?;
            fs::rename(part, path)?;
            self.part = None;
        }
        Ok(())
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if let Some([part, _]) = &self.part {
            // The write failed already; failing to remove the temporary file adds no information.
            let _ = fs::remove_file(part);
        }
    }
}

/// Checks whether a file can be written, before the work that it is for.
///
/// # Errors
/// If it cannot be written.
pub fn check_file(path: &Path) -> io::Result<()> {
    WholeFile::create(path).map(drop)
}

/// Checks the same for a folder, which need not exist yet.
///
/// # Errors
/// If it cannot be written.
pub fn check_folder(folder: &Path) -> io::Result<()> {
    let mut ancestors = folder.ancestors();
    let here = ancestors.find(|path| path.as_os_str().is_empty() || path.exists());
    let here = here.filter(|path| !path.as_os_str().is_empty());
    let here = here.unwrap_or(Path::new("."));
    if !here.is_dir() {
        return Err(ErrorKind::NotADirectory.into());
    }
    check_file(&here.join("session.slam2d"))
}

/// Target of a chain of symbolic links, which need not exist yet.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut end = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(target) = fs::read_link(&end) else {
            return Ok(end);
        };
        // An absolute target replaces the folder.
        end = end.parent().unwrap_or(Path::new("")).join(target);
    }
    Err(io::Error::other("too many levels of symbolic links"))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    use super::*;

    #[test]
    fn a_link_stays_and_what_it_points_at_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        fs::create_dir(&inner).unwrap();
        for target in ["old.g2o", "new.g2o"] {
            let link = folder.path().join(format!("to-{target}"));
            symlink(format!("inner/{target}"), &link).unwrap();
            let second = inner.join(format!("second-to-{target}"));
            symlink(format!("../to-{target}"), &second).unwrap();
            if target == "old.g2o" {
                fs::write(inner.join(target), "old").unwrap();
            }
            write_whole(&second, b"solved").unwrap();
            assert!(second.is_symlink() && link.is_symlink());
            assert_eq!(fs::read(inner.join(target)).unwrap(), b"solved");
        }
        // Two files and two links: no temporary file is left.
        assert_eq!(fs::read_dir(&inner).unwrap().count(), 4);
    }

    #[test]
    fn links_in_a_circle_are_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        symlink("link", &link).unwrap();
        assert!(write_whole(&link, b"solved").is_err());
        assert!(link.is_symlink());
    }

    #[test]
    fn a_file_keeps_its_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("solved.g2o");
        fs::write(&path, "old").unwrap();
        for mode in [0o600, 0o664] {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            write_whole(&path, b"solved").unwrap();
            assert_eq!(
                fs::metadata(&path).unwrap().permissions().mode() & 0o777,
                mode
            );
        }
        assert_eq!(fs::read(&path).unwrap(), b"solved");
    }

    #[test]
    fn a_folder_is_rejected() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_whole(folder.path(), b"solved").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
