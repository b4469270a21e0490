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
//! All other records are preserved and written back in place, with their bytes and line ends. Comments may have
//! any encoding, everything else is UTF-8. Without a `FIX` record the first vertex is fixed. Source: Kümmerle,
//! Grisetti, Strasdat, Konolige, Burgard, "g2o: a general framework for graph optimization", 2011.

mod record;

use std::collections::BTreeMap;
use std::io::Write as _;

use thiserror::Error;

use crate::factor::Between;
use crate::problem::Problem;
use record::{Record, content, is_kept, parse_record, printable};

/// A problem in a file, with its line.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("line {line}: {problem}")]
pub struct G2oError {
    /// Line number, from 1.
    pub line: usize,
    /// The problem.
    pub problem: G2oProblem,
}

/// Problems of a line.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum G2oProblem {
    /// A record has too few or too many fields.
    #[error("{record} needs {expected} numbers, found {found}")]
    FieldCount {
        /// Name of the record.
        record: &'static str,
        /// Expected number of fields.
        expected: usize,
        /// Number of fields found.
        found: usize,
    },
    /// A field is not a number.
    #[error("`{field}` is not a finite number")]
    NotANumber {
        /// The field, escaped and shortened for printing.
        field: String,
    },
    /// A field is not a vertex id.
    #[error("`{field}` is not a vertex id")]
    NotAnId {
        /// The field, escaped and shortened for printing.
        field: String,
    },
    /// A record is not UTF-8.
    #[error("the line is not UTF-8 text")]
    NotText,
    /// A FIX record has no vertex id.
    #[error("FIX names no vertex")]
    EmptyFix,
    /// Two vertices have the same id.
    #[error("vertex {id} is already in line {first_line}")]
    DuplicateVertex {
        /// The id.
        id: i64,
        /// Line of its first declaration.
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
    /// A vertex is not connected to a fixed one.
    #[error("vertex {id} is not connected to a fixed vertex by edges")]
    Disconnected {
        /// The id.
        id: i64,
    },
    /// The file has no vertex.
    #[error("the file has no VERTEX_SE2")]
    Empty,
}

/// A parsed file: the graph, and the original lines.
#[derive(Clone, Debug)]
pub struct G2oFile {
    /// The graph; nodes are numbered in the order of the file.
    pub problem: Problem,
    /// The file without a byte order mark.
    text: Vec<u8>,
    vertices: Vec<VertexLine>,
    /// Line of every factor, from 0.
    edge_lines: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct VertexLine {
    id: i64,
    /// From 0.
    line: usize,
}

/// Byte order mark, which some editors write before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

impl G2oFile {
    /// Parses the text of a file.
    ///
    /// # Errors
    /// The first line that is malformed, refers to an unknown vertex, has an indefinite information matrix, or
    /// declares a vertex that is not connected to a fixed one.
    pub fn parse(text: impl AsRef<[u8]>) -> Result<Self, G2oError> {
        let mut text = text.as_ref();
        // Concatenated files have more than one.
        while let Some(rest) = text.strip_prefix(BYTE_ORDER_MARK) {
            text = rest;
        }
        let mut problem = Problem::new();
        let mut vertices: Vec<VertexLine> = Vec::new();
        let mut node_of: BTreeMap<i64, usize> = BTreeMap::new();
        let mut edges = Vec::new();
        let mut fixes = Vec::new();
        for (index, line) in lines_of(text).enumerate() {
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
        let mut edge_lines = Vec::with_capacity(edges.len());
        for (index, from, to, between) in edges {
            problem.add_factor(Between {
                from: find(index, from)?,
                to: find(index, to)?,
                ..between
            });
            edge_lines.push(index);
        }
        for (index, id) in fixes {
            problem.fix(find(index, id)?);
        }
        let mut file = Self {
            problem,
            text: text.to_vec(),
            vertices,
            edge_lines,
        };
        file.hold_gauge()?;
        Ok(file)
    }

    /// The file with the vertices at `problem`'s present poses, everything else unchanged.
    ///
    /// Omits a byte order mark, because other readers fail on it.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut text = Vec::with_capacity(self.text.len());
        let mut vertices = self.vertices.iter().zip(self.problem.poses()).peekable();
        for (index, line) in lines_of(&self.text).enumerate() {
            match vertices.next_if(|(vertex, _)| vertex.line == index) {
                Some((vertex, pose)) => {
                    let [x, y, theta] = pose.to_array();
                    write!(text, "VERTEX_SE2 {} {x} {y} {theta}", vertex.id)
                        .expect("writing to memory");
                    text.extend_from_slice(&line[content(line).len()..]);
                }
                None => text.extend_from_slice(line),
            }
        }
        text
    }

    /// Number of preserved records by unsupported type; names are escaped and shortened for printing.
    #[must_use]
    pub fn kept_records(&self) -> BTreeMap<String, usize> {
        let mut kept = BTreeMap::new();
        let lines = lines_of(&self.text).filter_map(|line| std::str::from_utf8(line).ok());
        for name in lines.filter_map(|line| line.split_whitespace().next()) {
            if is_kept(name) {
                *kept.entry(printable(name)).or_default() += 1;
            }
        }
        kept
    }

    /// The id in the file of a node.
    #[must_use]
    pub fn id_of(&self, node: usize) -> i64 {
        self.vertices[node].id
    }

    /// The line, from 1, that declares a node.
    #[must_use]
    pub fn line_of(&self, node: usize) -> usize {
        self.vertices[node].line + 1
    }

    /// The line, from 1, of a factor.
    #[must_use]
    pub fn line_of_factor(&self, factor: usize) -> usize {
        self.edge_lines[factor] + 1
    }

    /// Fixes the first vertex if none is fixed, and checks that all are connected to a fixed one.
    fn hold_gauge(&mut self) -> Result<(), G2oError> {
        if self.vertices.is_empty() {
            return Err(G2oError {
                line: lines_of(&self.text).count().max(1),
                problem: G2oProblem::Empty,
            });
        }
        if !self.problem.fixed().contains(&true) {
            self.problem.fix(0);
        }
        match self.problem.first_loose_node() {
            None => Ok(()),
            Some(node) => Err(G2oError {
                line: self.line_of(node),
                problem: G2oProblem::Disconnected {
                    id: self.id_of(node),
                },
            }),
        }
    }
}

/// The lines of a file with their ends.
fn lines_of(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split_inclusive(|&byte| byte == b'\n')
}

#[cfg(test)]
mod tests;
