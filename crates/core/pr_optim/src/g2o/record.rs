//! Parser of one line of a g2o file.

use nalgebra::Matrix3;
use pr_geom::SE2;

use super::G2oProblem;
use crate::factor::Between;

/// Largest number of characters of a field that an error message repeats.
const MAX_PRINTED: usize = 40;

/// One parsed record.
pub enum Record {
    /// A vertex with its pose.
    Vertex {
        /// Id in the file.
        id: i64,
        /// World from body.
        pose: SE2,
    },
    /// An edge by the ids of its ends.
    Edge {
        /// Id of the vertex from which the other was measured.
        from: i64,
        /// Id of the measured vertex.
        to: i64,
        /// The measurement; its indices are not known yet.
        between: Between,
    },
    /// Fixed vertices.
    Fix {
        /// Their ids, at least one.
        ids: Vec<i64>,
    },
    /// A comment, an empty line, or a record that is preserved without being parsed.
    Other,
}

/// Parses one line. A comment may hold any bytes.
///
/// # Errors
/// The first problem of the line.
pub fn parse_record(line: &[u8]) -> Result<Record, G2oProblem> {
    if line.trim_ascii_start().starts_with(b"#") {
        return Ok(Record::Other);
    }
    let line = std::str::from_utf8(line).map_err(|_| G2oProblem::NotText)?;
    let mut fields = line.split_whitespace();
    let name = fields.next().unwrap_or("#");
    let fields: Vec<&str> = fields.collect();
    match name {
        "VERTEX_SE2" => {
            expect_fields("VERTEX_SE2", &fields, 4)?;
            let [x, y, theta] = numbers(&fields[1..])?;
            Ok(Record::Vertex {
                id: vertex_id(fields[0])?,
                pose: SE2::new(x, y, theta),
            })
        }
        "EDGE_SE2" => {
            expect_fields("EDGE_SE2", &fields, 11)?;
            let (from, to) = (vertex_id(fields[0])?, vertex_id(fields[1])?);
            if from == to {
                return Err(G2oProblem::SelfEdge { id: from });
            }
            let [x, y, theta, xx, xy, xt, yy, yt, tt] = numbers(&fields[2..])?;
            let information = Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt);
            if !is_positive_semidefinite(&information) {
                return Err(G2oProblem::IndefiniteInformation);
            }
            let between = Between {
                from: 0,
                to: 0,
                measurement: SE2::new(x, y, theta),
                information,
            };
            Ok(Record::Edge { from, to, between })
        }
        "FIX" if fields.is_empty() => Err(G2oProblem::EmptyFix),
        "FIX" => {
            let ids: Result<_, _> = fields.iter().map(|field| vertex_id(field)).collect();
            Ok(Record::Fix { ids: ids? })
        }
        _ => Ok(Record::Other),
    }
}

/// A line without its line end, and without a carriage return before it.
pub fn content(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// Whether a record of this name is preserved without being parsed, and is no comment.
pub fn is_kept(name: &str) -> bool {
    !name.starts_with('#') && !matches!(name, "VERTEX_SE2" | "EDGE_SE2" | "FIX")
}

/// Escapes control characters of a field and limits its length for a one-line message.
pub fn printable(field: &str) -> String {
    let mut shown: String = field.chars().take(MAX_PRINTED).collect();
    let is_whole = shown.len() == field.len();
    shown = shown.escape_debug().collect();
    if !is_whole {
        shown.push('…');
    }
    shown
}

fn expect_fields(record: &'static str, fields: &[&str], expected: usize) -> Result<(), G2oProblem> {
    if fields.len() == expected {
        Ok(())
    } else {
        Err(G2oProblem::FieldCount {
            record,
            expected,
            found: fields.len(),
        })
    }
}

fn vertex_id(field: &str) -> Result<i64, G2oProblem> {
    field.parse().map_err(|_| G2oProblem::NotAnId {
        field: printable(field),
    })
}

fn numbers<const N: usize>(fields: &[&str]) -> Result<[f64; N], G2oProblem> {
    let mut values = [0.0; N];
    for (value, field) in values.iter_mut().zip(fields) {
        *value = field
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| G2oProblem::NotANumber {
                field: printable(field),
            })?;
    }
    Ok(values)
}

/// Whether no principal minor is negative beyond rounding.
///
/// Rank 1 or 2 is allowed: an edge may leave a direction unconstrained.
fn is_positive_semidefinite(matrix: &Matrix3<f64>) -> bool {
    let m = |row: usize, column: usize| matrix[(row, column)];
    let pairs = [(0, 1), (0, 2), (1, 2)];
    // 1e-9: files print as few as ten digits, and a rounded singular matrix deviates by as much.
    let slack = 1e-9;
    let minors = pairs
        .iter()
        .map(|&(i, j)| m(i, i) * m(j, j) * (1.0 + slack) - m(i, j) * m(i, j));
    let volume = m(0, 0) * m(1, 1) * m(2, 2);
    (0..3).all(|axis| m(axis, axis) >= 0.0)
        && minors.into_iter().all(|minor| minor >= 0.0)
        && matrix.determinant() >= -slack * volume
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_information_matrix_is_allowed() {
        assert!(is_positive_semidefinite(&Matrix3::new(
            1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0
        )));
        assert!(!is_positive_semidefinite(&Matrix3::new(
            1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0
        )));
    }

    #[test]
    fn printed_fields_are_escaped_and_shortened() {
        assert_eq!(printable("VERTEX_XY"), "VERTEX_XY");
        assert_eq!(printable("a\u{1b}[2Jb"), "a\\u{1b}[2Jb");
        assert_eq!(printable(&"é".repeat(41)), format!("{}…", "é".repeat(40)));
    }
}
