//! `cargo xtask bench`: the same workloads natively and as WebAssembly, timed by turns and counted;
//! the peers, the sweep over many seeds and the first frames beside them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::chromium;
use crate::run::{Failure, program, root, show, step};
use crate::site::{self, Speed};
use crate::suite::native::Tools;
use crate::tools;

/// Where the tables stand.
pub const PAGE: &str = "docs/performance.md";
/// What is measured of the site in Chromium, and by which script.
const IN_CHROMIUM: [(&str, &str); 2] = [
    (
        "The first frame of each widget",
        "tests/bench/first_frame.mjs",
    ),
    (
        "The script of a frame while a slider changes",
        "tests/bench/changing.mjs",
    ),
];

/// Measures, prints the tables, writes them into `docs/performance.md`, and the figures of the
/// workloads to `json` where one is named.
///
/// # Errors
/// The first step that fails, in one line.
pub fn bench(json: Option<&Path>) -> Result<(), Failure> {
    tools::ensure_build_tools()?;
    let chromium = chromium::ensure_chromium(chromium::Wanted::ForTimes)?;
    tools::ensure_node_modules(&root().join("tests/browser"))?;
    Tools::AsShipped.compile()?;
    let web = root().join("target/bench-web");
    step(
        "Compiling the workloads to WebAssembly",
        &mut tools::wasm_pack_build(
            "tests/bench/module",
            &[
                "--target=web",
                "--out-dir=../../../target/bench-web",
                "--out-name=slam2d_bench",
                "--profile=web",
            ],
        ),
    )?;

    let figures = Figures::in_folder(&web);
    step(
        "Measuring by turns: natively, in Node, in Chromium",
        program("sh")
            .args([
                "-c",
                "exec node tests/bench/measure.mjs \"$0\" \"$1\" >\"$2\"",
            ])
            .args([&Tools::AsShipped.path("slam2d_bench"), &web, &figures.turns])
            .env("CHROMIUM", &chromium),
    )?;
    step(
        "Counting instructions, where valgrind is installed",
        program("sh")
            .args(["-c", "exec \"$0\" count >\"$1\""])
            .arg(Tools::AsShipped.path("slam2d_bench"))
            .arg(&figures.instructions),
    )?;
    show(
        "Times, ratios and instructions",
        program(Tools::AsShipped.path("slam2d_bench"))
            .arg("table")
            .args([&figures.turns, &figures.instructions])
            .arg(PAGE),
    )?;
    if let Some(path) = json {
        figures.write_json(path)?;
    }
    show(
        "The port in JavaScript",
        program(Tools::AsShipped.path("slam2d_bench")).args(["peer", PAGE]),
    )?;
    tools::ensure_nanoflann();
    show(
        "Registration of files",
        program(Tools::AsShipped.path("slam2d_bench"))
            .arg("registration")
            .args([
                Tools::AsShipped.path("slam2d"),
                root().join("target/bench-clouds"),
            ])
            .arg(PAGE),
    )?;
    show(
        "The lap at many seeds",
        program(Tools::AsShipped.path("slam2d_bench"))
            .arg("sweep")
            .arg(Tools::AsShipped.path("slam2d"))
            .arg(PAGE),
    )?;
    site::build(Speed::SmallAndFast)?;
    for (what, script) in IN_CHROMIUM {
        show(
            what,
            program("node")
                .args([script, PAGE])
                .env("CHROMIUM", &chromium),
        )?;
    }
    // Last, so that every table is written.
    show(
        "The limits",
        program(Tools::AsShipped.path("slam2d_bench"))
            .arg("judge")
            .arg(&figures.turns),
    )
}

/// The files with the figures of the workloads, each one JSON value.
struct Figures {
    turns: PathBuf,
    instructions: PathBuf,
}

impl Figures {
    fn in_folder(folder: &Path) -> Self {
        Self {
            turns: folder.join("turns.json"),
            instructions: folder.join("instructions.json"),
        }
    }

    /// Writes one JSON object with both.
    fn write_json(&self, path: &Path) -> Result<(), Failure> {
        let failed = |path: &Path, error: std::io::Error| {
            Failure::new(format!("{}: {error}", path.display()))
        };
        let read = |part: &Path| {
            let text = fs::read_to_string(part).map_err(|error| failed(part, error))?;
            Ok::<_, Failure>(text.trim().to_owned())
        };
        let text = format!(
            "{{\n\"turns\": {},\n\"instructions\": {}\n}}\n",
            read(&self.turns)?,
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
        assert!(missing.contains("turns.json"), "{missing}");

        fs::write(&figures.turns, "[1]\n").unwrap();
        fs::write(&figures.instructions, "{\"lap\":3}\n").unwrap();
        figures.write_json(&json).unwrap();
        let written = fs::read_to_string(&json).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(
            written,
            "{\n\"turns\": [1],\n\"instructions\": {\"lap\":3}\n}\n"
        );
    }
}
