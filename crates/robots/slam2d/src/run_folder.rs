//! The folder of a run: its files replace older ones all together, or not at all.
//!
//! A run that was cut short must not look like a whole one. Its quality.json and reports begin with a doubt that says so,
//! and if the folder has the result of a whole run, that stays and the part goes to the folder `interrupted` in it.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use robot_io::session::FILE_NAME;

/// Name of the file of keyframes.
pub const KEYFRAMES: &str = "keyframes.jsonl";
/// Name of the file of quality.
pub const QUALITY: &str = "quality.json";
/// First words of the doubt on a run that was cut short.
pub const CUT_SHORT: &str = "the run was cut short";
/// Folder for a part beside a whole result.
pub const OF_PARTS: &str = "interrupted";

/// All files that a run may write.
const NAMES: [&str; 10] = [
    "trajectory.tum",
    "graph.g2o",
    KEYFRAMES,
    "map.pgm",
    "map.png",
    "map.yaml",
    "report.txt",
    "report.html",
    FILE_NAME,
    QUALITY,
];

/// Where a run that was cut short is written: the folder, or one in it if the folder has a whole result.
pub fn folder_of_part(folder: &Path) -> PathBuf {
    let is_part = |text: String| text.contains(CUT_SHORT);
    let has_whole = NAMES.iter().any(|name| folder.join(name).exists())
        && !fs::read_to_string(folder.join(QUALITY)).is_ok_and(is_part);
    if has_whole {
        folder.join(OF_PARTS)
    } else {
        folder.to_owned()
    }
}

/// A folder that is being written, in a folder of its own inside until [`finish`](Self::finish).
pub struct RunFolder {
    folder: PathBuf,
    part: PathBuf,
    /// Folders that did not exist before, the innermost first.
    made: Vec<PathBuf>,
}

impl RunFolder {
    /// Begins to write a folder, which is created if needed; if this is dropped before it is finished, nothing changes.
    ///
    /// # Errors
    /// If the system cannot create it.
    pub fn create(folder: &Path) -> anyhow::Result<Self> {
        let folder = folder.to_owned();
        let part = folder.join(format!(".run-{}.part", std::process::id()));
        let is_new = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let made = folder.ancestors().take_while(is_new);
        let made = made.map(Path::to_owned).collect();
        let begun = Self { folder, part, made };
        fs::create_dir_all(&begun.part).map_err(|error| begun.error("", &error))?;
        Ok(begun)
    }

    /// Writes one of the files of a run.
    ///
    /// # Errors
    /// If the system cannot write it.
    pub fn save(
        &self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> anyhow::Result<()> {
        debug_assert!(NAMES.contains(&name), "{name} would not be replaced");
        let written = || {
            let mut file = BufWriter::with_capacity(1 << 16, File::create(self.part.join(name))?);
            write(&mut file)?;
            file.flush()?;
            file.get_ref().sync_all()
        };
        written().map_err(|error| self.error(name, &error))
    }

    /// Replaces the files of an older run; those that this run did not write are removed.
    ///
    /// # Errors
    /// If the system cannot replace a file.
    pub fn finish(mut self) -> anyhow::Result<()> {
        self.made.clear();
        for name in NAMES {
            let moved = match fs::rename(self.part.join(name), self.folder.join(name)) {
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    match fs::remove_file(self.folder.join(name)) {
                        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
                        other => other,
                    }
                }
                other => other,
            };
            moved.map_err(|error| self.error(name, &error))?;
        }
        Ok(())
    }

    /// Removes the part of an earlier run, which a whole one now replaces.
    pub fn forget_parts(&self) {
        let parts = self.folder.join(OF_PARTS);
        for name in NAMES {
            let _ = fs::remove_file(parts.join(name));
        }
        // A folder with files of somebody else stays.
        let _ = fs::remove_dir(parts);
    }

    fn error(&self, name: &str, error: &io::Error) -> anyhow::Error {
        anyhow!(
            "{}: {error}; nothing was replaced",
            self.folder.join(name).display()
        )
    }
}

impl Drop for RunFolder {
    fn drop(&mut self) {
        // A failure to clean up adds no information.
        let _ = fs::remove_dir_all(&self.part);
        for folder in &self.made {
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn full() -> io::Result<()> {
        Err(ErrorKind::StorageFull.into())
    }

    #[test]
    fn a_full_disk_leaves_the_older_result_whole_and_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let run = folder.path().join("a/run");
        let begun = RunFolder::create(&run).unwrap();
        begun.save(QUALITY, |out| out.write_all(b"old")).unwrap();
        begun.save("map.pgm", |out| out.write_all(b"old")).unwrap();
        begun.finish().unwrap();
        let again = RunFolder::create(&run).unwrap();
        again.save(QUALITY, |out| out.write_all(b"new")).unwrap();
        let error = again.save("map.pgm", |_| full()).unwrap_err().to_string();
        assert!(error.contains("map.pgm: ") && error.ends_with("; nothing was replaced"));
        drop(again);
        assert_eq!(fs::read(run.join(QUALITY)).unwrap(), b"old");
        assert_eq!(fs::read_dir(&run).unwrap().count(), 2);
        let other = RunFolder::create(&folder.path().join("b/run")).unwrap();
        assert!(other.save("map.pgm", |_| full()).is_err());
        drop(other);
        assert!(!folder.path().join("b").exists());
    }

    #[test]
    fn a_file_that_the_run_did_not_write_does_not_stay_from_an_older_one() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["map.pgm", "mine.txt"] {
            fs::write(folder.path().join(name), "old").unwrap();
        }
        let begun = RunFolder::create(folder.path()).unwrap();
        begun.save(QUALITY, |out| out.write_all(b"{}")).unwrap();
        begun.finish().unwrap();
        assert!(!folder.path().join("map.pgm").exists());
        assert!(folder.path().join("mine.txt").exists());
    }

    #[test]
    fn a_part_goes_beside_a_whole_result_and_over_another_part() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        assert_eq!(folder_of_part(path), path);
        fs::write(
            path.join(QUALITY),
            format!("{{\"doubts\":[\"{CUT_SHORT} after 3 scans\"]}}"),
        )
        .unwrap();
        assert_eq!(folder_of_part(path), path);
        fs::write(path.join(QUALITY), "{}").unwrap();
        assert_eq!(folder_of_part(path), path.join(OF_PARTS));
    }
}
