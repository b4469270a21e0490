//! The invariants of ARCHITECTURE.md that neither the compiler nor `clippy.toml` can check.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use super::page::document::source;

/// The output of `cargo metadata` for a package.
#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
    targets: Vec<Target>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
    /// `dev` or `build`; absent for ordinary dependencies.
    kind: Option<String>,
}

#[derive(Deserialize)]
struct Target {
    kind: Vec<String>,
    src_path: PathBuf,
    test: bool,
    doctest: bool,
}

fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().unwrap_or(tests).to_owned()
}

/// All packages of the workspace.
fn packages() -> Vec<Package> {
    #[derive(Deserialize)]
    struct Metadata {
        packages: Vec<Package>,
    }
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version=1", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    let metadata: Metadata = serde_json::from_slice(&output.stdout).expect("cargo prints JSON");
    metadata.packages
}

impl Package {
    fn folder(&self) -> &Path {
        self.manifest_path
            .parent()
            .expect("a manifest has a folder")
    }

    /// The folder relative to the top level.
    fn path(&self) -> String {
        let path = self.folder().strip_prefix(root()).expect("it lies inside");
        path.to_string_lossy().replace('\\', "/")
    }

    /// Its dependencies, without those of its tests.
    fn uses(&self) -> impl Iterator<Item = &str> {
        let used = self.dependencies.iter().filter(|used| used.kind.is_none());
        used.map(|used| used.name.as_str())
    }
}

/// Rust files below a folder; empty if it is absent.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .map(|entry| entry.path())
        .flat_map(|path| match path.extension() {
            _ if path.is_dir() => rust_files(&path),
            Some(extension) if extension == "rs" => vec![path],
            _ => Vec::new(),
        })
        .collect()
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The packages of `crates/` in the order of the data flow, each with its allowed dependencies.
const CORE: [(&str, &[&str]); 14] = [
    ("pr_geom", &[]),
    ("pr_sim", &["pr_geom"]),
    ("pr_grid", &["pr_geom"]),
    ("pr_optim", &["pr_geom"]),
    // Neither the simulator nor the lab: the estimator has no access to the truth.
    ("ch16_slam2d", &["pr_geom", "pr_optim"]),
    ("ch16_listings", &["pr_geom", "ch16_slam2d"]),
    (
        "incremental_mapping",
        &["pr_geom", "pr_grid", "ch16_slam2d"],
    ),
    (
        "ch16_lab",
        &[
            "pr_geom",
            "pr_grid",
            "pr_optim",
            "pr_sim",
            "ch16_slam2d",
            "incremental_mapping",
        ],
    ),
    (
        "robot_io",
        &["pr_geom", "pr_grid", "pr_optim", "ch16_slam2d"],
    ),
    ("log_messages", &[]),
    ("bench_support", &[]),
    (
        "solver_peers",
        &[
            "bench_support",
            "pr_geom",
            "pr_optim",
            "ch16_slam2d",
            "robot_io",
        ],
    ),
    (
        "slam2d_py",
        &["pr_geom", "pr_optim", "ch16_slam2d", "ch16_lab", "robot_io"],
    ),
    ("xtask", &[]),
];

#[test]
fn data_flows_one_way() {
    let packages = packages();
    let ours: Vec<&str> = packages
        .iter()
        .map(|package| package.name.as_str())
        .collect();
    for (name, may_use) in CORE {
        let package = packages.iter().find(|package| package.name == name);
        let package = package.unwrap_or_else(|| panic!("{name} is gone"));
        let own = package.uses().filter(|used| ours.contains(used));
        let more: Vec<&str> = own.filter(|used| !may_use.contains(used)).collect();
        assert!(more.is_empty(), "{name} uses {more:?}");
    }
    for package in &packages {
        let path = package.path();
        let is_known = CORE.iter().any(|(name, _)| *name == package.name);
        assert!(
            is_known
                || !path.starts_with("crates/")
                || ["slam2d", "slam_robot", "slam_robot_module"].contains(&package.name.as_str()),
            "{path} has no row in CORE"
        );
        for used in package.uses() {
            assert_ne!(
                used, "slam2d_tests",
                "{path} needs the tests outside of its own"
            );
            let is_picture = used.starts_with("egui") || used == "eframe";
            assert!(
                !is_picture || !path.starts_with("crates/"),
                "{path} paints with {used}"
            );
            let is_browser =
                used.starts_with("wasm-bindgen") || ["js-sys", "web-sys"].contains(&used);
            let may_browse = ["web", "tests/", "crates/robots/worker"]
                .iter()
                .any(|folder| path.starts_with(folder));
            assert!(
                !is_browser || may_browse,
                "{path} depends on the browser through {used}"
            );
            assert!(
                used != "libm" || package.name == "pr_geom",
                "{path} uses libm, not pr_geom::math"
            );
        }
    }
}

#[test]
fn the_guide_names_every_package() {
    let guide = source("ARCHITECTURE.md");
    for package in packages() {
        let path = package.path();
        assert!(guide.contains(&format!("`{path}`")), "{path} is missing");
    }
}

#[test]
fn the_guide_gives_the_dependencies_of_the_core_as_the_manifests_do() {
    const WORDS: [(&str, &str); 3] = [
        ("pr_geom", "geometry"),
        ("pr_optim", "solver"),
        ("pr_grid", "grid"),
    ];
    let guide = source("ARCHITECTURE.md");
    for package in packages() {
        let row = format!("| `{}` |", package.path());
        let row = guide.lines().find(|line| line.starts_with(&row));
        let given = row
            .and_then(|row| row.split('|').nth(3))
            .unwrap_or_default();
        let needs = |used: &str| package.uses().any(|name| name == used);
        // A row that names a part as a whole, such as the estimator, includes what that needs.
        let is_core =
            ["pr_sim", "pr_grid", "pr_optim", "ch16_slam2d"].contains(&package.name.as_str());
        for (used, word) in WORDS.into_iter().filter(|_| is_core) {
            assert_eq!(
                given.contains(word),
                needs(used),
                "{}: {word}",
                package.name
            );
        }
        if given.contains("grid") {
            assert!(needs("pr_grid"), "{}", package.name);
        }
    }
}

/// A package compiles egui for its view, so the compiler cannot keep it out of the model.
#[test]
fn models_use_neither_egui_nor_the_browser_nor_a_clock() {
    let words = [
        "egui",
        "eframe",
        "web_sys",
        "wasm_bindgen",
        "Instant",
        "SystemTime",
    ];
    let mut files = rust_files(&root().join("widgets"));
    files.retain(|file| {
        let inside = file.to_string_lossy().replace('\\', "/");
        inside.contains("/src/") && (inside.contains("/model") || inside.ends_with("/spec.rs"))
    });
    assert!(files.len() >= 20, "the models have moved: {files:?}");
    for file in files {
        let text = text(&file);
        let code = text
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default());
        for line in code {
            let word = words.iter().find(|word| line.contains(**word));
            assert_eq!(word, None, "{}: {line}", file.display());
        }
    }
}

/// Of two modules beside each other at most one uses the other, directly or through others.
#[test]
fn modules_beside_each_other_form_no_circle() {
    for package in packages() {
        let src = package.folder().join("src");
        let files = rust_files(&src).into_iter().map(|file| {
            let name = file.strip_prefix(&src).expect("it lies inside");
            let name = name.with_extension("").to_string_lossy().into_owned();
            let name = name.replace(std::path::MAIN_SEPARATOR, "::");
            (name, text(&file))
        });
        let modules: BTreeMap<String, String> = files
            .filter(|(name, _)| name != "lib" && !name.ends_with("tests"))
            .collect();
        let mut uses = BTreeSet::new();
        for (module, text) in &modules {
            let code = text.split("mod tests {").next().unwrap_or_default();
            let code = code
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            // A group on one line: `use super::{map, parts};`.
            let words = code.flat_map(|line| {
                let (start, names) = line.split_once("::{").unwrap_or(("", line));
                let start = start.rsplit(' ').next().filter(|start| !start.is_empty());
                let start = start.map_or(String::new(), |start| format!("{start}::"));
                let names = names.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
                names.map(move |name| format!("{start}{name}"))
            });
            for path in words {
                let user: Vec<&str> = module.split("::").collect();
                let kept = match path.matches("super::").count() {
                    0 if path.starts_with("crate::") => 0,
                    0 => continue,
                    up => user.len().saturating_sub(up),
                };
                let below = path
                    .split("::")
                    .filter(|part| !["crate", "super"].contains(part));
                let used: Vec<&str> = user[..kept].iter().copied().chain(below).collect();
                let same = user.iter().zip(&used).take_while(|(a, b)| a == b).count();
                if same < user.len() && same < used.len() {
                    let [user, used] = [user, used].map(|path| path[..=same].join("::"));
                    uses.extend(modules.contains_key(&used).then_some((user, used)));
                }
            }
        }
        // What uses none of the rest is in no circle.
        let mut before = usize::MAX;
        while uses.len() < before {
            before = uses.len();
            let users: BTreeSet<String> = uses.iter().map(|(user, _)| user.clone()).collect();
            uses.retain(|(_, used)| users.contains(used));
        }
        assert!(uses.is_empty(), "{}: {uses:?}", package.name);
    }
}

/// Some manifests turn off test discovery to link fewer programs; then the tests must be elsewhere, or
/// absent.
#[test]
fn no_test_is_left_out() {
    for package in packages() {
        let is_program = |path: &Path| package.targets.iter().any(|target| target.src_path == path);
        let main = package.folder().join("tests/main.rs");
        let named = fs::read_to_string(&main).unwrap_or_default();
        let entries = fs::read_dir(package.folder().join("tests"));
        for file in entries
            .into_iter()
            .flatten()
            .flatten()
            .map(|file| file.path())
        {
            let is_rust = file.extension().is_some_and(|extension| extension == "rs");
            if is_rust && !is_program(&file) {
                let name = file.file_stem().unwrap_or_default().to_string_lossy();
                let is_named = named.lines().any(|line| line == format!("mod {name};"));
                assert!(is_named, "{} does not name {name}", main.display());
            }
        }
        let library = |target: &&Target| target.kind.iter().any(|kind| kind.ends_with("lib"));
        for library in package.targets.iter().filter(library) {
            for file in rust_files(library.src_path.parent().expect("a folder")) {
                let text = text(&file);
                let has_test = text.contains("#[test]") || text.contains("proptest!");
                assert!(
                    library.test || !has_test,
                    "{}: `test = false`",
                    file.display()
                );
                assert!(
                    library.doctest || only_text_blocks(&text),
                    "{}: `doctest = false`",
                    file.display()
                );
            }
        }
    }
}

/// Whether every code block of the doc comments is marked as text, and so is no example.
fn only_text_blocks(text: &str) -> bool {
    let comments = text
        .lines()
        .map(|line| line.trim_start().trim_start_matches(['/', '!', ' ']));
    let fences = |fence| {
        comments
            .clone()
            .filter(|line| line.starts_with(fence))
            .count()
    };
    fences("```") == 2 * fences("```text")
}

#[test]
fn an_example_is_distinguished_from_a_text_block() {
    let example = "/// ```\n/// x();\n/// ```\n";
    let text = "/// ```text\n/// x\n/// ```\n";
    assert!(only_text_blocks(text));
    assert!(!only_text_blocks(example) && !only_text_blocks(&[text, example].concat()));
}

#[test]
fn everything_that_is_published_has_one_version() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, line) in [
        ("CITATION.cff", format!("version: {version}")),
        ("web/package.json", format!("  \"version\": \"{version}\",")),
        (
            "web/python/pyproject.toml",
            format!("version = \"{version}\""),
        ),
    ] {
        let text = text(&root().join(file));
        assert!(text.lines().any(|found| found == line), "{file}: {line}");
    }
}
