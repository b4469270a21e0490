//! `cargo xtask bench`: the same workloads natively and as wasm in Chromium, in one table.

use std::fs;
use std::path::{Path, PathBuf};

use crate::run::{Failure, cargo, program, root, show, step};
use crate::tools;

/// Measures, prints the table, writes it into `docs/performance.md`, and the measurements to
/// `json` where one is named.
///
/// # Errors
/// The first step that fails, in one line.
pub fn bench(json: Option<&Path>) -> Result<(), Failure> {
    tools::ensure_build_tools()?;
    let chromium = tools::ensure_chromium()?;
    tools::ensure_node_modules(&root().join("tests/browser"))?;
    compile_native()?;
    let web = root().join("target/bench-web");
    step(
        "Compiling the workloads to WebAssembly",
        program(tools::tools().join("bin/wasm-pack"))
            .args(["build", "tests/bench", "--target", "web", "--no-opt"])
            .args(["--no-pack", "--mode", "no-install", "--profile", "web"])
            .args(["--out-name", "slam2d_bench", "--out-dir"])
            .arg(&web)
            .env("PATH", tools::path_with_tools()),
    )?;

    let (native_json, wasm_json) = (web.join("native.json"), web.join("wasm.json"));
    step(
        "Measuring natively",
        program("sh")
            .args(["-c", "exec \"$0\" measure >\"$1\""])
            .arg(binary())
            .arg(&native_json),
    )?;
    step(
        "Measuring in Chromium",
        program("sh")
            .args(["-c", "exec node tests/bench/browser.mjs \"$0\" >\"$1\""])
            .arg(&web)
            .arg(&wasm_json)
            .env("CHROMIUM", chromium),
    )?;
    show(
        "Medians",
        program(binary())
            .arg("table")
            .arg(&native_json)
            .arg(&wasm_json)
            .arg("docs/performance.md"),
    )?;
    match json {
        Some(path) => write_json(path, &native_json, &wasm_json),
        None => Ok(()),
    }
}

/// Fails where a workload takes 10 % more instructions than recorded; says so without valgrind.
///
/// # Errors
/// The workloads that got slower.
pub fn check_counts() -> Result<(), Failure> {
    compile_native()?;
    show(
        "Instruction counts",
        program(binary()).args(["--counts", "check"]),
    )
}

fn compile_native() -> Result<(), Failure> {
    step(
        "Compiling the workloads",
        cargo().args(["build", "--release", "--package", "slam2d_bench"]),
    )
}

fn binary() -> PathBuf {
    let name = format!("slam2d_bench{}", std::env::consts::EXE_SUFFIX);
    root().join("target/release").join(name)
}

fn write_json(path: &Path, native: &Path, wasm: &Path) -> Result<(), Failure> {
    let say = |error: std::io::Error| Failure::new(format!("{}: {error}", path.display()));
    let read = |part: &Path| fs::read_to_string(part).map_err(say);
    let text = format!(
        "{{\n\"native\": {},\n\"wasm\": {}\n}}\n",
        read(native)?.trim(),
        read(wasm)?.trim()
    );
    fs::write(path, text).map_err(say)
}
