//! Finds or installs the tools that the commands need besides cargo, or reports how to get them.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use anyhow::{Context as _, bail};

use crate::run::{cargo, is_set, output, program, root, run};

/// The compilation target of browsers.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Versions of the tools. That of wasm-bindgen is in `web/bindgen/Cargo.toml`; the sizes in the README were measured
/// with these.
const WASM_PACK: &str = "0.15.1";
const CARGO_FUZZ: &str = "0.13.2";

/// Installs the wasm target and the npm packages if they are missing, and checks Node.
///
/// # Errors
/// What is missing and how to get it.
pub fn ensure_web_tools() -> anyhow::Result<()> {
    let sysroot = output(program("rustc").args(["--print", "sysroot"]))
        .context("rustc is missing: install it from https://rustup.rs")?;
    if !Path::new(&sysroot)
        .join("lib/rustlib")
        .join(TARGET)
        .exists()
    {
        let mut install = program("rustup");
        run(
            "Installing the wasm target",
            install.args(["target", "add", TARGET]),
        )
        .with_context(|| format!("`rustup target add {TARGET}` needs the network"))?;
    }
    check_node(output(program("node").arg("--version")).as_deref())?;
    ensure_node_modules("web")
}

/// Checks the output of `node --version`, if there is a Node.
fn check_node(version: Option<&str>) -> anyhow::Result<()> {
    let major = |version: &str| {
        version
            .trim_start_matches('v')
            .split('.')
            .next()?
            .parse()
            .ok()
    };
    match version {
        Some(version) if major(version).is_some_and(|major: u32| major >= 20) => Ok(()),
        Some(version) => bail!("Node {version} is too old: https://nodejs.org has 20 and later"),
        None => bail!("Node is missing: install 20 or later, with npm, from https://nodejs.org"),
    }
}

/// Runs `npm ci` in a folder of the project if the lock file is newer than the installed packages.
///
/// # Errors
/// If npm is missing or cannot install them.
pub fn ensure_node_modules(folder: &str) -> anyhow::Result<()> {
    let path = root().join(folder);
    let modified = |file: &str| fs::metadata(path.join(file)).and_then(|meta| meta.modified());
    let installed = modified("node_modules/.package-lock.json").ok();
    if installed.is_some() && installed >= modified("package-lock.json").ok() {
        return Ok(());
    }
    let mut install = program(npm());
    install
        .args(["ci", "--no-audit", "--no-fund"])
        .current_dir(path);
    run(
        &format!("Installing the npm packages of {folder}"),
        &mut install,
    )
    .with_context(|| format!("`npm ci` in {folder}/ needs npm and the network"))
}

/// The name of npm: on Windows it is a script, which needs its extension.
pub fn npm() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}

/// Compiles wasm-bindgen's command and installs wasm-pack if they are missing.
///
/// # Errors
/// If cargo cannot compile them.
pub fn ensure_wasm_pack() -> anyhow::Result<()> {
    let mut compile = cargo();
    compile.args(["build", "--quiet", "--package", "web_bindgen"]);
    compile.arg("--target-dir").arg(root().join("target"));
    run("Compiling wasm-bindgen", &mut compile)?;
    let name = format!("wasm-bindgen{}", env::consts::EXE_SUFFIX);
    let bin = root().join("target/tools/bin");
    fs::create_dir_all(&bin)?;
    fs::copy(root().join("target/debug").join(&name), bin.join(&name))?;
    ensure_cargo_tool("wasm-pack", WASM_PACK)
}

/// Installs cargo-fuzz.
///
/// # Errors
/// If cargo cannot install it.
pub fn ensure_cargo_fuzz() -> anyhow::Result<()> {
    ensure_cargo_tool("cargo-fuzz", CARGO_FUZZ)
}

/// Installs a tool without optimization, because it runs briefly and would take minutes to compile.
fn ensure_cargo_tool(name: &str, version: &str) -> anyhow::Result<()> {
    let mut version_of = program(name);
    let found = output(version_of.arg("--version").env("PATH", path_with_tools()));
    if found.is_some_and(|line| line.split_whitespace().any(|word| word == version)) {
        return Ok(());
    }
    let mut install = cargo();
    install
        .args(["install", "--quiet", "--debug", "--locked", "--force", name])
        .args(["--version", version, "--root"])
        .arg(root().join("target/tools"))
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env_remove("CARGO_TARGET_DIR");
    run(
        &format!("Installing {name} {version} into target/tools"),
        &mut install,
    )
    .with_context(|| {
        format!("it needs the network and a C compiler; {name} {version} on the PATH works too")
    })
}

/// Returns the PATH with the project's tools first.
pub fn path_with_tools() -> OsString {
    let inherited = env::var_os("PATH").unwrap_or_default();
    let tools = root().join("target/tools/bin");
    let paths = std::iter::once(tools).chain(env::split_paths(&inherited));
    env::join_paths(paths).unwrap_or(inherited)
}

/// Makes clippy the compiler of the workspace's crates and every warning an error.
///
/// It does for `cargo build` and `cargo test` what `cargo clippy -- -D warnings` does: one pass compiles and lints, and
/// third-party crates are not checked again.
///
/// # Errors
/// If clippy is missing.
pub fn linting(command: &mut Command) -> anyhow::Result<&mut Command> {
    let sysroot = output(program("rustc").args(["--print", "sysroot"])).unwrap_or_default();
    let name = format!("bin/clippy-driver{}", env::consts::EXE_SUFFIX);
    let driver = Path::new(&sysroot).join(name);
    if !driver.is_file() {
        bail!("clippy is missing: `rustup component add clippy` installs it");
    }
    Ok(command
        .env("RUSTC_WORKSPACE_WRAPPER", driver)
        .env(
            "CLIPPY_ARGS",
            "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__",
        )
        // Incremental compilation slows a clean build by a tenth.
        .env("CARGO_INCREMENTAL", "0"))
}

/// The engine without windows, by its name in Debian and Playwright; a page takes a sixth less time.
const SHELL: &str = "chromium-headless-shell";

/// Returns the Chromium for tests; installs it through apt-get as root on Debian.
///
/// # Errors
/// How to get one.
pub fn ensure_chromium_for_tests() -> anyhow::Result<PathBuf> {
    ensure_chromium(&[SHELL, "chromium"])
}

/// Returns the Chromium for measuring times, which readers have.
///
/// # Errors
/// How to get one.
pub fn ensure_chromium_for_times() -> anyhow::Result<PathBuf> {
    ensure_chromium(&["chromium"])
}

/// Debian's packages have the names of the programs.
fn ensure_chromium(packages: &[&str]) -> anyhow::Result<PathBuf> {
    const HOW: &str = "this needs Chromium: `sudo apt-get install chromium`, or set CHROMIUM to the path of a \
         Chromium or Chrome";
    if let Some(named) = env::var_os("CHROMIUM") {
        let path = PathBuf::from(named);
        if !path.is_file() {
            bail!("CHROMIUM is {path:?}, which is not a file: correct or unset it");
        }
        return Ok(path);
    }
    if let Some(path) = find_chromium(packages) {
        return Ok(path);
    }
    run(
        "Updating the package lists",
        program("apt-get").arg("update"),
    )
    .context(HOW)?;
    let mut attempts = packages.iter().map(|package| {
        let mut install = program("apt-get");
        install.args(["install", "--yes", "--no-install-recommends"]);
        install.args([package, "fonts-dejavu-core"]);
        run(&format!("Installing {package}"), &mut install)
    });
    attempts.find(Result::is_ok);
    find_chromium(packages).context(HOW)
}

fn find_chromium(packages: &[&str]) -> Option<PathBuf> {
    let elsewhere = [
        "chromium-browser",
        "google-chrome-stable",
        "google-chrome",
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    ];
    let folders: Vec<PathBuf> = env::split_paths(&env::var_os("PATH")?).collect();
    packages
        .iter()
        .chain(&elsewhere)
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|path| path.is_file())
}

/// Debian's packages of the engines besides Chromium, of their screen, and of their software renderer.
const ENGINES: [&str; 5] = [
    "firefox-esr",
    "webkit2gtk-driver",
    "xvfb",
    "libpci3",
    "libgl1-mesa-dri",
];

/// Installs Firefox and WebKit for the tests through apt-get, as root on Debian.
///
/// # Errors
/// How to get them on a build machine. Elsewhere a sentence says it, and the tests that need them are skipped.
pub fn ensure_engines() -> anyhow::Result<()> {
    if missing_engines().is_empty() {
        return Ok(());
    }
    let mut install = program("apt-get");
    // With what the packages recommend: WebKit without its plugins was not tried.
    install.args(["install", "--yes"]).args(ENGINES);
    let installed = run(
        "Updating the package lists",
        program("apt-get").arg("update"),
    )
    .and_then(|()| run("Installing Firefox and WebKit", &mut install));
    let missing = missing_engines();
    if missing.is_empty() {
        return Ok(());
    }
    let how = format!(
        "the tests in Firefox and WebKit need {}: `sudo apt-get install {}`",
        missing.join(", "),
        ENGINES.join(" ")
    );
    if is_set("CI") {
        return installed.context(how.clone()).and_then(|()| bail!("{how}"));
    }
    println!("── Skipped: {how}");
    Ok(())
}

/// Those of the packages that are not installed; all of them where there is no dpkg.
fn missing_engines() -> Vec<&'static str> {
    let is_installed = |package: &&str| {
        let mut query = program("dpkg-query");
        query.args(["--show", "--showformat=${db:Status-Status}", package]);
        output(&mut query).as_deref() == Some("installed")
    };
    let mut missing = ENGINES.to_vec();
    missing.retain(|package| !is_installed(package));
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_node_and_a_missing_one_are_rejected() {
        assert!(check_node(Some("v20.0.0")).is_ok());
        assert!(check_node(Some("v26.1.0-nightly")).is_ok());
        let rejected = |version| check_node(version).unwrap_err().to_string();
        assert!(rejected(Some("v18.19.1")).starts_with("Node v18.19.1 is too old"));
        assert!(rejected(Some("nonsense")).starts_with("Node nonsense is too old"));
        assert!(rejected(None).starts_with("Node is missing"));
    }

    #[test]
    fn the_command_of_wasm_bindgen_has_the_version_of_the_crate() {
        let manifest = |path: &str| fs::read_to_string(root().join(path)).unwrap();
        let (tool, workspace) = (manifest("web/bindgen/Cargo.toml"), manifest("Cargo.toml"));
        let version = |text: &str, before: &str| {
            let (_, tail) = text.split_once(before).unwrap();
            tail.split('"').next().unwrap().to_owned()
        };
        let pinned = version(&workspace, "\nwasm-bindgen = \"=");
        assert_eq!(version(&tool, "\nversion = \""), pinned);
        assert_eq!(version(&tool, "\nwasm-bindgen-cli-support = \"="), pinned);
    }
}
