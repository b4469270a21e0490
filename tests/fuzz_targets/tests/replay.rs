//! Replays the inputs of the corpus and of earlier findings without a fuzzer.
//!
//! For a coverage report `TARGET` selects one target and `MORE_INPUTS` a folder of further inputs.

use std::env;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use slam2d_fuzz_targets::TARGETS;

/// The inputs are part of the repository: at most some hundred small files.
const MAX_FILES: usize = 800;
const MAX_BYTES: usize = 200_000;

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz")
}

/// The inputs of a folder by name; empty without the folder.
fn inputs(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("a folder can be listed").path())
        .collect();
    paths.sort();
    let read = |path: PathBuf| {
        let bytes = fs::read(&path).expect("an input can be read");
        (path, bytes)
    };
    paths.into_iter().map(read).collect()
}

#[test]
fn every_kept_input_passes_its_target() {
    let only = env::var("TARGET").ok();
    for (name, target) in TARGETS {
        if only.as_deref().is_some_and(|only| only != name) {
            continue;
        }
        let mut folders = vec![
            fuzz().join("corpus").join(name),
            fuzz().join("found").join(name),
        ];
        folders.extend(env::var_os("MORE_INPUTS").map(PathBuf::from));
        let all: Vec<_> = folders.iter().flat_map(|folder| inputs(folder)).collect();
        assert!(!all.is_empty(), "no input for {name}");
        for (path, bytes) in all {
            let passed = catch_unwind(AssertUnwindSafe(|| target(&bytes))).is_ok();
            assert!(passed, "{name} does not take {}", path.display());
        }
    }
}

#[test]
fn the_inputs_of_the_repository_are_small_and_each_belongs_to_a_target() {
    let (mut files, mut bytes) = (0, 0);
    for kind in ["corpus", "found"] {
        for entry in fs::read_dir(fuzz().join(kind)).expect("the folder is there") {
            let folder = entry.expect("a folder can be listed").path();
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            let is_target = TARGETS.iter().any(|(known, _)| *known == name);
            assert!(is_target, "fuzz/{kind}/{name} belongs to no target");
            for (_, input) in inputs(&folder) {
                files += 1;
                bytes += input.len();
            }
        }
    }
    assert!(files <= MAX_FILES && bytes <= MAX_BYTES, "{files}, {bytes}");
}
