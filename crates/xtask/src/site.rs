//! The finished site: wasm, element, page, pictures, all in `dist/`.

use std::path::Path;
use std::process::Command;

use crate::linted::linted;
use crate::run::{Failure, program, root, step};
use crate::tools;

/// What the compiler aims at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// Profile `web-dev`: compiles in a fraction of the time, for trying things out.
    QuickToCompile,
    /// Profile `web`: what is published, and linted as it is compiled.
    SmallAndFast,
}

impl Speed {
    fn profile(self) -> &'static str {
        match self {
            Self::QuickToCompile => "web-dev",
            Self::SmallAndFast => "web",
        }
    }
}

/// Builds `dist/`.
///
/// # Errors
/// The first step that fails, in one line.
pub fn build(speed: Speed) -> Result<(), Failure> {
    tools::ensure_build_tools()?;
    compile_wasm(speed)?;
    let dist = root().join("dist");
    step(
        "Bundling the element and drawing the static pictures",
        program("node")
            .arg("web/build.mjs")
            .arg(&dist)
            .arg(speed.profile()),
    )?;
    step(
        "Rendering the page",
        program("node").arg("web/page/build.mjs").arg(&dist),
    )?;
    report(&dist);
    Ok(())
}

fn compile_wasm(speed: Speed) -> Result<(), Failure> {
    let mut modules = [
        (
            "Compiling the widgets to WebAssembly (the first time takes minutes)",
            wasm_build("../pkg", speed),
        ),
        ("Compiling the worker that maps logs", robot_build(speed)),
    ];
    for (what, module) in &mut modules {
        match speed {
            Speed::QuickToCompile => step(what, module)?,
            Speed::SmallAndFast => step(what, linted(module)?)?,
        }
    }
    Ok(())
}

/// The build of the second module, which a reader's log is mapped in, into `web/pkg-robot`.
fn robot_build(speed: Speed) -> Command {
    tools::wasm_pack_build(
        "web/robot/module",
        &[
            // One instance in a worker of its own: the glue is a module that the worker's script takes in.
            "--target=web",
            "--out-dir=../../pkg-robot",
            "--out-name=slam_robot",
            &format!("--profile={}", speed.profile()),
        ],
    )
}

/// The build of the module into a folder, named as seen from `web/module/`; takes more options of cargo.
pub fn wasm_build(folder: &str, speed: Speed) -> Command {
    // `no-modules`: one function that holds the whole glue, so that the element can make as many
    // instances as there are widgets. No wasm-opt: see web/module/Cargo.toml.
    tools::wasm_pack_build(
        "web/module",
        &[
            "--target=no-modules",
            &format!("--out-dir={folder}"),
            "--out-name=slam_web",
            &format!("--profile={}", speed.profile()),
        ],
    )
}

fn report(dist: &Path) {
    let shown = dist.strip_prefix(root()).unwrap_or(dist);
    println!("The site is in {}/", shown.display());
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::run::cargo;
    use crate::tools::output;

    /// What a module of the site is made of: crates with versions and features.
    fn crates_of(package: &str) -> BTreeSet<String> {
        let tree = output(
            cargo()
                .args(["tree", "--package", package, "--target", tools::TARGET])
                .args(["--edges", "normal", "--prefix", "none"])
                .args(["--no-dedupe", "--format", "{p} with {f}"]),
        );
        let tree = tree.expect("cargo knows the workspace");
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
