//! `cargo xtask bench`: the same workloads natively and as wasm in Chromium, timed and counted, in
//! one table; registration of files, the sweep over many seeds and the first frames beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::chromium;
use crate::run::{Failure, cargo, program, root, show, step};
use crate::site::{self, Speed};
use crate::tools;

/// Where the tables stand.
pub const PAGE: &str = "docs/performance.md";

/// Measures, prints the tables, writes them into `docs/performance.md`, and the figures of the
/// workloads to `json` where one is named.
///
/// # Errors
/// The first step that fails, in one line.
pub fn bench(json: Option<&Path>) -> Result<(), Failure> {
    tools::ensure_build_tools()?;
    let chromium = chromium::ensure_chromium()?;
    tools::ensure_node_modules(&root().join("tests/browser"))?;
    compile_native(&["slam2d_bench", "slam2d_cli"])?;
    let web = root().join("target/bench-web");
    step(
        "Compiling the workloads to WebAssembly",
        &mut tools::wasm_pack_build(
            "tests/bench",
            &[
                "--target=web",
                "--out-dir=../../target/bench-web",
                "--out-name=slam2d_bench",
                "--profile=web",
            ],
        ),
    )?;

    let figures = Figures::in_folder(&web);
    step(
        "Measuring natively",
        &mut into_file("measure", &figures.native),
    )?;
    step(
        "Measuring in Chromium",
        program("sh")
            .args(["-c", "exec node tests/bench/browser.mjs \"$0\" >\"$1\""])
            .arg(&web)
            .arg(&figures.wasm)
            .env("CHROMIUM", &chromium),
    )?;
    step(
        "Counting instructions, where valgrind is installed",
        &mut into_file("count", &figures.instructions),
    )?;
    show(
        "Medians and instructions",
        program(binary("slam2d_bench"))
            .arg("table")
            .args([&figures.native, &figures.wasm, &figures.instructions])
            .arg(PAGE),
    )?;
    if let Some(path) = json {
        figures.write_json(path)?;
    }
    show(
        "The port in JavaScript",
        program(binary("slam2d_bench"))
            .arg("peer")
            .arg(&figures.native)
            .arg(PAGE),
    )?;
    tools::ensure_nanoflann();
    show(
        "Registration of files",
        program(binary("slam2d_bench"))
            .arg("registration")
            .args([binary("slam2d"), root().join("target/bench-clouds")])
            .arg(PAGE),
    )?;
    show(
        "The lap at many seeds",
        program(binary("slam2d_bench"))
            .arg("sweep")
            .arg(binary("slam2d"))
            .arg(PAGE),
    )?;
    site::build(Speed::SmallAndFast)?;
    show(
        "The first frame of each widget",
        program("node")
            .args(["tests/bench/first_frame.mjs", PAGE])
            .env("CHROMIUM", chromium),
    )
}

fn compile_native(packages: &[&str]) -> Result<(), Failure> {
    let named = packages.iter().flat_map(|package| ["--package", package]);
    step(
        "Compiling the workloads",
        cargo()
            .args(["build", "--release"])
            .args(named)
            // Said here, so that it is known: CARGO_TARGET_DIR and cargo's settings may say otherwise.
            .arg("--target-dir")
            .arg(root().join("target")),
    )
}

fn binary(name: &str) -> PathBuf {
    let name = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    root().join("target/release").join(name)
}

/// `slam2d_bench COMMAND >FILE`; what it says about its progress stays apart.
fn into_file(command: &str, file: &Path) -> Command {
    let mut shell = program("sh");
    shell
        .args(["-c", "exec \"$0\" \"$1\" >\"$2\""])
        .arg(binary("slam2d_bench"))
        .arg(command)
        .arg(file);
    shell
}

/// The files with the figures of the workloads, each one JSON value.
struct Figures {
    native: PathBuf,
    wasm: PathBuf,
    instructions: PathBuf,
}

impl Figures {
    fn in_folder(folder: &Path) -> Self {
        Self {
            native: folder.join("native.json"),
            wasm: folder.join("wasm.json"),
            instructions: folder.join("instructions.json"),
        }
    }

    /// Writes one JSON object with all of them.
    fn write_json(&self, path: &Path) -> Result<(), Failure> {
        let failed = |path: &Path, error: std::io::Error| {
            Failure::new(format!("{}: {error}", path.display()))
        };
        let read = |part: &Path| {
            let text = fs::read_to_string(part).map_err(|error| failed(part, error))?;
            Ok::<_, Failure>(text.trim().to_owned())
        };
        let text = format!(
            "{{\n\"native\": {},\n\"wasm\": {},\n\"instructions\": {}\n}}\n",
            read(&self.native)?,
            read(&self.wasm)?,
            read(&self.instructions)?
        );
        fs::write(path, text).map_err(|error| failed(path, error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_json_has_a_part_for_each_kind_of_figure() {
        let folder = std::env::temp_dir().join(format!("xtask-bench-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let figures = Figures::in_folder(&folder);
        let json = folder.join("bench.json");
        let missing = figures.write_json(&json).unwrap_err().to_string();
        assert!(missing.contains("native.json"), "{missing}");

        fs::write(&figures.native, "[1]\n").unwrap();
        fs::write(&figures.wasm, "[2]\n").unwrap();
        fs::write(&figures.instructions, "{\"lap\":3}\n").unwrap();
        figures.write_json(&json).unwrap();
        let written = fs::read_to_string(&json).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let expected = "{\n\"native\": [1],\n\"wasm\": [2],\n\"instructions\": {\"lap\":3}\n}\n";
        assert_eq!(written, expected);
    }
}
