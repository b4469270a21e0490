//! The browser of the browser tests: found, or installed, or named in one line.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::run::{Failure, program, step};
use crate::tools::output;

const HOW_TO_GET_IT: &str = "`sudo apt-get install chromium`, \
     or set CHROMIUM to the path of a Chromium or Chrome";

/// What a Chromium is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Tests: the engine without the windows around it will do, and takes a sixth less for a page.
    ForTests,
    /// Times: the browser that readers have.
    ForTimes,
}

/// The engine alone, as Debian and Playwright name it.
const SHELL: &str = "chromium-headless-shell";

impl Wanted {
    /// Programs that will do, the best first.
    fn programs(self) -> impl Iterator<Item = &'static str> {
        let shell = (self == Self::ForTests).then_some(SHELL);
        shell.into_iter().chain([
            "chromium",
            "chromium-browser",
            "google-chrome-stable",
            "google-chrome",
        ])
    }

    /// Debian's packages that hold one, the best first.
    fn packages(self) -> &'static [&'static str] {
        match self {
            Self::ForTests => &[SHELL, "chromium"],
            Self::ForTimes => &["chromium"],
        }
    }
}

/// A Chromium; installed through apt-get as root on Debian.
///
/// # Errors
/// One line on how to get it.
pub fn ensure_chromium(wanted: Wanted) -> Result<PathBuf, Failure> {
    if let Some(path) = find(wanted)? {
        return Ok(path);
    }
    let missing = || Failure::new(format!("this needs Chromium: {HOW_TO_GET_IT}"));
    let is_root = output(program("id").arg("-u")).as_deref() == Some("0");
    if !is_root || output(program("apt-get").arg("--version")).is_none() {
        return Err(missing());
    }
    let update = step(
        "Updating the package lists",
        program("apt-get").arg("update"),
    );
    update
        .and_then(|()| install(wanted))
        .map_err(|failure| failure.with_way_out(HOW_TO_GET_IT))?;
    find(wanted)?.ok_or_else(missing)
}

/// Installs the best of the packages that the lists have.
fn install(wanted: Wanted) -> Result<(), Failure> {
    let is_listed = |package: &&&str| {
        output(program("apt-cache").args(["show", "--no-all-versions", package])).is_some()
    };
    let packages = wanted.packages();
    let package = packages.iter().find(is_listed).unwrap_or(&"chromium");
    step(
        "Installing Chromium (apt-get, once)",
        program("apt-get").args([
            "install",
            "--yes",
            "--no-install-recommends",
            package,
            "fonts-dejavu-core",
        ]),
    )
}

fn find(wanted: Wanted) -> Result<Option<PathBuf>, Failure> {
    match env::var_os("CHROMIUM") {
        Some(named) => existing(named).map(Some),
        None => Ok(on_path(wanted).or_else(in_applications)),
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

fn on_path(wanted: Wanted) -> Option<PathBuf> {
    let inherited = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = env::split_paths(&inherited).collect();
    wanted
        .programs()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
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
    fn times_are_of_the_browser_that_readers_have() {
        assert_eq!(Wanted::ForTests.programs().next(), Some(SHELL));
        assert!(Wanted::ForTimes.programs().all(|name| name != SHELL));
        assert!(!Wanted::ForTimes.packages().contains(&SHELL));
    }

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
