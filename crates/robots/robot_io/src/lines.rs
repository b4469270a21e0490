//! Reads lines one at a time in bounded memory.

use std::io::{self, BufRead};

/// Longer lines are not log text: a scan of 10,000 beams has 100 kB.
const MAX_BYTES: usize = 1 << 22;

/// How a line ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// By its newline.
    Whole,
    /// By the end of the file.
    CutOff,
    /// Too long to be kept; the rest was skipped.
    TooLong,
}

/// Reads the next line into `line` without its end; `None` at the end of the file.
///
/// Lines end with LF, CR LF, or CR alone.
pub fn next_line(
    source: &mut impl BufRead,
    line: &mut Vec<u8>,
) -> io::Result<Option<(LineEnd, u64)>> {
    line.clear();
    let (mut bytes, mut is_kept) = (0, true);
    loop {
        let buffer = filled(source)?;
        if buffer.is_empty() {
            return Ok((bytes > 0).then_some((ended(LineEnd::CutOff, is_kept), bytes)));
        }
        let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let part = &buffer[..end.unwrap_or(buffer.len())];
        let room = MAX_BYTES - line.len();
        is_kept &= part.len() <= room;
        line.extend_from_slice(&part[..part.len().min(room)]);
        let is_cr = end.is_some_and(|end| buffer[end] == b'\r');
        let used = part.len() + usize::from(end.is_some());
        source.consume(used);
        bytes += used as u64;
        if end.is_some() {
            if is_cr && filled(source)?.first() == Some(&b'\n') {
                source.consume(1);
                bytes += 1;
            }
            return Ok(Some((ended(LineEnd::Whole, is_kept), bytes)));
        }
    }
}

/// The end of a line, or `TooLong` if it was not kept in full.
fn ended(end: LineEnd, is_kept: bool) -> LineEnd {
    if is_kept { end } else { LineEnd::TooLong }
}

/// Bytes that are available, at least one; empty at the end.
fn filled(source: &mut impl BufRead) -> io::Result<&[u8]> {
    while let Err(error) = source.fill_buf() {
        if error.kind() != io::ErrorKind::Interrupted {
            return Err(error);
        }
    }
    source.fill_buf()
}

/// A field for messages: short, and without control characters.
pub fn printable(field: &str) -> String {
    clipped(field, 24)
}

/// The start of a line, for messages.
pub fn excerpt(line: &str) -> String {
    let start = clipped(line, 48);
    if start.len() < line.len() {
        format!("{start}…")
    } else {
        start
    }
}

/// A name from a file, of a topic, type or frame. ROS 2 allows 255 characters.
pub fn name(text: &str) -> String {
    clipped(text, 255)
}

/// The JSON reader's message without its own position; bounded because it may quote the text.
pub fn json_words(problem: &serde_json::Error) -> String {
    let text = problem.to_string();
    let end = text.find(" at line ").unwrap_or(text.len());
    clipped(&text[..end], 200)
}

/// Joins names up to a readable length.
pub fn listed(names: impl Iterator<Item = String>) -> String {
    let mut list = String::new();
    for name in names {
        if list.len() + name.len() > 1000 {
            list.push_str(", …");
            break;
        }
        if !list.is_empty() {
            list.push_str(", ");
        }
        list.push_str(&name);
    }
    list
}

/// At most `most` characters of a text, without control characters.
fn clipped(text: &str, most: usize) -> String {
    let spaced = text.chars().map(|c| if c == '\t' { ' ' } else { c });
    let clean = spaced.filter(|c| !c.is_control());
    clean.take(most).collect()
}

/// Parses a finite number.
pub fn finite(field: Option<&str>, name: &str) -> Result<f64, String> {
    let Some(text) = field else {
        return Err(format!("{name} is missing"));
    };
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "{name} must be a finite number, not ‘{}’{}",
            printable(text),
            decimal_comma(text)
        )),
    }
}

/// What to do about a word that is no number because of its decimal comma.
pub fn decimal_comma(text: &str) -> &'static str {
    let is_comma = text.replacen(',', ".", 1).parse::<f64>().is_ok();
    if is_comma && text.contains(',') {
        "; write its decimals after a point"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_never_ends_costs_no_memory_and_the_next_one_is_read() {
        let mut text = vec![b'x'; MAX_BYTES + 100];
        text.extend_from_slice(b"\nnext");
        let mut source = &text[..];
        let mut line = Vec::new();
        let (end, bytes) = next_line(&mut source, &mut line).unwrap().unwrap();
        assert_eq!((end, bytes), (LineEnd::TooLong, MAX_BYTES as u64 + 101));
        let (end, _) = next_line(&mut source, &mut line).unwrap().unwrap();
        assert_eq!((end, &line[..]), (LineEnd::CutOff, &b"next"[..]));
        assert_eq!(next_line(&mut source, &mut line).unwrap(), None);
    }

    #[test]
    fn a_line_ends_as_any_system_ends_it() {
        for text in [
            "one\ntwo\n\nthree",
            "one\r\ntwo\r\n\r\nthree",
            "one\rtwo\r\rthree",
        ] {
            // A buffer of one byte: CR and LF come apart.
            for capacity in [1, 64] {
                let mut source = io::BufReader::with_capacity(capacity, text.as_bytes());
                let (mut lines, mut line, mut read) = (Vec::new(), Vec::new(), 0);
                while let Some((_, bytes)) = next_line(&mut source, &mut line).unwrap() {
                    lines.push(String::from_utf8(line.clone()).unwrap());
                    read += bytes;
                }
                assert_eq!(lines, ["one", "two", "", "three"], "{text:?}");
                assert_eq!(read, text.len() as u64);
            }
        }
    }

    #[test]
    fn text_of_a_file_is_printed_on_one_line_of_readable_length() {
        assert_eq!(name("/sc\nan\u{7f}"), "/scan");
        let other: Result<u8, _> = serde_json::from_str(&format!("\"{}\"", "x".repeat(10_000)));
        assert_eq!(json_words(&other.unwrap_err()).len(), 200);
        let names = (0..1000).map(|number| format!("/topic_{number}"));
        let list = listed(names);
        assert!(list.starts_with("/topic_0, /topic_1, ") && list.ends_with(", …"));
        assert!(list.len() < 1010, "{list}");
    }

    #[test]
    fn numbers_that_are_none_are_named() {
        assert_eq!(finite(Some("1.5"), "x"), Ok(1.5));
        for (field, expected) in [
            (Some("nan"), "x must be a finite number, not ‘nan’"),
            (
                Some("1,5"),
                "x must be a finite number, not ‘1,5’; write its decimals after a point",
            ),
            (None, "x is missing"),
        ] {
            assert_eq!(finite(field, "x").unwrap_err(), expected);
        }
    }
}
