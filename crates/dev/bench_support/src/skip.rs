//! Reports tests that cannot run on this machine in one list, or makes them fail.
//!
//! Two environment variables control it. If `SLAM_NO_SKIP` is set to anything but an empty text, `0`
//! or `false`, a skip is a failure. `SLAM_SKIPPED` is the path of the list, which has a line
//! `name: reason` for each skip. `cargo xtask test` prints it at its end.

use std::env;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::Path;

/// The reason to skip a test that needs a recorded pose graph.
pub const NO_RECORDED_GRAPHS: &str = "the graph is not in ../shared/data/graphs, beside the repository; \
     docs/testing.md says where recorded graphs come from";

/// The reason to skip a test that needs a recorded log.
pub const NO_RECORDED_LOGS: &str = "the log is not in ../shared/data/logs, beside the repository; \
     docs/testing.md says where recorded logs come from";

/// The reason to skip counting instructions.
pub const NO_VALGRIND: &str =
    "valgrind is not installed; `sudo apt-get install valgrind` installs it on Debian";

/// Reports that a test is skipped, and why; the test returns after it.
///
/// # Panics
/// If a skip is a failure, or if the list cannot be written.
pub fn skip(name: &str, reason: &str) {
    tell(name, reason).unwrap_or_else(|message| panic!("{message}"));
}

/// Does the same as [`skip`] for code that is not a test.
///
/// # Errors
/// One sentence if a skip is a failure, or if the list cannot be written.
pub fn tell(name: &str, reason: &str) -> Result<(), String> {
    let no_skip = env::var("SLAM_NO_SKIP").ok();
    let list = env::var_os("SLAM_SKIPPED");
    record(
        name,
        reason,
        no_skip.as_deref(),
        list.as_deref().map(Path::new),
    )
}

fn record(
    name: &str,
    reason: &str,
    no_skip: Option<&str>,
    list: Option<&Path>,
) -> Result<(), String> {
    if !matches!(no_skip, None | Some("" | "0" | "false")) {
        return Err(format!("{name}: {reason}, and SLAM_NO_SKIP forbids skips"));
    }
    println!("skipped {name}: {reason}");
    let Some(list) = list else { return Ok(()) };
    OpenOptions::new()
        .create(true)
        .append(true)
        .open(list)
        // One write call, because tests append at the same time.
        .and_then(|mut file| file.write_all(format!("{name}: {reason}\n").as_bytes()))
        .map_err(|error| format!("{}: {error}", list.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_skipped_is_appended_to_the_list() {
        let list = env::temp_dir().join(format!("slam-skipped-{}", std::process::id()));
        record("one", "no data", None, Some(&list)).unwrap();
        record("two", "no valgrind", Some("0"), Some(&list)).unwrap();
        let written = std::fs::read_to_string(&list).unwrap();
        std::fs::remove_file(&list).unwrap();
        assert_eq!(written, "one: no data\ntwo: no valgrind\n");
    }

    #[test]
    fn nothing_skips_where_nothing_may() {
        let message = record("one", "no data", Some("1"), None).unwrap_err();
        assert_eq!(message, "one: no data, and SLAM_NO_SKIP forbids skips");
        assert!(record("one", "no data", None, None).is_ok());
    }

    #[test]
    fn a_list_that_cannot_be_written_is_named() {
        let absent = Path::new("/absent/folder/list");
        let message = record("one", "no data", None, Some(absent)).unwrap_err();
        assert!(message.starts_with("/absent/folder/list: "), "{message}");
    }
}
