//! The subcommands that other programs took over, for one release.

use anyhow::anyhow;

/// The programs, their packages' folders, and the subcommands that moved to them.
const PROGRAMS: [(&str, &str, &[&str]); 3] = [
    (
        "ch16",
        "crates/chapter/ch16",
        &[
            "table", "lap", "laps", "basin", "terrain", "register", "places", "sweep",
        ],
    ),
    ("ch16-mark", "teaching/mark", &["mark"]),
    (
        "slam2d-dev",
        "crates/dev/slam2d_dev",
        &["logs", "recordings", "relocalize", "buildings"],
    ),
];

/// Where a subcommand is now, or that there is none of this name.
pub fn error(words: &[String]) -> anyhow::Error {
    let word = words.first().map_or("", String::as_str);
    let moved = PROGRAMS.iter().find(|(.., names)| names.contains(&word));
    let Some((program, folder, names)) = moved else {
        return anyhow!("unrecognized subcommand '{word}' (try slam2d --help)");
    };
    let now = match names {
        [_] => (*program).to_owned(),
        _ => format!("{program} {word}"),
    };
    anyhow!("slam2d {word} is now {now}; cargo install --path {folder} installs it")
}
