//! A pose graph file, g2o, TORO or JSON, optimized step by step.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use log_messages::LoopDecision;
use pr_optim::g2o::G2oFile;
use pr_optim::{Method, Optimizer, Problem, Settings, StepReport};
use robot_io::graph_file::GraphFile;
use robot_io::quality::GATE_CHI2;

use crate::links::Link;

/// Larger text graphs are not read, bytes.
pub const MAX_BYTES: u64 = 1 << 28;
/// Initial damping of the solver, relative to the diagonal.
const DAMPING: f64 = 1e-4;

/// A graph that is being optimized.
pub struct GraphSolving {
    problem: Problem,
    optimizer: Optimizer,
    steps: Vec<StepReport>,
    /// What was changed in the file or left out, a sentence each.
    pub remarks: Vec<String>,
}

impl GraphSolving {
    /// Reads a graph; errors contain `name`.
    ///
    /// # Errors
    /// If a line is malformed; the message is one sentence.
    pub fn read(bytes: &[u8], name: &str) -> Result<Self, String> {
        let (graph, remarks) =
            GraphFile::read(bytes, name).map_err(|problem| problem.to_string())?;
        if graph.nodes.is_empty() {
            return Err(format!(
                "{name} has no poses; a graph has lines of VERTEX_SE2 and EDGE_SE2"
            ));
        }
        let mut problem = G2oFile::parse(graph.to_g2o())
            .map_err(|problem| format!("{name}: {problem}"))?
            .problem;
        if !problem.fixed().contains(&true) {
            problem = with_first_fixed(&problem);
        }
        let mut optimizer = Optimizer::new(Settings {
            method: Method::LevenbergMarquardt {
                initial_damping: DAMPING,
            },
            ..Settings::default()
        });
        optimizer.restart();
        Ok(Self {
            problem,
            optimizer,
            steps: Vec::new(),
            remarks,
        })
    }

    /// Does one step; returns false once it has ended.
    pub fn step(&mut self) -> bool {
        self.optimizer
            .advance(&mut self.problem, &mut self.steps)
            .is_none()
    }

    /// Number of steps so far.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps.len()
    }

    /// The graph for editing: edges between consecutive nodes are odometry, all others are loops.
    #[must_use]
    pub fn graph(&self) -> PoseGraph {
        let mut graph = PoseGraph::new();
        let nodes = self.problem.poses().iter().zip(self.problem.fixed());
        for (pose, &fixed) in nodes {
            if fixed {
                graph.add_fixed_node(*pose);
            } else {
                graph.add_node(*pose);
            }
        }
        for factor in self.problem.factors() {
            let kind = match factor.from.abs_diff(factor.to) {
                1 => EdgeKind::Odometry,
                _ => EdgeKind::Loop,
            };
            graph.add_edge(
                factor.from,
                factor.to,
                factor.measurement,
                factor.information,
                kind,
            );
        }
        graph
    }
}

/// The same problem with its first pose fixed.
fn with_first_fixed(problem: &Problem) -> Problem {
    let mut held = Problem::new();
    for (node, pose) in problem.poses().iter().enumerate() {
        if node == 0 {
            held.add_fixed_pose(*pose);
        } else {
            held.add_pose(*pose);
        }
    }
    for factor in problem.factors() {
        held.add_factor(*factor);
    }
    held
}

/// The loops of a graph.
#[must_use]
pub fn loops_of(graph: &PoseGraph) -> Vec<Link> {
    let loops = graph
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Loop);
    loops
        .map(|view| Link {
            old: view.from.index(),
            new: view.to.index(),
            measurement: view.edge.measurement,
            information: view.edge.information,
            found: None,
            chi2: Some(graph.edge_chi2(view.id)),
            gate_chi2: GATE_CHI2,
            reason: String::new(),
            decision: LoopDecision::Closed,
        })
        .collect()
}
