//! What the build needs besides cargo: found, or installed, or named in one line.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Failure, cargo, program, root, step};

/// Pinned: the glue that wasm-bindgen writes belongs to the crate of the very same version.
const WASM_BINDGEN: &str = "0.2.130";
const WASM_PACK: &str = "0.15.1";
/// What browsers run.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Makes sure that everything that builds the site is there.
///
/// # Errors
/// One line that says what is missing and how to get it.
pub fn ensure_build_tools() -> Result<(), Failure> {
    ensure_target()?;
    ensure_node()?;
    // Both install without their lock file: that of wasm-bindgen does not resolve any more.
    ensure_cargo_tool("wasm-bindgen", "wasm-bindgen-cli", WASM_BINDGEN)?;
    ensure_cargo_tool("wasm-pack", "wasm-pack", WASM_PACK)?;
    ensure_node_modules(&root().join("web"))
}

/// `wasm-pack build PACKAGE`, with our own tools first on its PATH.
///
/// Takes more options of cargo. Panic messages name sources, and so the module would hold
/// where this machine keeps cargo's registry: the compiler writes `cargo/registry/…` instead.
pub fn wasm_pack_build(package: &str, options: &[&str]) -> Command {
    let mut command = program("wasm-pack");
    command
        .args(["build", package, "--no-opt", "--no-pack"])
        .args(["--mode", "no-install"])
        .args(options)
        .arg("--")
        .env("PATH", path_with_tools());
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    if let Some(home) = home.or_else(|| Some(env::home_dir()?.join(".cargo"))) {
        command.args(["--config", &remapping(&home)]);
    }
    command
}

/// A setting for cargo; it is added to the flags of `.cargo/config.toml`.
fn remapping(cargo_home: &Path) -> String {
    format!(
        "target.{TARGET}.rustflags=['--remap-path-prefix={}=cargo']",
        cargo_home.display()
    )
}

/// The PATH with our own tools first.
pub fn path_with_tools() -> OsString {
    let inherited = env::var_os("PATH").unwrap_or_default();
    let paths = std::iter::once(tools().join("bin")).chain(env::split_paths(&inherited));
    env::join_paths(paths).unwrap_or(inherited)
}

/// A tool of LLVM that fits the compiler.
///
/// # Errors
/// One line on how to get it.
pub fn llvm_tool(name: &str) -> Result<PathBuf, Failure> {
    let missing = || {
        Failure::new(format!(
            "{name} is missing: `rustup component add llvm-tools` installs it"
        ))
    };
    let libraries = output(program("rustc").args(["--print", "target-libdir"]));
    let libraries = PathBuf::from(libraries.ok_or_else(missing)?);
    let folder = libraries.parent().ok_or_else(missing)?.join("bin");
    let tool = folder.join(format!("{name}{}", env::consts::EXE_SUFFIX));
    if !tool.is_file() {
        let mut install = program("rustup");
        step(
            "Installing LLVM's tools",
            install.args(["component", "add", "llvm-tools"]),
        )
        .map_err(|_| missing())?;
    }
    Ok(tool)
}

/// Where cargo puts the tools.
fn tools() -> PathBuf {
    root().join("target/tools")
}

/// The compiler with clippy's lints.
///
/// # Errors
/// One line on how to get it.
pub fn clippy_driver() -> Result<PathBuf, Failure> {
    let name = format!("clippy-driver{}", env::consts::EXE_SUFFIX);
    let driver = sysroot()?.join("bin").join(name);
    if driver.is_file() {
        return Ok(driver);
    }
    Err(Failure::new(
        "clippy is missing: `rustup component add clippy` installs it",
    ))
}

/// Makes every warning of clippy an error, as `cargo clippy -- -D warnings` says it to its driver.
pub fn deny_warnings(command: &mut Command) -> &mut Command {
    command.env(
        "CLIPPY_ARGS",
        ["-D", "warnings", ""].join("__CLIPPY_HACKERY__"),
    )
}

/// Where the toolchain is.
fn sysroot() -> Result<PathBuf, Failure> {
    output(program("rustc").args(["--print", "sysroot"]))
        .map(PathBuf::from)
        .ok_or_else(|| Failure::new("rustc is missing: install it from https://rustup.rs"))
}

fn ensure_target() -> Result<(), Failure> {
    if sysroot()?.join("lib/rustlib").join(TARGET).exists() {
        return Ok(());
    }
    if output(program("rustup").arg("--version")).is_none() {
        return Err(Failure::new(format!(
            "the Rust target {TARGET} is missing, and rustup, which installs it: https://rustup.rs"
        )));
    }
    step(
        "Installing the wasm target",
        program("rustup").args(["target", "add", TARGET]),
    )
    .map_err(|failure| {
        failure.with_way_out(&format!(
            "it needs the network: `rustup target add {TARGET}`"
        ))
    })
}

fn ensure_node() -> Result<(), Failure> {
    check_node(output(program("node").arg("--version")).as_deref())?;
    // Distributions package npm apart from Node.
    match output(program(npm()).arg("--version")) {
        Some(_) => Ok(()),
        None => Err(Failure::new(
            "npm is missing: the Node of https://nodejs.org brings it, \
             and Debian has it as `sudo apt-get install npm`",
        )),
    }
}

/// Takes what `node --version` printed, nothing where there is no Node.
fn check_node(version: Option<&str>) -> Result<(), Failure> {
    let version = version.ok_or_else(|| {
        Failure::new("Node is missing: install version 20 or later from https://nodejs.org")
    })?;
    let major = version
        .trim_start_matches('v')
        .split('.')
        .next()
        .and_then(|major| major.parse::<u32>().ok());
    match major {
        Some(major) if major >= 20 => Ok(()),
        _ => Err(Failure::new(format!(
            "Node {version} is too old: install version 20 or later from https://nodejs.org"
        ))),
    }
}

/// Installs a tool of cargo where no candidate has that version.
pub fn ensure_cargo_tool(name: &str, package: &str, version: &str) -> Result<(), Failure> {
    let installed = tools()
        .join("bin")
        .join(format!("{name}{}", env::consts::EXE_SUFFIX));
    for candidate in [installed.as_path(), Path::new(name)] {
        if has_version(candidate, version) {
            return Ok(());
        }
    }
    step(
        &format!("Installing {name} {version} into target/tools (once, about two minutes)"),
        cargo()
            .args(["install", package, "--version", version, "--root"])
            .arg(tools())
            // It runs for seconds and compiles for minutes: less optimization pays.
            .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")
            .env("CARGO_PROFILE_RELEASE_LTO", "off")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16")
            .env_remove("CARGO_TARGET_DIR"),
    )
    .map_err(|failure| {
        failure.with_way_out(&format!(
            "it needs the network and a C compiler; any {name} {version} on the PATH will do, too"
        ))
    })
}

fn has_version(tool: &Path, version: &str) -> bool {
    output(program(tool).arg("--version"))
        .is_some_and(|line| line.split_whitespace().any(|word| word == version))
}

/// `npm ci` where the lock file is newer than what it installed.
pub fn ensure_node_modules(folder: &Path) -> Result<(), Failure> {
    let modified = |path: PathBuf| fs::metadata(path).and_then(|meta| meta.modified()).ok();
    let wanted = modified(folder.join("package-lock.json"));
    let installed = modified(folder.join("node_modules/.package-lock.json"));
    if installed.is_some() && installed >= wanted {
        return Ok(());
    }
    let name = folder.strip_prefix(root()).unwrap_or(folder);
    step(
        &format!("Installing the npm packages of {}", name.display()),
        program(npm())
            .args(["ci", "--no-audit", "--no-fund"])
            .current_dir(folder),
    )
    .map_err(|failure| {
        let folder = name.display();
        failure.with_way_out(&format!(
            "it needs the network: `npm ci` in {folder}/ tries again"
        ))
    })
}

/// Installs nanoflann, a peer of the benchmark, as root on Debian; the benchmark runs without it
/// and says so.
pub fn ensure_nanoflann() {
    let is_root = output(program("id").arg("-u")).as_deref() == Some("0");
    if Path::new("/usr/include/nanoflann.hpp").exists() || !is_root {
        return;
    }
    let installed = step(
        "Installing nanoflann (apt-get, once)",
        program("apt-get").args(["install", "--yes", "g++", "libnanoflann-dev"]),
    );
    if let Err(failure) = installed {
        eprintln!("{failure}");
    }
}

/// npm is a script on Windows, which must be named in full.
pub fn npm() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}

/// The trimmed standard output of a program that succeeds.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_node_is_told_from_a_new_one_and_from_none() {
        assert!(check_node(Some("v20.0.0")).is_ok());
        assert!(check_node(Some("v26.1.0-nightly")).is_ok());
        let refused = |version| check_node(version).unwrap_err().to_string();
        assert!(refused(Some("v18.19.1")).starts_with("Node v18.19.1 is too old"));
        assert!(refused(Some("nonsense")).starts_with("Node nonsense is too old"));
        assert!(refused(None).starts_with("Node is missing"));
    }

    #[test]
    fn a_flag_for_cargo_keeps_spaces_and_backslashes_of_the_path() {
        let flag = remapping(Path::new(r"C:\Users\A B\.cargo"));
        let expected = r"target.wasm32-unknown-unknown.rustflags=['--remap-path-prefix=C:\Users\A B\.cargo=cargo']";
        assert_eq!(flag, expected);
    }
}
