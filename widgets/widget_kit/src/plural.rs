//! Numbers with their nouns, for sentences.

/// “1 scan”, “2 scans”.
#[must_use]
pub fn plural(count: usize, noun: &str) -> String {
    match count {
        1 => format!("1 {noun}"),
        _ => format!("{count} {noun}s"),
    }
}
