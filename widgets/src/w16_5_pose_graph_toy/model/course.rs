//! The solver's steps from the poses set by the reader.

use ch16_slam2d::graph::{EdgeId, EdgeView, PoseGraph};
use pr_geom::SE2;

use crate::w16_5_pose_graph_toy::spec::MAX_STEPS;

/// The steps end if no pose moves by more, m and rad added.
const REST: f64 = 1e-6;

/// The graph after a number of steps.
pub struct GraphState {
    /// The poses.
    pub poses: Vec<SE2>,
    /// `eᵀΩe` of each edge.
    pub edge_chi2: Vec<f64>,
    /// Their sum.
    pub chi2: f64,
    /// The largest movement of a pose in the step to here, m and rad added; 0 at the start.
    pub moved: f64,
}

/// All steps to convergence.
pub struct SolverRun {
    /// The edges, which are constant.
    pub edges: Vec<EdgeView>,
    /// The start, and the graph after each step.
    pub moments: Vec<GraphState>,
    /// Whether a step failed.
    pub failed: bool,
}

impl SolverRun {
    /// Runs the steps until no pose moves any more.
    pub fn new(mut graph: PoseGraph) -> Self {
        let edges: Vec<_> = graph.edges().collect();
        let mut moments = vec![moment(&graph, &edges, 0.0)];
        let mut failed = false;
        while moments.len() <= MAX_STEPS {
            let moved = graph.optimize_once(f64::INFINITY);
            if !moved.is_finite() {
                failed = true;
                break;
            }
            if moved < REST {
                break;
            }
            moments.push(moment(&graph, &edges, moved));
        }
        Self {
            edges,
            moments,
            failed,
        }
    }

    /// Number of steps.
    pub fn last(&self) -> usize {
        self.moments.len() - 1
    }
}

fn moment(graph: &PoseGraph, edges: &[EdgeView], moved: f64) -> GraphState {
    let of = |id: EdgeId| graph.edge_chi2(id);
    GraphState {
        poses: graph.poses().to_vec(),
        edge_chi2: edges.iter().map(|edge| of(edge.id)).collect(),
        chi2: graph.chi2(),
        moved,
    }
}
