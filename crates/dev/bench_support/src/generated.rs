//! Writes generated blocks into a document, each between two marks.

use std::fs;
use std::path::Path;

/// Replaces the text between the two marks of a page.
///
/// # Errors
/// One line if the page cannot be read or written, or lacks the marks.
pub fn write_into(page: &Path, marks: [&str; 2], text: &str) -> Result<(), String> {
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", page.display());
    let old = fs::read_to_string(page).map_err(|error| say(&error))?;
    let new = replaced(&old, marks, text).ok_or_else(|| {
        say(&format!(
            "the marks {} and {} are missing",
            marks[0], marks[1]
        ))
    })?;
    fs::write(page, new).map_err(|error| say(&error))
}

/// Returns the page with new text between the marks.
fn replaced(page: &str, [start, end]: [&str; 2], text: &str) -> Option<String> {
    let (before, rest) = page.split_once(start)?;
    let (_, after) = rest.split_once(end)?;
    Some(format!("{before}{start}\n{text}\n{end}{after}"))
}

/// Returns processor, number of cores and system, as far as they are known.
#[must_use]
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let known = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = known
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .and_then(|line| line.split_once(": "))
        .map_or(std::env::consts::ARCH, |(_, model)| model);
    format!("{model}, {cores} cores, {}", std::env::consts::OS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_block_replaces_the_old_one_and_nothing_else() {
        let marks = ["<!-- start -->", "<!-- end -->"];
        let [start, end] = marks;
        let page = format!("# Title\n{start}\nold\n{end}\nmore");
        let expected = format!("# Title\n{start}\nnew\n{end}\nmore");
        assert_eq!(replaced(&page, marks, "new"), Some(expected));
        assert_eq!(replaced("no marks", marks, "new"), None);
    }
}
