//! Lines of a file, one at a time, with a bound on the memory.

use std::io::{self, BufRead, Read};

/// Longer lines are no text of a log: a scan of 10,000 beams has 100 kB.
const MOST_BYTES: usize = 1 << 22;

/// How a line ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// By its newline.
    Whole,
    /// By the end of the file.
    CutOff,
    /// It is too long to be kept; the rest of it was skipped.
    TooLong,
}

/// Reads the next line into `line`, without its newline; none at the end of the file.
pub fn next_line(
    source: &mut impl BufRead,
    line: &mut Vec<u8>,
) -> io::Result<Option<(LineEnd, u64)>> {
    line.clear();
    let mut bytes = source
        .by_ref()
        .take(MOST_BYTES as u64)
        .read_until(b'\n', line)? as u64;
    if bytes == 0 {
        return Ok(None);
    }
    let end = if line.last() == Some(&b'\n') {
        line.pop();
        LineEnd::Whole
    } else if line.len() >= MOST_BYTES {
        bytes += source.skip_until(b'\n')? as u64;
        LineEnd::TooLong
    } else {
        LineEnd::CutOff
    };
    Ok(Some((end, bytes)))
}

/// A field fit to be printed: short, and without control characters.
pub fn printable(field: &str) -> String {
    let clean: String = field.chars().filter(|c| !c.is_control()).take(24).collect();
    clean
}

/// A finite number, or what stands there instead.
pub fn finite(field: Option<&str>, name: &str) -> Result<f64, String> {
    let Some(text) = field else {
        return Err(format!("{name} is missing"));
    };
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "{name} has to be a finite number, and is ‘{}’",
            printable(text)
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_never_ends_costs_no_memory_and_the_next_one_is_read() {
        let mut text = vec![b'x'; MOST_BYTES + 100];
        text.extend_from_slice(b"\nnext");
        let mut source = &text[..];
        let mut line = Vec::new();
        let (end, bytes) = next_line(&mut source, &mut line).unwrap().unwrap();
        assert_eq!((end, bytes), (LineEnd::TooLong, MOST_BYTES as u64 + 101));
        let (end, _) = next_line(&mut source, &mut line).unwrap().unwrap();
        assert_eq!((end, &line[..]), (LineEnd::CutOff, &b"next"[..]));
        assert_eq!(next_line(&mut source, &mut line).unwrap(), None);
    }

    #[test]
    fn numbers_that_are_none_are_named() {
        assert_eq!(finite(Some("1.5"), "x"), Ok(1.5));
        for (field, said) in [
            (Some("nan"), "x has to be a finite number, and is ‘nan’"),
            (Some("1,5"), "x has to be a finite number, and is ‘1,5’"),
            (None, "x is missing"),
        ] {
            assert_eq!(finite(field, "x").unwrap_err(), said);
        }
    }
}
