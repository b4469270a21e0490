//! The browser of the browser tests: found, or installed, or named in one line.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::run::{Failure, program, step};
use crate::tools::output;

const HOW_TO_GET_IT: &str = "`sudo apt-get install chromium`, \
     or set CHROMIUM to the path of a Chromium or Chrome";

/// A Chromium for the browser tests; installed through apt-get as root on Debian.
///
/// # Errors
/// One line on how to get it.
pub fn ensure_chromium() -> Result<PathBuf, Failure> {
    if let Some(path) = find()? {
        return Ok(path);
    }
    let missing = || Failure::new(format!("the browser tests need Chromium: {HOW_TO_GET_IT}"));
    let is_root = output(program("id").arg("-u")).as_deref() == Some("0");
    if !is_root || output(program("apt-get").arg("--version")).is_none() {
        return Err(missing());
    }
    step(
        "Updating the package lists",
        program("apt-get").arg("update"),
    )
    .and_then(|()| {
        step(
            "Installing Chromium (apt-get, once)",
            program("apt-get").args([
                "install",
                "--yes",
                "--no-install-recommends",
                "chromium",
                "fonts-dejavu-core",
            ]),
        )
    })
    .map_err(|failure| failure.with_way_out(HOW_TO_GET_IT))?;
    find()?.ok_or_else(missing)
}

fn find() -> Result<Option<PathBuf>, Failure> {
    match env::var_os("CHROMIUM") {
        Some(named) => existing(named).map(Some),
        None => Ok(on_path().or_else(in_applications)),
    }
}

/// What CHROMIUM names; a wrong name is told, not passed over for another browser.
fn existing(named: OsString) -> Result<PathBuf, Failure> {
    let path = PathBuf::from(named);
    if path.is_file() {
        return Ok(path);
    }
    let what = if path.exists() {
        "is no file"
    } else {
        "does not exist"
    };
    Err(Failure::new(format!(
        "CHROMIUM names {:?}, which {what}: set it to the path of a Chromium or Chrome, or unset it",
        path.display().to_string()
    )))
}

fn on_path() -> Option<PathBuf> {
    let names = [
        "chromium",
        "chromium-browser",
        "google-chrome-stable",
        "google-chrome",
    ];
    let inherited = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&inherited)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file())
}

fn in_applications() -> Option<PathBuf> {
    let path = Path::new("/Applications/Google Chrome.app/Contents/MacOS/Google Chrome");
    path.exists().then(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::root;

    #[test]
    fn a_wrong_chromium_is_named_with_what_is_wrong() {
        let refused = |named: &Path| existing(named.into()).unwrap_err().to_string();
        let absent = refused(Path::new("/absent/chromium"));
        assert!(absent.starts_with("CHROMIUM names \"/absent/chromium\", which does not exist"));
        assert!(refused(Path::new("")).contains("names \"\", which does not exist"));
        assert!(refused(&root()).contains("which is no file"));
        let file = root().join("Cargo.toml");
        assert_eq!(existing(file.clone().into()).unwrap(), file);
    }
}
