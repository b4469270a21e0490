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

/// The libraries in the order of the data flow, each with its allowed dependencies.
const CORE: [(&str, &[&str]); 9] = [
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

/// Each house with the houses that it may use besides itself, as its README says.
const HOUSES: [(&str, &[&str]); 8] = [
    ("crates/core", &[]),
    (
        "crates/robots",
        &["crates/core", "crates/dev/bench_support"],
    ),
    (
        "crates/chapter",
        &[
            "crates/core",
            "crates/robots",
            "crates/dev/bench_support",
            "teaching/exercises",
        ],
    ),
    (
        "widgets",
        &["crates/core", "crates/robots", "crates/chapter"],
    ),
    (
        "web",
        &["crates/core", "crates/robots", "crates/chapter", "widgets"],
    ),
    (
        "teaching",
        &[
            "crates/core",
            "crates/robots/command_line",
            "crates/dev/bench_support",
            "widgets",
        ],
    ),
    ("crates/dev", &["crates", "teaching", "widgets"]),
    ("tests", &["crates", "teaching", "widgets", "web"]),
];

/// Python has the experiments, too, and the worker lets a reader's function drive a lap.
const EXCEPTIONS: [(&str, &str); 2] = [
    ("crates/robots/slam2d_py", "crates/chapter/ch16_lab"),
    ("crates/robots/worker", "crates/chapter/ch16_lab"),
];

#[test]
fn a_house_uses_what_its_readme_says() {
    let packages = packages();
    let paths: BTreeMap<&str, String> = packages
        .iter()
        .map(|package| (package.name.as_str(), package.path()))
        .collect();
    let mut houses = BTreeSet::new();
    for package in &packages {
        let path = package.path();
        let is_in =
            |path: &str, house: &str| path == house || path.starts_with(&format!("{house}/"));
        let (house, others) = HOUSES
            .iter()
            .find(|(house, _)| is_in(&path, house))
            .unwrap_or_else(|| panic!("{path} is in no house"));
        houses.insert(house);
        for used in package.uses().filter_map(|used| paths.get(used)) {
            let may = is_in(used, house) || others.iter().any(|other| is_in(used, other));
            assert!(
                may || EXCEPTIONS.contains(&(&path, used)),
                "{path} uses {used}"
            );
        }
    }
    assert_eq!(houses.len(), HOUSES.len());
    for (house, _) in &HOUSES[..7] {
        let readme = source(&format!("{house}/README.md"));
        assert!(readme.contains("May use: "), "{house}");
        assert!(readme.lines().count() <= 50, "{house}: more than a screen");
    }
}

/// The packages that a package is compiled with, those of its tests included.
fn tree(package: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--prefix=none", "--package", package])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{output:?}");
    let lines = String::from_utf8(output.stdout).expect("cargo prints text");
    let names = lines.lines().filter_map(|line| line.split(' ').next());
    names.map(str::to_owned).collect()
}

#[test]
fn a_robots_owner_compiles_neither_egui_nor_widgets_nor_c() {
    let (robots, marks) = (tree("slam2d"), tree("ch16_mark"));
    // `cc` compiles C.
    for unwanted in ["widget_kit", "widgets", "rquickjs", "cc"] {
        assert!(!robots.contains(unwanted), "{unwanted}");
        assert!(marks.contains(unwanted), "{unwanted} has another name now");
    }
    assert!(!robots.contains("egui") && tree("widgets").contains("egui"));
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

/// The paths that code names from `crate` or `super` on; a group in braces is expanded.
fn relative_paths(code: &str) -> Vec<String> {
    let mut paths = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if !before.is_some_and(|c| c.is_alphanumeric() || ['_', ':', '$'].contains(&c)) {
                expand(start, &code[at + start.len()..], &mut paths);
            }
        }
    }
    paths
}

/// Appends the paths that begin with `prefix`, and returns what stands behind them.
fn expand<'a>(prefix: &str, rest: &'a str, paths: &mut Vec<String>) -> &'a str {
    let rest = rest.trim_start();
    if let Some(mut group) = rest.strip_prefix('{') {
        loop {
            group = expand(prefix, group, paths);
            let Some(end) = group.find([',', '}']) else {
                return "";
            };
            let is_closed = group[end..].starts_with('}');
            group = &group[end + 1..];
            if is_closed {
                return group;
            }
        }
    }
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
    let (name, rest) = rest.split_at(end.unwrap_or(rest.len()));
    let path = format!("{prefix}{name}");
    match rest.strip_prefix("::") {
        Some(rest) if !name.is_empty() => expand(&format!("{path}::"), rest, paths),
        _ => {
            paths.extend((!name.is_empty()).then_some(path));
            rest
        }
    }
}

/// Which of modules beside each other use which, by the text of each module.
fn uses_of(modules: &BTreeMap<String, String>) -> BTreeSet<(String, String)> {
    let mut uses = BTreeSet::new();
    for (module, text) in modules {
        let code = text.split("mod tests {").next().unwrap_or_default();
        let code = code
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect::<Vec<_>>()
            .join("\n");
        for path in relative_paths(&code) {
            let user: Vec<&str> = module.split("::").collect();
            let kept = match path.matches("super::").count() {
                0 => 0,
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
    uses
}

/// What remains of `uses` without those that use none of the rest: the circles, and what leads to them.
fn circles(mut uses: BTreeSet<(String, String)>) -> BTreeSet<(String, String)> {
    let mut before = usize::MAX;
    while uses.len() < before {
        before = uses.len();
        let users: BTreeSet<String> = uses.iter().map(|(user, _)| user.clone()).collect();
        uses.retain(|(_, used)| users.contains(used));
    }
    uses
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
        let found = circles(uses_of(&modules));
        assert!(found.is_empty(), "{}: {found:?}", package.name);
    }
}

#[test]
fn a_circle_is_seen_over_several_lines_and_modules() {
    let circle = |a: &str, b: &str, c: &str| {
        let modules = [("a", a), ("b", b), ("b::c", c)];
        let modules = modules.map(|(name, text)| (name.to_owned(), text.to_owned()));
        !circles(uses_of(&modules.into())).is_empty()
    };
    assert!(circle(
        "use super::{\n    d,\n    b::{self, B},\n};",
        "",
        "use crate::{a::A};"
    ));
    assert!(circle("fn f() { super::b::g() }", "use crate::a;", ""));
    assert!(circle(
        "use crate::{x, b as y};",
        "",
        "use super::super::{a};"
    ));
    assert!(!circle(
        "use super::{\n    b,\n};",
        "// use super::a;\nuse super::c;",
        "use super::b;"
    ));
}

/// TypeScript files below a folder, without declarations.
fn scripts(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder is there").flatten();
    entries
        .map(|entry| entry.path())
        .flat_map(|path| match path.to_string_lossy() {
            _ if path.is_dir() => scripts(&path),
            name if name.ends_with(".ts") && !name.ends_with(".d.ts") => vec![path.clone()],
            _ => Vec::new(),
        })
        .collect()
}

/// The modules beside a script that it imports: `from './x'` or `from '../x'`.
fn imports(script: &Path, text: &str) -> Vec<PathBuf> {
    let folder = script.parent().expect("a file has a folder");
    text.split("from '")
        .skip(1)
        .filter_map(|rest| rest.split('\'').next())
        .filter(|name| name.starts_with('.'))
        .map(|name| {
            let mut path = folder.to_owned();
            for part in name.split('/').filter(|part| *part != ".") {
                match part {
                    ".." => {
                        path.pop();
                    }
                    part => path.push(part),
                }
            }
            path.with_extension("ts")
        })
        .collect()
}

#[test]
fn scripts_form_no_circle() {
    let mut uses = BTreeSet::new();
    for folder in ["web/ts", "web/page"] {
        for script in scripts(&root().join(folder)) {
            let imported = imports(&script, &text(&script));
            let imported = imported.into_iter().filter(|path| path.is_file());
            let name = |path: &Path| path.to_string_lossy().into_owned();
            uses.extend(imported.map(|path| (name(&script), name(&path))));
        }
    }
    assert!(uses.len() > 100, "{} imports are seen", uses.len());
    let found = circles(uses);
    assert!(found.is_empty(), "{found:?}");
}

/// The one module of the page that draws walls, robots and what a sensor sees.
const PLANS: &str = "web/page/world";

/// What a drawer of plans contains: a path on a canvas, a filled outline, or the colours of walls.
fn part_of_a_plan(text: &str) -> Option<&'static str> {
    let parts = [
        "lineTo(",
        ".area(",
        ".fan(",
        "<polygon",
        "'wall'",
        "wall-edge",
        "--wall",
    ];
    parts.into_iter().find(|part| text.contains(part))
}

#[test]
fn one_module_draws_every_plan_of_the_page() {
    // A diagram of counts.
    let chart = root().join("web/page/laps/strip.ts");
    let mut seen = 0;
    let mut folders = vec![root().join("web/page"), root().join("web/ts")];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(folder).expect("the folder is there").flatten();
        for path in entries.map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let part = part_of_a_plan(&text(&path));
            if path.starts_with(root().join(PLANS)) {
                seen += usize::from(part.is_some());
            } else if path != chart {
                assert_eq!(part, None, "{} belongs into {PLANS}", path.display());
            }
        }
    }
    assert_eq!(seen, 2, "files of {PLANS} draw");
    assert_eq!(part_of_a_plan(&text(&root().join("index.html"))), None);
    let second = "context.moveTo(x, y); context.lineTo(x + length, y);";
    assert!(part_of_a_plan(second).is_some());
}

#[test]
fn an_import_is_seen_over_several_lines() {
    let text =
        "import {\n  A,\n  type B,\n} from './b';\nexport * from '../c/d';\nimport x from 'y';";
    let found = imports(Path::new("/web/ts/a.ts"), text);
    let expected = ["/web/ts/b.ts", "/web/c/d.ts"].map(PathBuf::from);
    assert_eq!(found, expected);
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
