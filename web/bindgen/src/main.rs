//! The command `wasm-bindgen` as wasm-pack calls it, on wasm-bindgen's own library.
//!
//! The published command also brings a test runner with an HTTP server and TLS, which take minutes to compile.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use wasm_bindgen_cli_support::Bindgen;

#[derive(Parser)]
#[command(name = "wasm-bindgen", version)]
struct Args {
    /// The module from the compiler.
    input: PathBuf,
    #[arg(long)]
    out_dir: PathBuf,
    #[arg(long)]
    out_name: String,
    #[arg(long)]
    target: Target,
    /// Accepted and ignored: the caller names the module.
    #[arg(long)]
    omit_default_module_path: bool,
    /// Accepted and ignored: declarations are always written.
    #[arg(long)]
    typescript: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Target {
    Web,
    NoModules,
}

fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let mut bindgen = Bindgen::new();
    match args.target {
        Target::Web => bindgen.web(true)?,
        Target::NoModules => bindgen.no_modules(true)?,
    };
    bindgen
        .input_path(&args.input)
        .out_name(&args.out_name)
        .typescript(true)
        .omit_default_module_path(args.omit_default_module_path)
        .generate(&args.out_dir)
}
