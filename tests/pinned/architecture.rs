//! The invariants of ARCHITECTURE.md, as far as sources can show them.

use std::fs;
use std::path::{Path, PathBuf};

use super::page::document::source;

/// Every package with its layer; a package may use only packages of lower layers.
const LAYERS: [(&str, u8); 16] = [
    ("crates/pr_geom", 0),
    ("crates/pr_sim", 1),
    ("crates/pr_grid", 1),
    ("crates/pr_optim", 1),
    ("crates/ch16_slam2d", 2),
    ("crates/ch16_lab", 3),
    ("crates/robot_io", 3),
    ("crates/slam2d_cli", 4),
    ("crates/solver_peers", 3),
    ("crates/measuring", 0),
    ("crates/xtask", 0),
    ("widgets/kit", 1),
    ("widgets", 4),
    ("web", 5),
    ("web/desktop", 6),
    ("web/robot", 5),
];

const CORE: [&str; 7] = [
    "crates/pr_geom",
    "crates/pr_sim",
    "crates/pr_grid",
    "crates/pr_optim",
    "crates/ch16_slam2d",
    "crates/ch16_lab",
    "crates/robot_io",
];

/// The half of the kit that a model may use.
const KIT_WITHOUT_EGUI: [&str; 10] = [
    "chart", "model", "outside", "palette", "param", "playback", "run", "scene", "spec", "ticks",
];

/// Functions of `f64` whose last bit depends on the platform.
const PLATFORM_FUNCTIONS: [&str; 20] = [
    ".sin()",
    ".cos()",
    ".tan()",
    ".sin_cos()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".exp()",
    ".exp2()",
    ".exp_m1()",
    ".ln()",
    ".ln_1p()",
    ".log2()",
    ".log10()",
    ".powf(",
    ".powi(",
    ".hypot(",
    ".cbrt()",
    "f64::sin",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All Rust files under a folder of the project, by their paths from the top level.
fn rust_files(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries =
            fs::read_dir(root().join(&folder)).unwrap_or_else(|e| panic!("{folder}: {e}"));
        for entry in entries {
            let entry = entry.expect("a folder can be listed");
            let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                folders.push(path);
            } else if path.ends_with(".rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The lines of code of a file without comments and without its tests, which stand last.
fn code_of(path: &str) -> Vec<(usize, String)> {
    let text = source(path);
    let numbered = text.lines().enumerate();
    numbered
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]" || path.ends_with("/lib.rs"))
        .map(|(index, line)| (index + 1, line.split("//").next().unwrap_or("").to_owned()))
        .collect()
}

/// Where any of `words` stands in the code of `files`.
fn occurrences(files: &[String], words: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for path in files {
        for (number, line) in code_of(path) {
            for word in words.iter().filter(|word| line.contains(**word)) {
                found.push(format!("{path}:{number}: {word}"));
            }
        }
    }
    found
}

fn core_files() -> Vec<String> {
    CORE.iter()
        .flat_map(|package| rust_files(&format!("{package}/src")))
        .collect()
}

/// Folders of the widgets' modules.
fn widgets() -> Vec<String> {
    let entries = fs::read_dir(root().join("widgets/src")).expect("the folder is there");
    let folders = entries.filter_map(|entry| {
        let path = entry.expect("a folder can be listed").path();
        let name = path.file_name()?.to_string_lossy().into_owned();
        path.is_dir().then(|| format!("widgets/src/{name}"))
    });
    folders.collect()
}

/// Files with the rules of the widgets: a widget's model, its parameters, and the kit's first half.
fn model_files() -> Vec<String> {
    let mut files: Vec<String> = rust_files("widgets/src")
        .into_iter()
        .filter(|path| path.contains("/model") || path.ends_with("/spec.rs"))
        .collect();
    files.extend(KIT_WITHOUT_EGUI.map(|name| format!("widgets/kit/src/{name}.rs")));
    files
}

/// Names of the packages that a manifest needs at run time, with the line.
fn dependencies(package: &str) -> Vec<String> {
    let manifest = source(&format!("{package}/Cargo.toml"));
    let mut names = Vec::new();
    let mut is_dependency = false;
    for line in manifest.lines() {
        if line.starts_with('[') {
            is_dependency = line.ends_with("dependencies]") && !line.contains("dev-dependencies");
        } else if is_dependency && let Some((name, _)) = line.split_once(['.', ' ', '=']) {
            names.push(name.to_owned());
        }
    }
    names
}

#[test]
fn data_flows_one_way() {
    for (package, layer) in LAYERS {
        for name in dependencies(package) {
            let below = LAYERS
                .iter()
                .find(|(path, _)| *path == name || path.ends_with(&format!("/{name}")));
            if let Some((path, below)) = below {
                assert!(
                    *below < layer,
                    "{package} (layer {layer}) uses {path} (layer {below})"
                );
            }
        }
    }
}

#[test]
fn the_estimator_does_not_know_the_simulator() {
    let manifest = source("crates/ch16_slam2d/Cargo.toml");
    assert!(manifest.contains("pr_optim"));
    for name in ["pr_sim", "ch16_lab"] {
        assert!(!manifest.contains(name), "the estimator uses {name}");
    }
}

#[test]
fn only_tests_use_the_package_of_the_tests() {
    let packages = LAYERS.iter().map(|(package, _)| *package);
    for package in packages.chain(["tests/bench"]) {
        let uses = dependencies(package).contains(&"slam2d_tests".to_owned());
        assert!(!uses, "{package} needs it outside of its tests");
    }
}

#[test]
fn only_widgets_know_egui_and_only_web_knows_the_browser() {
    for (package, _) in LAYERS {
        for name in dependencies(package) {
            let is_picture = name.starts_with("egui") || name == "eframe";
            let is_browser = ["wasm-bindgen", "wasm-bindgen-futures", "js-sys", "web-sys"]
                .contains(&name.as_str());
            let may_paint =
                package.starts_with("widgets") || ["web", "web/desktop"].contains(&package);
            let may_browse = package == "web" || package == "web/robot";
            assert!(!is_picture || may_paint, "{package} uses {name}");
            assert!(!is_browser || may_browse, "{package} uses {name}");
        }
    }
}

#[test]
fn models_know_neither_egui_nor_the_browser_nor_a_clock() {
    let files = model_files();
    assert!(files.len() >= 20, "the models have moved: {files:?}");
    let words = [
        "egui",
        "eframe",
        "web_sys",
        "wasm_bindgen",
        "Instant",
        "SystemTime",
    ];
    assert_eq!(occurrences(&files, &words), Vec::<String>::new());
}

#[test]
fn every_widget_has_the_same_files_for_the_same_things() {
    let files = [
        "spec.rs",
        "model.rs",
        "model/settings.rs",
        "model/picture.rs",
        "model/words.rs",
        "model/tables.rs",
        "view.rs",
    ];
    let guide = source("ARCHITECTURE.md");
    for file in files {
        assert!(guide.contains(&format!("`{file}`")), "{file} is missing");
        for widget in widgets() {
            let path = format!("{widget}/{file}");
            assert!(root().join(&path).exists(), "{path} is missing");
        }
    }
}

#[test]
fn every_transcendental_function_of_the_core_goes_through_one_door() {
    let found = occurrences(&core_files(), &PLATFORM_FUNCTIONS);
    assert_eq!(found, Vec::<String>::new());
    let libm = occurrences(&core_files(), &["libm::"]);
    // fmod is exact: the same bits everywhere.
    let outside = libm.iter().filter(|place| {
        !place.starts_with("crates/pr_geom/src/math.rs")
            && !place.starts_with("crates/pr_geom/src/angle.rs")
    });
    assert_eq!(outside.collect::<Vec<_>>(), Vec::<&String>::new());
}

#[test]
fn the_core_asks_no_clock_and_no_random_hash() {
    let words = [
        "Instant",
        "SystemTime",
        "RandomState",
        "std::collections::HashMap",
        // Only the standard library's map, with its random hash, is made by `new`.
        "HashMap::new()",
        "HashSet",
    ];
    assert_eq!(occurrences(&core_files(), &words), Vec::<String>::new());
}

#[test]
fn the_guide_names_every_package() {
    let guide = source("ARCHITECTURE.md");
    for (package, _) in LAYERS {
        assert!(
            guide.contains(&format!("`{package}`")),
            "{package} is missing"
        );
    }
    for folder in ["crates", "widgets"] {
        for entry in fs::read_dir(root().join(folder)).expect("the folder is there") {
            let entry = entry.expect("a folder can be listed");
            let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
            let is_package = entry.path().join("Cargo.toml").exists();
            assert!(
                !is_package || LAYERS.iter().any(|(known, _)| *known == path),
                "{path} has no layer"
            );
        }
    }
}

#[test]
fn the_page_has_the_colours_of_the_widgets() {
    let style = source("web/page/page.css");
    let palette = source("widgets/kit/src/palette.rs");
    let names = [
        "prior",
        "prediction",
        "measurement",
        "posterior",
        "truth",
        "ink",
        "faint",
        "paper",
    ];
    for name in names {
        let shades: Vec<&str> = style
            .split(&format!("  --{name}: #"))
            .skip(1)
            .map(|tail| &tail[..6])
            .collect();
        // Light, dark by the system's choice, dark by the reader's.
        assert_eq!(shades.len(), 3, "{name}");
        assert_eq!(shades[1], shades[2], "{name}");
        let tone = format!("Tone::{}{}", name[..1].to_uppercase(), &name[1..]);
        for (theme, shade) in [("Light", shades[0]), ("Dark", shades[1])] {
            let either = [
                format!("(Theme::{theme}, {tone}) => hex(0x{shade})"),
                format!("(_, {tone}) => hex(0x{shade})"),
            ];
            assert!(
                either.iter().any(|arm| palette.contains(arm)),
                "{name} in {theme} is #{shade} on the page only"
            );
        }
    }
}

#[test]
fn the_checks_see_code_and_neither_comments_nor_tests() {
    let code = code_of("crates/pr_grid/src/sensor_model.rs");
    assert!(code.iter().all(|(_, line)| !line.contains("3_f64.ln()")));
    let door = ["crates/pr_geom/src/math.rs".to_owned()];
    assert!(!occurrences(&door, &["libm::sin("]).is_empty());
}
