//! Builds the finished site in `dist/` (wasm, element, page, pictures) and the packages.

use std::path::PathBuf;
use std::process::Command;
use std::{env, thread};

use anyhow::{Context as _, anyhow};

use crate::run::{cargo, output, program, root, run};
use crate::tools::{self, TARGET};

/// The page with the tables of times and sizes.
pub const PAGE: &str = "docs/performance.md";

/// The build profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// Profile `web-dev`: compiles in a fraction of the time, for development.
    QuickToCompile,
    /// Profile `web`: the published build.
    SmallAndFast,
}

impl Speed {
    fn profile(self) -> &'static str {
        match self {
            Self::QuickToCompile => "--profile=web-dev",
            Self::SmallAndFast => "--profile=web",
        }
    }
}

/// Builds `dist/`.
///
/// # Errors
/// The first step that fails.
pub fn build(speed: Speed) -> anyhow::Result<()> {
    tools::ensure_web_tools()?;
    compile(speed)?;
    let profile = speed.profile().trim_start_matches("--profile=");
    run(
        "Bundling the element and drawing the static pictures",
        program("node").args(["web/build.mjs", "dist", profile]),
    )?;
    run(
        "Rendering the page",
        program("node").args(["web/page/build.mjs", "dist"]),
    )?;
    println!("The site is in dist/");
    Ok(())
}

/// Compiles both modules of the site, and at the same time the tools that package them.
///
/// wasm-pack then has nothing left to compile.
fn compile(speed: Speed) -> anyhow::Result<()> {
    let mut modules = cargo();
    modules
        .args(["build", "--lib", "--target", TARGET, speed.profile()])
        .args(["--package=slam_web_module", "--package=slam_robot_module"])
        .args(remapping());
    thread::scope(|scope| {
        let tools = scope.spawn(tools::ensure_wasm_pack);
        run("Compiling the widgets to WebAssembly", &mut modules)?;
        tools.join().map_err(|_| anyhow!("a thread panicked"))?
    })?;
    run("Packing the widgets", &mut wasm_build("../pkg", speed))?;
    // One instance in a worker: the glue is a module that the worker's script imports.
    let worker = [
        "--target=web",
        "--out-dir=../../../../web/pkg-robot",
        "--out-name=slam_robot",
    ];
    let mut robot = wasm_pack_build("crates/robots/worker/module", &worker, speed);
    run("Packing the worker that maps logs", &mut robot)
}

/// Returns the command that builds the widgets into a folder relative to `web/module/`; takes more options of cargo.
fn wasm_build(folder: &str, speed: Speed) -> Command {
    // `no-modules`: the glue is one function, which the element calls once per widget to make an
    // instance. No wasm-opt: see web/module/Cargo.toml.
    let folder = format!("--out-dir={folder}");
    let options = ["--target=no-modules", &folder, "--out-name=slam_web"];
    wasm_pack_build("web/module", &options, speed)
}

/// Returns the command `wasm-pack build PACKAGE`; takes more options of cargo.
pub fn wasm_pack_build(package: &str, options: &[&str], speed: Speed) -> Command {
    let mut command = program("wasm-pack");
    command
        .args(["build", package, "--no-opt", "--no-pack"])
        .args(["--mode", "no-install", speed.profile()])
        .args(options)
        .arg("--")
        .args(remapping())
        .env("PATH", tools::path_with_tools());
    command
}

/// Replaces this machine's path of cargo's registry by `cargo/registry/…` in panic messages, because the module would
/// contain it. The setting is added to the flags of `.cargo/config.toml`.
fn remapping() -> Vec<String> {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(env::home_dir()?.join(".cargo")));
    let setting = |home: PathBuf| {
        let home = home.display();
        format!("target.{TARGET}.rustflags=['--remap-path-prefix={home}=cargo']")
    };
    home.map_or_else(Vec::new, |home| vec!["--config".to_owned(), setting(home)])
}

/// `cargo xtask package`: makes the npm archive and the Python wheels in `target/packages`. The command line needs no
/// package: `cargo install --path crates/robots/slam2d`.
///
/// # Errors
/// The first step that fails.
pub fn package() -> anyhow::Result<()> {
    let python = env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    output(program(&python).args(["-m", "pip", "--version"])).with_context(|| {
        format!(
            "{python} has no pip, which makes the wheel: install Python 3.10 or later with pip, or name one by PYTHON"
        )
    })?;
    build(Speed::SmallAndFast)?;
    run(
        "Packing the npm archive and the Python wheel",
        program("node").args(["web/package.mjs", "dist", "target/packages"]),
    )?;
    wheel(&python)?;
    run(
        "Packing the exercises for learning management systems",
        program("node").args(["teaching/scorm/package.mjs", "dist", SCORM]),
    )?;
    run(
        "Packing the site for a folder without a server",
        program("node").args(["web/offline.mjs", "dist", OFFLINE]),
    )
}

/// A wheel for systems like this one, from the tree as it is; on Linux for glibc 2.17 and later, by the linker of Zig.
fn wheel(python: &str) -> anyhow::Result<()> {
    let folder = root().join("target/python/maturin");
    let inside = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    let inside = folder.join(inside);
    run(
        "Making an environment for maturin",
        program(python).args(["-m", "venv"]).arg(&folder),
    )?;
    let mut install = program(&inside);
    install.args(["-m", "pip", "install", "--quiet", "maturin>=1.7,<2"]);
    let mut build = program(&inside);
    build.args(["-m", "maturin", "build", "--release", "--locked"]);
    build.args(["--manifest-path", "crates/robots/slam2d_py/Cargo.toml"]);
    build.args(["--out", "target/packages"]);
    if cfg!(target_os = "linux") {
        install.arg("ziglang");
        let target = format!("{}-unknown-linux-gnu", env::consts::ARCH);
        build.args(["--zig", "--compatibility", "manylinux2014", "--target"]);
        build.arg(target);
    }
    run("Installing maturin", &mut install).context("it needs once the network")?;
    run(
        "Compiling and packing the Python package rustslam2d",
        &mut build,
    )
}

/// The exercises as a SCORM 1.2 package.
const SCORM: &str = "target/packages/slam2d-exercises-scorm.zip";
/// The site as a zip whose pages open by a double click.
const OFFLINE: &str = "target/packages/slam2d-offline.zip";

/// Variants of the module: a folder, the difference from the published one, more options of cargo.
const VARIANTS: [(&str, &str, &[&str]); 5] = [
    ("published", "as published", &[]),
    (
        "fonts",
        "with egui's own fonts besides the subset",
        &["--features", "eframe/default_fonts"],
    ),
    (
        "features",
        "with all default features of eframe besides `glow`",
        &["--features", "eframe/default"],
    ),
    (
        "crates",
        "without optimization across crates",
        &["--config", "profile.web.lto=\"off\""],
    ),
    (
        "speed",
        "with `opt-level` 3 everywhere",
        &["--config", "profile.web.opt-level=3"],
    ),
];

/// `cargo xtask sizes`: builds all variants, prints their sizes and writes them into `docs/performance.md`.
///
/// # Errors
/// The first step that fails.
pub fn sizes() -> anyhow::Result<()> {
    tools::ensure_web_tools()?;
    tools::ensure_wasm_pack()?;
    let folder = root().join("target/sizes");
    let mut table = program("node");
    table.args(["web/size-table.mjs", PAGE]);
    for (id, what, options) in VARIANTS {
        // A separate target folder, because the published build stays compiled.
        let mut build = wasm_build(&format!("../../target/sizes/{id}"), Speed::SmallAndFast);
        build.args(options);
        build.env("CARGO_TARGET_DIR", folder.join("cargo"));
        run(&format!("Compiling the widgets {what}"), &mut build)?;
        let module = folder.join(id).join("slam_web_bg.wasm");
        table.arg(format!("{what}={}", module.display()));
    }
    run("Sizes", &mut table)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Returns the crates of a module of the site, with versions and features.
    fn crates_of(package: &str) -> BTreeSet<String> {
        let tree = output(
            cargo()
                .args(["tree", "--package", package, "--target", TARGET])
                .args(["--edges", "normal", "--prefix", "none"])
                .args(["--no-dedupe", "--format", "{p} with {f}"]),
        );
        let tree = tree.expect("cargo tree lists the package");
        tree.lines().map(str::to_owned).collect()
    }

    #[test]
    fn one_compilation_serves_both_modules() {
        let widgets = crates_of("slam_web_module");
        let robot = crates_of("slam_robot_module");
        let alone: Vec<&String> = robot.difference(&widgets).collect();
        assert!(
            alone.iter().all(|name| name.starts_with("slam_robot")),
            "only the worker that maps logs needs these, with these features: {alone:#?}"
        );
    }
}
