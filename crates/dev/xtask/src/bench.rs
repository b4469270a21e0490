//! `cargo xtask bench`: times the same workloads natively and as WebAssembly, interleaved, counts their instructions,
//! and measures the other tables of the page.

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use anyhow::Context as _;

use crate::run::{cargo, program, root, run};
use crate::site::{self, PAGE, Speed, wasm_pack_build};
use crate::tools;

/// Measures, prints the tables, writes them into `docs/performance.md`, and writes the figures of the
/// workloads to `json` if it is given.
///
/// # Errors
/// The first step that fails.
pub fn bench(json: Option<&Path>) -> anyhow::Result<()> {
    let chromium = tools::ensure_chromium_for_times()?;
    tools::ensure_node_modules("tests/browser")?;
    site::build(Speed::SmallAndFast)?;
    let mut compile = cargo();
    compile.args(["build", "--quiet", "--release", "--bins"]);
    compile.args(["--package=slam2d_bench", "--package=ch16"]);
    compile.arg("--target-dir").arg(root().join("target"));
    run("Compiling ch16 and slam2d_bench", &mut compile)?;
    let options = [
        "--target=web",
        "--out-dir=../../../target/bench-web",
        "--out-name=slam2d_bench",
    ];
    let mut wasm = wasm_pack_build("tests/bench/module", &options, Speed::SmallAndFast);
    run("Compiling the workloads to WebAssembly", &mut wasm)?;

    let release = |name: &str| root().join("target/release").join(name);
    let (ours, ch16) = (release("slam2d_bench"), release("ch16"));
    let figures = root().join("target/bench-web");
    let (turns, instructions) = (
        figures.join("turns.json"),
        figures.join("instructions.json"),
    );
    let mut measure = program("node");
    measure
        .arg("tests/bench/measure.mjs")
        .args([&ours, &figures]);
    measure
        .env("CHROMIUM", &chromium)
        .stdout(File::create(&turns)?);
    run("Measuring natively, in Node and in Chromium", &mut measure)?;
    let mut count = program(&ours);
    count.arg("count").stdout(File::create(&instructions)?);
    run("Counting instructions if valgrind is installed", &mut count)?;
    if let Some(path) = json {
        let read = |part: &Path| fs::read_to_string(part);
        let (turns, instructions) = (read(&turns)?, read(&instructions)?);
        let text = format!("{{\"turns\": {turns},\n\"instructions\": {instructions}}}\n");
        fs::write(path, text).with_context(|| path.display().to_string())?;
    }

    let table = |what: &str, command: &mut Command| run(what, command.arg(PAGE));
    table(
        "Times, ratios and instructions",
        program(&ours).arg("table").args([&turns, &instructions]),
    )?;
    let clouds = root().join("target/bench-clouds");
    table(
        "Registration compared with nanoflann",
        program(&ours).arg("registration").args([&ch16, &clouds]),
    )?;
    for (what, script) in [
        (
            "The first frame of each widget",
            "tests/bench/first_frame.mjs",
        ),
        (
            "The script of a frame while a slider changes",
            "tests/bench/changing.mjs",
        ),
        ("The first page on a slow line", "tests/bench/slow_line.mjs"),
    ] {
        table(what, program("node").arg(script).env("CHROMIUM", &chromium))?;
    }
    Ok(())
}
