//! `cargo xtask sizes`: what keeps the module small, measured by leaving each step out.

use crate::bench::PAGE;
use crate::run::{Failure, program, root, show, step};
use crate::site::{Speed, wasm_build};
use crate::tools;

/// A build of the module.
struct Variant {
    /// Its folder.
    id: &'static str,
    /// How it differs from the published one.
    what: &'static str,
    /// More options of cargo.
    options: &'static [&'static str],
}

/// The first is the published build itself.
const VARIANTS: [Variant; 5] = [
    Variant {
        id: "published",
        what: "as published",
        options: &[],
    },
    Variant {
        id: "fonts",
        what: "with egui's own fonts besides the subset",
        options: &["--features", "eframe/default_fonts"],
    },
    Variant {
        id: "features",
        what: "with all default features of eframe besides `glow`",
        options: &["--features", "eframe/default"],
    },
    Variant {
        id: "crates",
        what: "without optimization across crates",
        options: &["--config", "profile.web.lto=\"off\""],
    },
    Variant {
        id: "speed",
        what: "with `opt-level` 3 everywhere",
        options: &["--config", "profile.web.opt-level=3"],
    },
];

/// Builds all variants, prints their sizes and writes them into `docs/performance.md`.
///
/// # Errors
/// The first step that fails, in one line.
pub fn sizes() -> Result<(), Failure> {
    tools::ensure_build_tools()?;
    let folder = root().join("target/sizes");
    let mut table = program("node");
    table.args(["web/size-table.mjs", PAGE]);
    for Variant { id, what, options } in VARIANTS {
        // A target folder of its own: the published build stays compiled.
        let mut build = wasm_build(&format!("../../target/sizes/{id}"), Speed::SmallAndFast);
        build
            .args(options)
            .env("CARGO_TARGET_DIR", folder.join("cargo"));
        step(&format!("Compiling the widgets {what}"), &mut build)?;
        let module = folder.join(id).join("slam_web_bg.wasm");
        table.arg(format!("{what}={}", module.display()));
    }
    show("Sizes", &mut table)
}
