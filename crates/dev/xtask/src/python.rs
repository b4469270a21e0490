//! The Python packages: an environment for their tests, and the piece of the suite that runs them.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::available_parallelism;
use std::{env, fs};

use anyhow::{Context as _, bail};

use crate::run::{is_set, program, root, run};
use crate::tools::linting;

/// Requirements of the tests, one per line.
const REQUIREMENTS: &str = "crates/robots/slam2d_py/requirements.txt";

/// Files for GitHub, with the schema that each has to pass.
const SCHEMAS: [(&str, &[&str]); 3] = [
    (
        "vendor.github-workflows",
        &[
            ".github/workflows/advisories.yml",
            ".github/workflows/checks.yml",
            ".github/workflows/release.yml",
            "teaching/guide/classroom-ci.yml",
            "teaching/guide/classroom-python-ci.yml",
        ],
    ),
    (
        "vendor.github-issue-forms",
        &[
            ".github/ISSUE_TEMPLATE/page.yml",
            ".github/ISSUE_TEMPLATE/recording.yml",
        ],
    ),
    ("vendor.citation-file-format", &["CITATION.cff"]),
];

/// The reason of a skip if pip cannot install the requirements.
const NO_REGISTRY: &str =
    "pip reaches no package registry; connect to the network, or set PIP_INDEX_URL to one";

/// A virtual environment with the requirements.
#[derive(Debug)]
pub struct Environment {
    /// Its interpreter.
    python: PathBuf,
}

/// Creates the environment in `target/python`, or reuses it; `None` if no package registry can be reached.
///
/// # Errors
/// If Python or its venv is missing, or a requirement cannot be installed although a registry can be reached.
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
    let errors = String::from_utf8_lossy(&output.stderr);
    if is_unreachable(&errors) {
        println!("── {NO_REGISTRY}");
        return Ok(None);
    }
    bail!("pip cannot install {REQUIREMENTS}:\n{errors}")
}

/// Whether pip failed because it reached no registry: it prints a warning before each new attempt.
fn is_unreachable(errors: &str) -> bool {
    errors.contains("WARNING: Retrying (")
}

impl Environment {
    /// Passes the interpreter to the tests of a command.
    pub fn pass_to(&self, command: &mut Command) {
        command.env("PYTHON", &self.python);
    }

    fn python(&self) -> Command {
        let mut python = program(&self.python);
        let folder = root().join("target/python");
        // Notebooks must not change the user's settings.
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

    /// Installs the only wheel of a folder whose name starts with `name`.
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

    /// Compiles `rustslam2d` as a wheel and installs it. The core is optimized and has overflow checks, as in all tests.
    fn install_rustslam2d(&self) -> anyhow::Result<()> {
        let wheels = root().join("target/python/wheels");
        if wheels.exists() {
            // It may contain a wheel for another system.
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
                "crates/robots/slam2d_py/Cargo.toml",
                "--interpreter",
            ])
            .arg(&self.python)
            .arg("--out")
            .arg(&wheels);
        run("Compiling and linting the Python package", &mut build)?;
        self.install(&wheels, "rustslam2d")
    }

    /// Installs the widgets for notebooks from the site, if it was built.
    fn install_widgets(&self) -> anyhow::Result<bool> {
        if !root().join("dist/schema.json").is_file() {
            return Ok(false);
        }
        let mut pack = program("node");
        pack.args(["web/package.mjs", "dist", "target/packages"]);
        self.pass_to(&mut pack);
        run("Packing the widgets for notebooks", &mut pack)?;
        self.install(&root().join("target/packages"), "slam_widgets")?;
        Ok(true)
    }
}

/// `cargo xtask test python`: tests the installed package `rustslam2d` and the notebooks that use it. `programs` contains
/// the commands with which results are compared bit by bit.
///
/// # Errors
/// The step that failed.
pub fn test(
    environment: Option<&Environment>,
    programs: &Path,
    skipped: &Path,
) -> anyhow::Result<()> {
    let Some(environment) = environment else {
        return skip("the Python package and its notebooks", NO_REGISTRY, skipped);
    };
    for (schema, files) in SCHEMAS {
        let mut check = environment.python();
        check
            .args(["-m", "check_jsonschema", "--quiet", "--builtin-schema"])
            .arg(schema)
            .args(files);
        run(&format!("Checking {}", files.join(", ")), &mut check)?;
    }
    environment.install_rustslam2d()?;
    if !environment.install_widgets()? {
        let reason = "dist/ holds no site; `cargo xtask build` makes one";
        skip("the widgets in the notebooks", reason, skipped)?;
    }
    let cores = format!("--numprocesses={}", available_parallelism()?);
    for (what, arguments) in [
        (
            "Tests of the Python package",
            &[&cores, "--dist=worksteal", "crates/robots/slam2d_py/tests"][..],
        ),
        (
            "Notebooks",
            &["--nbmake", "crates/robots/slam2d_py/notebooks"],
        ),
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

/// Records a skip by the rules of `docs/testing.md`.
fn skip(what: &str, reason: &str, skipped: &Path) -> anyhow::Result<()> {
    if is_set("SLAM_NO_SKIP") {
        bail!("{what}: {reason}, and SLAM_NO_SKIP forbids skips");
    }
    let mut list = OpenOptions::new().append(true).create(true).open(skipped)?;
    Ok(writeln!(list, "{what}: {reason}")?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unreachable_registry_is_distinguished_from_a_missing_package() {
        let unreachable = "WARNING: Retrying (Retry(total=4)) after connection broken by \
             'NewConnectionError(': [Errno -3] Temporary failure in name resolution')': /simple/numpy/\n\
             ERROR: Could not find a version that satisfies the requirement numpy";
        assert!(is_unreachable(unreachable));
        assert!(!is_unreachable(
            "ERROR: Could not find a version that satisfies the requirement numpi"
        ));
    }

    #[test]
    fn a_skip_is_recorded() {
        let list = env::temp_dir().join(format!("slam-left-out-{}", std::process::id()));
        let done = skip("a notebook", "no network", &list);
        let written = fs::read_to_string(&list).unwrap_or_default();
        // An error if skips are forbidden.
        match done {
            Ok(()) => assert_eq!(written, "a notebook: no network\n"),
            Err(error) => assert!(error.to_string().ends_with("forbids skips")),
        }
        let _ = fs::remove_file(list);
    }
}
