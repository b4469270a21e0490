//! Pose graphs in the text format of g2o.
//!
//! One record a line, fields separated by blanks, `#` starts a comment line:
//!
//! ```text
//! VERTEX_SE2 id x y theta
//! EDGE_SE2 from to dx dy dtheta I_xx I_xy I_xt I_yy I_yt I_tt
//! FIX id …
//! ```
//!
//! Any other record is kept as it is and written back in its place. Where no `FIX` names a vertex,
//! the first one holds the gauge.
//! Source: Kümmerle, Grisetti, Strasdat, Konolige, Burgard, "g2o: a general framework for graph
//! optimization", 2011.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

use nalgebra::Matrix3;
use pr_geom::SE2;
use thiserror::Error;

use crate::factor::Between;
use crate::problem::Problem;

/// What is wrong with a file, and in which line.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("line {line}: {problem}")]
pub struct G2oError {
    /// Line number, from 1.
    pub line: usize,
    /// What is wrong there.
    pub problem: G2oProblem,
}

/// What can be wrong with a line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum G2oProblem {
    /// A record has too few or too many fields.
    #[error("{record} needs {expected} numbers, found {found}")]
    FieldCount {
        /// Name of the record.
        record: &'static str,
        /// How many fields it has.
        expected: usize,
        /// How many fields there are.
        found: usize,
    },
    /// A field is not a number.
    #[error("`{field}` is not a finite number")]
    NotANumber {
        /// The field as it stands.
        field: String,
    },
    /// A field is not a vertex id.
    #[error("`{field}` is not a vertex id")]
    NotAnId {
        /// The field as it stands.
        field: String,
    },
    /// Two vertices have the same id.
    #[error("vertex {id} is already in line {first_line}")]
    DuplicateVertex {
        /// The id.
        id: i64,
        /// Where it was first.
        first_line: usize,
    },
    /// A record names a vertex that the file does not have.
    #[error("there is no vertex {id}")]
    UnknownVertex {
        /// The id.
        id: i64,
    },
    /// An edge starts and ends at the same vertex.
    #[error("an edge from vertex {id} to itself")]
    SelfEdge {
        /// The id.
        id: i64,
    },
    /// An information matrix has a negative eigenvalue.
    #[error("the information matrix is not positive semi-definite")]
    IndefiniteInformation,
    /// Nothing ties a vertex to a fixed one.
    #[error("no chain of edges ties vertex {id} to a fixed vertex")]
    Disconnected {
        /// The id.
        id: i64,
    },
    /// The file has no vertex.
    #[error("the file has no VERTEX_SE2")]
    Empty,
}

/// A file that was read: the graph, and the lines as they were.
#[derive(Clone, Debug)]
pub struct G2oFile {
    /// The graph; nodes are numbered in the order of the file.
    pub problem: Problem,
    lines: Vec<String>,
    vertices: Vec<VertexLine>,
}

#[derive(Clone, Copy, Debug)]
struct VertexLine {
    id: i64,
    line: usize,
}

/// One record, as far as it is understood.
enum Record {
    Vertex {
        id: i64,
        pose: SE2,
    },
    Edge {
        from: i64,
        to: i64,
        between: Between,
    },
    Fix {
        ids: Vec<i64>,
    },
    Other,
}

impl G2oFile {
    /// Reads a file's text.
    ///
    /// # Errors
    /// The first line that is malformed, names a vertex that does not exist, carries an indefinite
    /// information matrix, or declares a vertex that nothing ties to a fixed one.
    pub fn parse(text: &str) -> Result<Self, G2oError> {
        let mut problem = Problem::new();
        let mut vertices: Vec<VertexLine> = Vec::new();
        let mut node_of: HashMap<i64, usize> = HashMap::new();
        let mut edges = Vec::new();
        let mut fixes = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let at = |problem| G2oError {
                line: index + 1,
                problem,
            };
            match parse_record(line).map_err(at)? {
                Record::Vertex { id, pose } => {
                    let node = problem.add_pose(pose);
                    if let Some(first) = node_of.insert(id, node) {
                        let first_line = vertices[first].line + 1;
                        return Err(at(G2oProblem::DuplicateVertex { id, first_line }));
                    }
                    vertices.push(VertexLine { id, line: index });
                }
                Record::Edge { from, to, between } => edges.push((index, from, to, between)),
                Record::Fix { ids } => fixes.extend(ids.into_iter().map(|id| (index, id))),
                Record::Other => {}
            }
        }
        let find = |index: usize, id: i64| {
            node_of.get(&id).copied().ok_or(G2oError {
                line: index + 1,
                problem: G2oProblem::UnknownVertex { id },
            })
        };
        for (index, from, to, between) in edges {
            problem.add_factor(Between {
                from: find(index, from)?,
                to: find(index, to)?,
                ..between
            });
        }
        for (index, id) in fixes {
            problem.fix(find(index, id)?);
        }
        let mut file = Self {
            problem,
            lines: text.lines().map(str::to_owned).collect(),
            vertices,
        };
        file.hold_gauge()?;
        Ok(file)
    }

    /// The text with the vertices at `problem`'s present poses, everything else as it was.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        let mut vertices = self.vertices.iter().zip(self.problem.poses()).peekable();
        for (index, line) in self.lines.iter().enumerate() {
            match vertices.next_if(|(vertex, _)| vertex.line == index) {
                Some((vertex, pose)) => {
                    let [x, y, theta] = pose.to_array();
                    writeln!(text, "VERTEX_SE2 {} {x} {y} {theta}", vertex.id)
                }
                None => writeln!(text, "{line}"),
            }
            .expect("writing to a string");
        }
        text
    }

    /// How many records of each type were kept without being understood.
    #[must_use]
    pub fn kept_records(&self) -> BTreeMap<&str, usize> {
        let mut kept = BTreeMap::new();
        for line in &self.lines {
            if let Some(name) = line.split_whitespace().next()
                && !name.starts_with('#')
                && !matches!(name, "VERTEX_SE2" | "EDGE_SE2" | "FIX")
            {
                *kept.entry(name).or_default() += 1;
            }
        }
        kept
    }

    /// The id in the file of a node of the problem.
    #[must_use]
    pub fn id_of(&self, node: usize) -> i64 {
        self.vertices[node].id
    }

    /// Fixes the first vertex where none is, and checks that all hang on a fixed one.
    fn hold_gauge(&mut self) -> Result<(), G2oError> {
        if self.vertices.is_empty() {
            return Err(G2oError {
                line: self.lines.len().max(1),
                problem: G2oProblem::Empty,
            });
        }
        if !self.problem.fixed().contains(&true) {
            self.problem.fix(0);
        }
        match self.problem.first_loose_node() {
            None => Ok(()),
            Some(node) => Err(G2oError {
                line: self.vertices[node].line + 1,
                problem: G2oProblem::Disconnected {
                    id: self.vertices[node].id,
                },
            }),
        }
    }
}

fn parse_record(line: &str) -> Result<Record, G2oProblem> {
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
        "FIX" => {
            let ids: Result<_, _> = fields.iter().map(|field| vertex_id(field)).collect();
            Ok(Record::Fix { ids: ids? })
        }
        _ => Ok(Record::Other),
    }
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
        field: field.to_owned(),
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
                field: (*field).to_owned(),
            })?;
    }
    Ok(values)
}

/// Whether no principal minor is negative beyond rounding.
///
/// A matrix of rank 1 or 2 is allowed: an edge may say nothing about a direction.
fn is_positive_semidefinite(matrix: &Matrix3<f64>) -> bool {
    let m = |row: usize, column: usize| matrix[(row, column)];
    let pairs = [(0, 1), (0, 2), (1, 2)];
    // 1e-9: files print as few as ten digits, and a singular matrix so rounded is off by as much.
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
mod tests;
