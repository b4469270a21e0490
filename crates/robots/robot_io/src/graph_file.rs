//! Pose graphs as files: g2o, TORO and JSON.
//!
//! ```text
//! VERTEX_SE2 id x y theta                       VERTEX2 id x y theta
//! EDGE_SE2 from to dx dy dtheta                 EDGE2 from to dx dy dtheta
//!   I_xx I_xy I_xt I_yy I_yt I_tt                 I_xx I_xy I_yy I_tt I_xt I_yt
//! ```
//!
//! iSAM's `ODOMETRY from to dx dy dtheta R_xx R_xy R_xt R_yy R_yt R_tt` is read as well: its R is the upper triangular
//! square root of the information, I = RᵀR.
//!
//! On the left g2o, which [`pr_optim::g2o`] reads; on the right TORO, with another order of the
//! information. JSON has the same numbers by name.
//! Source: Grisetti, Stachniss, "TORO: tree-based network optimizer", the description of its files.

mod prepared;
mod toro;

use std::fmt::Write as _;

use pr_optim::Between;
use pr_optim::g2o::{G2oError, G2oFile};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::lines::json_words;
use prepared::is_landmark;

pub use prepared::{Prepared, prepared, with_fix_last};

/// A pose graph with the ids of its file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GraphFile {
    /// Poses.
    pub nodes: Vec<GraphNode>,
    /// Measurements between them.
    pub edges: Vec<GraphEdge>,
}

/// A pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphNode {
    /// Id in the file.
    pub id: i64,
    /// `world_from_body`: m, m, rad.
    pub pose: [f64; 3],
    /// Whether a solver keeps it fixed.
    #[serde(default)]
    pub fixed: bool,
}

/// A measured relative pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphEdge {
    /// Source node.
    pub from: i64,
    /// Target node.
    pub to: i64,
    /// The target in the frame of the source: m, m, rad.
    pub measurement: [f64; 3],
    /// Upper triangle of the information, row by row, tangent order x, y, θ.
    pub information: [f64; 6],
}

/// Why a graph cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GraphError {
    /// A line is malformed.
    #[error("{name}: {source}")]
    Text {
        /// The file's name.
        name: String,
        /// The line and what is wrong.
        source: G2oError,
    },
    /// The file is not a planar graph.
    #[error("{name}: {problem}")]
    Foreign {
        /// The file's name.
        name: String,
        /// What the file is, and what to do.
        problem: String,
    },
    /// The JSON does not describe a graph.
    #[error("{name}: expected a JSON graph with nodes and edges: {problem}")]
    Json {
        /// The file's name.
        name: String,
        /// What is wrong, with line and column.
        problem: String,
    },
}

impl GraphFile {
    /// Whether a file with these first bytes is a graph of g2o or TORO.
    #[must_use]
    pub fn begins(first_bytes: &[u8]) -> bool {
        let starts: [&[u8]; 3] = [b"VERTEX", b"EDGE", b"ODOMETRY "];
        starts.iter().any(|start| first_bytes.starts_with(start))
    }

    /// Converts a problem; `id_of` maps nodes to ids.
    fn from_problem(problem: &pr_optim::Problem, id_of: impl Fn(usize) -> i64) -> Self {
        let nodes = problem.poses().iter().zip(problem.fixed()).enumerate();
        let nodes = nodes.map(|(node, (pose, &fixed))| GraphNode {
            id: id_of(node),
            pose: pose.to_array(),
            fixed,
        });
        let edges = problem.factors().iter().map(|factor| {
            let i = &factor.information;
            GraphEdge {
                from: id_of(factor.from),
                to: id_of(factor.to),
                measurement: factor.measurement.to_array(),
                information: [
                    i[(0, 0)],
                    i[(0, 1)],
                    i[(0, 2)],
                    i[(1, 1)],
                    i[(1, 2)],
                    i[(2, 2)],
                ],
            }
        });
        Self {
            nodes: nodes.collect(),
            edges: edges.collect(),
        }
    }

    /// Converts a pose graph; nodes are numbered from 0.
    #[must_use]
    pub fn from_pose_graph(graph: &ch16_slam2d::graph::PoseGraph) -> Self {
        let mut problem = pr_optim::Problem::new();
        for (_, node) in graph.nodes() {
            if node.fixed {
                problem.add_fixed_pose(node.pose);
            } else {
                problem.add_pose(node.pose);
            }
        }
        for view in graph.edges() {
            problem.add_factor(Between {
                from: view.from.index(),
                to: view.to.index(),
                measurement: view.edge.measurement,
                information: view.edge.information,
            });
        }
        Self::from_problem(&problem, |node| node as i64)
    }

    /// Reads a graph in g2o, TORO or JSON, detected by content; returns with it what was changed or left out, a sentence
    /// each.
    ///
    /// # Errors
    /// If a line is malformed, or the file is not a planar graph.
    pub fn read(bytes: &[u8], name: &str) -> Result<(Self, Vec<String>), GraphError> {
        let text_error = |source| GraphError::Text {
            name: name.to_owned(),
            source,
        };
        if bytes.trim_ascii_start().starts_with(b"{") {
            let graph: Self = serde_json::from_slice(bytes).map_err(|e| GraphError::Json {
                name: name.to_owned(),
                problem: in_words(&e),
            })?;
            // The rules of g2o apply to every graph: ids, ends of edges, information, and connectivity.
            G2oFile::parse(graph.to_g2o()).map_err(|e| GraphError::Json {
                name: name.to_owned(),
                problem: format!("{} (as g2o, line {})", e.problem, e.line),
            })?;
            return Ok((graph, Vec::new()));
        }
        let prepared = prepared(bytes).map_err(|problem| GraphError::Foreign {
            name: name.to_owned(),
            problem,
        })?;
        let file = G2oFile::parse(&prepared.text).map_err(text_error)?;
        let mut remarks = prepared.remarks;
        for (record, count) in file.kept_records() {
            // Priors are edges now, and landmarks were named.
            if record != "EDGE_PRIOR_SE2" && !is_landmark(&record) {
                remarks.push(format!(
                    "{count} × {record} left out, not part of the graph"
                ));
            }
        }
        let remarks = remarks.iter().map(|remark| format!("{name}: {remark}"));
        let graph = Self::from_problem(&file.problem, |node| file.id_of(node));
        Ok((graph, remarks.collect()))
    }

    /// The graph in the format of g2o.
    #[must_use]
    pub fn to_g2o(&self) -> String {
        self.written(&AS_G2O)
    }

    /// The graph in the format of TORO, which has no fixed nodes: its first node fixes the gauge.
    #[must_use]
    pub fn to_toro(&self) -> String {
        self.written(&AS_TORO)
    }

    fn written(&self, records: &Records) -> String {
        let mut text = String::new();
        for GraphNode { id, pose, .. } in &self.nodes {
            let [x, y, theta] = pose;
            let _ = writeln!(text, "{} {id} {x} {y} {theta}", records.vertex);
        }
        for edge in &self.edges {
            let [x, y, theta] = edge.measurement;
            let [a, b, c, d, e, f] = records.order.map(|at| edge.information[at]);
            let _ = writeln!(
                text,
                "{} {} {} {x} {y} {theta} {a} {b} {c} {d} {e} {f}",
                records.edge, edge.from, edge.to
            );
        }
        // Last, because GTSAM 4.3 reads no edge after them.
        if let Some(fix) = records.fix {
            for node in self.nodes.iter().filter(|node| node.fixed) {
                let _ = writeln!(text, "{fix} {}", node.id);
            }
        }
        text
    }
}

/// Line, column and cause of a JSON error.
fn in_words(problem: &serde_json::Error) -> String {
    format!(
        "line {}, column {}: {}",
        problem.line(),
        problem.column(),
        json_words(problem)
    )
}

/// Names and order of a format's records.
struct Records {
    vertex: &'static str,
    edge: &'static str,
    /// `None` if the format cannot fix nodes.
    fix: Option<&'static str>,
    /// Order of the upper triangle of the information.
    order: [usize; 6],
}

const AS_G2O: Records = Records {
    vertex: "VERTEX_SE2",
    edge: "EDGE_SE2",
    fix: Some("FIX"),
    order: [0, 1, 2, 3, 4, 5],
};

const AS_TORO: Records = Records {
    vertex: "VERTEX2",
    edge: "EDGE2",
    fix: None,
    order: [0, 1, 3, 5, 2, 4],
};

#[cfg(test)]
mod tests {
    use super::*;

    const G2O: &str = "VERTEX_SE2 3 0 0 0\nVERTEX_SE2 7 1 0.5 0.25\n\
                       EDGE_SE2 3 7 1 0.5 0.25 10 1 2 20 3 30\nFIX 3\n";

    #[test]
    fn a_graph_is_the_same_in_all_three_formats() {
        let read = |bytes: &[u8]| {
            let (graph, remarks) = GraphFile::read(bytes, "x").unwrap();
            assert_eq!(remarks, [""; 0]);
            graph
        };
        let graph = read(G2O.as_bytes());
        assert_eq!(graph.to_g2o(), G2O);
        // The order of TORO's information is xx xy yy tt xt yt.
        let toro = graph.to_toro();
        assert!(toro.ends_with("EDGE2 3 7 1 0.5 0.25 10 1 20 30 2 3\n"));
        let back = read(toro.as_bytes());
        // Without FIX the first node fixes the gauge, as in the original.
        assert_eq!(back, graph);
        let json = serde_json::to_vec(&graph).unwrap();
        assert_eq!(read(&json), graph);
        let file = G2oFile::parse(graph.to_g2o()).unwrap();
        assert_eq!(file.problem.chi2(), 0.0);
    }

    #[test]
    fn what_a_graph_leaves_out_is_named() {
        let text = format!("{G2O}VERTEX_XY 9 1 1\nPARAMS_SE2OFFSET 0 0 0 0\n");
        let (graph, remarks) = GraphFile::read(text.as_bytes(), "x").unwrap();
        assert_eq!(graph.nodes.len(), 2);
        let [landmark, parameter] = &remarks[..] else {
            panic!("{remarks:?}");
        };
        assert!(landmark.starts_with("x: line 5: VERTEX_XY: landmarks are not optimized"));
        assert_eq!(
            parameter,
            "x: 1 × PARAMS_SE2OFFSET left out, not part of the graph"
        );
    }

    #[test]
    fn what_is_no_graph_is_named_with_its_line() {
        for (text, expected) in [
            (
                "VERTEX2 1 0 0\n",
                "x: line 1: VERTEX_SE2 needs 4 numbers, found 3",
            ),
            (
                "{\"nodes\": 1}",
                "x: expected a JSON graph with nodes and edges",
            ),
            ("", "x: line 1: the file has no VERTEX_SE2"),
        ] {
            let error = GraphFile::read(text.as_bytes(), "x")
                .unwrap_err()
                .to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
