//! The Python packages: an environment for their tests, and the piece of the suite that runs those.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use anyhow::{Context as _, bail};

use crate::run::{is_set, program, root, run};
use crate::tools::linting;

/// What the tests need, one requirement of pip a line.
const REQUIREMENTS: &str = "crates/slam2d_py/requirements.txt";

/// Said where there is no environment, because pip has no way to fill one.
const NO_REGISTRY: &str =
    "pip reaches no package registry; connect to the network, or set PIP_INDEX_URL to one";

/// What the tests with other packages of Python need; none where no registry can be reached.
#[derive(Debug)]
pub struct Environment {
    /// The interpreter that has them.
    python: PathBuf,
}

/// Makes an environment in `target/python`, or takes the one that is there.
///
/// # Errors
/// If there is no Python, or it has no venv, or what the tests need cannot be installed though a registry is there.
pub fn ensure_environment() -> anyhow::Result<Option<Environment>> {
    let folder = root().join("target/python/venv");
    let inside = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    let environment = Environment {
        python: folder.join(inside),
    };
    let wanted = fs::read_to_string(root().join(REQUIREMENTS))?;
    let stamp = folder.join("installed.txt");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(Some(environment));
    }
    let base = env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let mut make = program(&base);
    make.args(["-m", "venv", "--clear"]).arg(&folder);
    run("Making an environment for Python", &mut make).with_context(|| {
        format!(
            "{} makes no environment: install Python 3.10 or later with venv, or name one by PYTHON",
            base.display()
        )
    })?;
    let mut install = environment.pip();
    install.args(["install", "--quiet", "--requirement", REQUIREMENTS]);
    println!("\n── Installing what the Python tests need into target/python");
    let output = install.output().context("pip cannot be started")?;
    if output.status.success() {
        fs::write(stamp, wanted)?;
        return Ok(Some(environment));
    }
    let said = String::from_utf8_lossy(&output.stderr);
    if is_unreachable(&said) {
        println!("── {NO_REGISTRY}");
        return Ok(None);
    }
    bail!("pip cannot install {REQUIREMENTS}:\n{said}")
}

/// Whether pip failed because it reached no registry: it says so before each new attempt.
fn is_unreachable(said: &str) -> bool {
    said.contains("WARNING: Retrying (")
}

impl Environment {
    /// Tells a command's tests of the interpreter.
    pub fn tell(&self, command: &mut Command) {
        command.env("PYTHON", &self.python);
    }

    fn python(&self) -> Command {
        let mut python = program(&self.python);
        let folder = root().join("target/python");
        // Notebooks leave the reader's own settings alone.
        python
            .env("JUPYTER_CONFIG_DIR", folder.join("jupyter"))
            .env("JUPYTER_DATA_DIR", folder.join("jupyter"))
            .env("IPYTHONDIR", folder.join("ipython"));
        python
    }

    fn pip(&self) -> Command {
        let mut pip = self.python();
        pip.args(["-m", "pip", "--disable-pip-version-check"]);
        pip
    }

    /// Installs the only wheel of a folder whose name starts so.
    fn install(&self, folder: &Path, name: &str) -> anyhow::Result<()> {
        let wheels = fs::read_dir(folder)?.flatten().map(|entry| entry.path());
        let wheel = wheels.filter(|path| path.extension().is_some_and(|end| end == "whl"));
        let is_it = |path: &PathBuf| {
            let file = path.file_name().unwrap_or_default();
            file.to_string_lossy().starts_with(name)
        };
        let wheel = wheel.into_iter().find(is_it);
        let wheel = wheel.with_context(|| format!("{} holds no {name}", folder.display()))?;
        let mut install = self.pip();
        install.args([
            "install",
            "--quiet",
            "--no-index",
            "--no-deps",
            "--force-reinstall",
        ]);
        run(&format!("Installing {name}"), install.arg(wheel))
    }

    /// Compiles `rustslam2d` as a wheel and installs it: the core is optimized and checks its overflows, as for all
    /// tests.
    fn install_rustslam2d(&self) -> anyhow::Result<()> {
        let wheels = root().join("target/python/wheels");
        if wheels.exists() {
            // One of another system's tag may be there.
            fs::remove_dir_all(&wheels)?;
        }
        let mut build = self.python();
        linting(&mut build)?
            .args([
                "-m",
                "maturin",
                "build",
                "--quiet",
                "--locked",
                "--profile=dev",
            ])
            .args([
                "--manifest-path",
                "crates/slam2d_py/Cargo.toml",
                "--interpreter",
            ])
            .arg(&self.python)
            .arg("--out")
            .arg(&wheels);
        run("Compiling and linting the Python package", &mut build)?;
        self.install(&wheels, "rustslam2d")
    }

    /// Installs the widgets for notebooks out of the site, if it was built.
    fn install_widgets(&self) -> anyhow::Result<bool> {
        if !root().join("dist/schema.json").is_file() {
            return Ok(false);
        }
        let mut pack = program("node");
        pack.args(["web/package.mjs", "dist", "target/packages"]);
        self.tell(&mut pack);
        run("Packing the widgets for notebooks", &mut pack)?;
        self.install(&root().join("target/packages"), "slam_widgets")?;
        Ok(true)
    }
}

/// `cargo xtask test python`: the package `rustslam2d` as somebody gets it, and the notebooks that use it. The command
/// `slam2d`, whose bits it has to have, lies in `programs`.
///
/// # Errors
/// The step that failed.
pub fn test(
    environment: Option<&Environment>,
    programs: &Path,
    skipped: &Path,
) -> anyhow::Result<()> {
    let Some(environment) = environment else {
        return leave_out("the Python package and its notebooks", NO_REGISTRY, skipped);
    };
    environment.install_rustslam2d()?;
    if !environment.install_widgets()? {
        let reason = "dist/ holds no site; `cargo xtask build` makes one";
        leave_out("the widgets in the notebooks", reason, skipped)?;
    }
    for (what, arguments) in [
        (
            "Tests of the Python package",
            &["crates/slam2d_py/tests"][..],
        ),
        ("Notebooks", &["--nbmake", "crates/slam2d_py/notebooks"]),
    ] {
        let mut test = environment.python();
        test.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"])
            .args(arguments)
            .env("SLAM_NATIVE", programs)
            .env("SLAM_SKIPPED", skipped)
            .env("PYTHONDONTWRITEBYTECODE", "1");
        run(what, &mut test)?;
    }
    Ok(())
}

/// Says that something is left out, by the rules of `docs/testing.md`.
fn leave_out(what: &str, reason: &str, skipped: &Path) -> anyhow::Result<()> {
    if is_set("SLAM_NO_SKIP") {
        bail!("{what}: {reason}, and SLAM_NO_SKIP lets nothing skip");
    }
    let mut list = OpenOptions::new().append(true).create(true).open(skipped)?;
    Ok(writeln!(list, "{what}: {reason}")?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_registry_that_cannot_be_reached_is_told_from_a_package_that_does_not_exist() {
        let unreachable = "WARNING: Retrying (Retry(total=4)) after connection broken by \
             'NewConnectionError(': [Errno -3] Temporary failure in name resolution')': /simple/numpy/\n\
             ERROR: Could not find a version that satisfies the requirement numpy";
        assert!(is_unreachable(unreachable));
        assert!(!is_unreachable(
            "ERROR: Could not find a version that satisfies the requirement numpi"
        ));
    }

    #[test]
    fn what_is_left_out_is_on_the_list() {
        let list = env::temp_dir().join(format!("slam-left-out-{}", std::process::id()));
        let done = leave_out("a notebook", "no network", &list);
        let written = fs::read_to_string(&list).unwrap_or_default();
        // Where nothing may skip it is refused.
        match done {
            Ok(()) => assert_eq!(written, "a notebook: no network\n"),
            Err(error) => assert!(error.to_string().ends_with("lets nothing skip")),
        }
        let _ = fs::remove_file(list);
    }
}
