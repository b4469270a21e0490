//! Writing a file whole: a reader sees either the old one or the new one, never half of it.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// Most links that lead from one to the next, as on Linux.
const MAX_LINKS: usize = 40;

/// Writes a file so that a reader sees either the old one or the whole new one.
///
/// A part file beside it takes its place, with its permissions. Links stay and what they point at is
/// written. What exists and is no regular file, as a pipe or a terminal, is written directly.
///
/// # Errors
/// What the system says; then the old file is as it was.
pub fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(old) if old.is_file() => replace(&fs::canonicalize(path)?, Some(&old), content),
        Ok(_) => File::options().write(true).open(path)?.write_all(content),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            replace(&end_of_links(path)?, None, content)
        }
        Err(error) => Err(error),
    }
}

/// Where a file is made that links point at and that does not exist yet.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut end = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(target) = fs::read_link(&end) else {
            return Ok(end);
        };
        // An absolute target replaces the folder.
        end = end.parent().unwrap_or(Path::new("")).join(target);
    }
    Err(io::Error::other("too many links lead from one to the next"))
}

fn replace(path: &Path, old: Option<&Metadata>, content: &[u8]) -> io::Result<()> {
    let mut part = path.as_os_str().to_owned();
    part.push(format!(".{}.part", std::process::id()));
    let part = PathBuf::from(part);
    let written = write_synced(&part, old, content).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        // The write has failed already: that the rest cannot be removed either adds nothing.
        let _ = fs::remove_file(&part);
    }
    written
}

fn write_synced(path: &Path, old: Option<&Metadata>, content: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    if let Some(old) = old {
        // Before the content: nobody may read it who may not read the old one.
        file.set_permissions(old.permissions())?;
    }
    file.write_all(content)?;
    file.sync_all()
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
        // Two files and two links: no part is left.
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
    fn a_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_whole(folder.path(), b"solved").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
