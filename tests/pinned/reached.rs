//! No test is left out: what a manifest tells cargo not to look for by itself is named elsewhere.
//!
//! A package links its integration tests into one binary (`autotests = false`, `tests/main.rs`).
//! One without examples in its documentation is not searched for them (`doctest = false`), and one
//! without tests in its sources is not compiled for them (`test = false`).

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The manifests of all packages with their folders.
fn packages() -> Vec<(PathBuf, String)> {
    let mut found = entries(&root().join("crates"));
    let others = [
        "widgets",
        "widgets/kit",
        "web",
        "web/robot",
        "tests",
        "tests/bench",
        "tests/doors",
    ];
    found.extend(others.map(|folder| root().join(folder)));
    found
        .into_iter()
        .filter_map(|folder| {
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).ok()?;
            Some((folder, manifest))
        })
        .collect()
}

/// What lies in a folder; nothing where there is none.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// Rust files below a folder.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    entries(folder)
        .into_iter()
        .flat_map(|path| match path.extension() {
            _ if path.is_dir() => rust_files(&path),
            Some(extension) if extension == "rs" => vec![path],
            _ => Vec::new(),
        })
        .collect()
}

/// The modules of a folder that its `main.rs` does not name.
/// What the manifest makes a program of its own is not one of them.
fn left_out(main: &str, manifest: &str, files: &[PathBuf]) -> Vec<String> {
    let names = files.iter().filter_map(|path| path.file_stem()?.to_str());
    names
        .filter(|name| *name != "main")
        .filter(|name| !main.lines().any(|line| line == format!("mod {name};")))
        .filter(|name| !manifest.contains(&format!("\npath = \"tests/{name}.rs\"")))
        .map(str::to_owned)
        .collect()
}

/// Whether a comment of the documentation opens a block of Rust that would be tested.
fn has_example(text: &str) -> bool {
    let mut is_open = false;
    text.lines().any(|line| {
        let line = line.trim_start();
        let comment = line
            .strip_prefix("///")
            .or_else(|| line.strip_prefix("//!"));
        let Some(fence) = comment.and_then(|words| words.trim().strip_prefix("```")) else {
            return false;
        };
        is_open = !is_open;
        is_open && fence != "text"
    })
}

#[test]
fn every_integration_test_is_part_of_the_one_binary_of_its_package() {
    let mut seen = 0;
    for (folder, manifest) in packages() {
        if !manifest.contains("autotests = false") {
            continue;
        }
        let tests = folder.join("tests");
        let main = fs::read_to_string(tests.join("main.rs")).unwrap_or_default();
        assert_eq!(
            left_out(&main, &manifest, &entries(&tests)),
            Vec::<String>::new(),
            "{} does not name them",
            tests.join("main.rs").display()
        );
        seen += 1;
    }
    assert!(seen >= 7, "only {seen} packages have one binary");
    let files = ["main.rs", "named.rs", "forgotten.rs"].map(PathBuf::from);
    assert_eq!(left_out("mod named;\n", "", &files), ["forgotten"]);
    let own = "[[test]]\nname = \"forgotten\"\npath = \"tests/forgotten.rs\"\n";
    assert_eq!(left_out("mod named;\n", own, &files), [""; 0]);
}

/// The section of a manifest, without its title.
fn section<'a>(manifest: &'a str, title: &str) -> &'a str {
    let (_, rest) = manifest.split_once(title).unwrap_or_default();
    rest.split("\n[").next().unwrap_or_default()
}

#[test]
fn every_test_in_the_sources_is_compiled() {
    let mut seen = 0;
    for (folder, manifest) in packages() {
        if !section(&manifest, "[lib]").contains("\ntest = false") {
            continue;
        }
        for file in rust_files(&folder.join("src")) {
            let text = fs::read_to_string(&file).expect("a source can be read");
            assert!(
                !text.contains("#[test]") && !text.contains("proptest!"),
                "{} has a test, and its manifest says `test = false`",
                file.display()
            );
        }
        seen += 1;
    }
    assert!(seen >= 1, "no package has `test = false`");
    let manifest = "[lib]\nbench = false\n\n[[bin]]\ntest = false\n";
    assert!(!section(manifest, "[lib]").contains("test = false"));
}

#[test]
fn every_example_of_the_documentation_is_tested() {
    for (folder, manifest) in packages() {
        if !manifest.contains("doctest = false") {
            continue;
        }
        for file in rust_files(&folder.join("src")) {
            let text = fs::read_to_string(&file).expect("a source can be read");
            assert!(
                !has_example(&text),
                "{} has an example, and its manifest says `doctest = false`",
                file.display()
            );
        }
    }
    assert!(has_example("//! ```\n//! assert!(true);\n//! ```\n"));
    assert!(!has_example("/// ```text\n/// x\n/// ```\n"));
}
