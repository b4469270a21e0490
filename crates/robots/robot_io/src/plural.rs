//! Counts with their nouns, for messages.

/// “1 scan”, “2 scans”.
pub(crate) fn plural(count: usize, noun: &str) -> String {
    match count {
        1 => format!("1 {noun}"),
        _ => format!("{count} {noun}s"),
    }
}
