//! What people install: the npm archive and the Python wheel, in `target/packages`.
//!
//! The command line needs no package: `cargo install --path crates/slam2d_cli`.

use std::process::Command;

use crate::run::{Failure, program, root, step};
use crate::site::{self, Speed};
use crate::tools;

/// Builds the site and packs it.
///
/// # Errors
/// The first step that fails, in one line.
pub fn package() -> Result<(), Failure> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    if tools::output(Command::new(&python).args(["-m", "pip", "--version"])).is_none() {
        let missing = Failure::new(format!("{python} has no pip, which makes the wheel"));
        return Err(
            missing.with_way_out("install Python 3.10 or later with pip, or name one by PYTHON")
        );
    }
    site::build(Speed::SmallAndFast)?;
    let packages = root().join("target").join("packages");
    step(
        "Packing the npm archive and the Python wheel",
        program("node")
            .arg("web/package.mjs")
            .arg(root().join("dist"))
            .arg(&packages),
    )
}
