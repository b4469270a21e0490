//! The pose graph and its solver.

use std::collections::HashMap;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use ch16_slam2d::chi_squared::quantile3;
use nalgebra::Matrix3;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods as _};
use pr_geom::SE2;
use pr_optim::robust::{GncSettings, is_sequential, select_inliers};
use pr_optim::{
    Between, JacobianModel, Method, Optimizer, Problem, RobustKernel, Settings, SolveSession,
    Start, StopReason,
};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot_io::graph_file::{GraphEdge, GraphFile, GraphNode};

use crate::arrays;
use crate::errors::{
    ArrayError, ChoiceError, GraphError, OptimizeError, count, index, no_choice, os_error, within,
};
use crate::interrupts::Listener;
use crate::reduced::{self, Reduced};

/// First damping of method "lm", relative to the diagonal.
const INITIAL_DAMPING: f64 = 1e-6;

/// Largest step, m and rad added, at which a consistent graph counts as solved: its cost is rounding noise, so a
/// relative decrease never becomes small.
const STEP_TOLERANCE: f64 = 1e-10;

/// A pose graph: poses as nodes, measured motions between them as edges.
///
/// `optimize` lowers χ² = Σ eᵀΩe with e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ) over the edges (i, j) with measurement Z and information
/// Ω. Nodes are numbered from 0 in the order in which they were added. At least one has to be fixed.
#[pyclass(frozen, module = "rustslam2d")]
pub struct PoseGraph {
    inner: Mutex<Graph>,
}

#[derive(Clone)]
struct Graph {
    problem: Problem,
    /// The ids of a file, or the nodes' numbers.
    ids: Vec<i64>,
}

/// Result of `PoseGraph.optimize`.
#[pyclass(frozen, get_all, module = "rustslam2d")]
pub struct OptimizeReport {
    /// χ² at the initial poses.
    pub chi2_initial: f64,
    /// χ² at the end, without the kernel.
    pub chi2: f64,
    /// The minimized cost: χ² if there is no kernel.
    pub cost: f64,
    /// Linear systems solved in all attempts.
    pub iterations: usize,
    /// Start of the attempt that was kept: given, spanning-tree, chordal or least-squares.
    pub start: String,
    /// Whether a convergence test was met.
    pub converged: bool,
    /// Why the solve stopped, with the numbers.
    pub stop: String,
}

reduced::restorable! {
    OptimizeReport { chi2_initial, chi2, cost, iterations, start, converged, stop }
}

#[pymethods]
impl OptimizeReport {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    fn __repr__(&self) -> String {
        format!(
            "OptimizeReport(chi2={:.6} from {:.6}, {} iterations, stop={:?})",
            self.chi2, self.chi2_initial, self.iterations, self.stop
        )
    }
}

const STARTS: [(&str, Start); 4] = [
    ("auto", Start::Auto),
    ("given", Start::Given),
    ("spanning-tree", Start::SpanningTree),
    ("chordal", Start::Chordal),
];

impl PoseGraph {
    fn lock(&self) -> MutexGuard<'_, Graph> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A copy of the graph, if every node is connected to a fixed one.
    fn tied(&self) -> PyResult<Problem> {
        let problem = self.lock().problem.clone();
        check_tied(&problem)?;
        Ok(problem)
    }

    /// Reads a graph; what was changed or left out becomes a `UserWarning` each.
    fn read(py: Python<'_>, bytes: &[u8], name: &str) -> PyResult<Self> {
        let read = py.detach(|| {
            GraphFile::read(bytes, name).map(|(file, remarks)| (Self::from_file(&file), remarks))
        });
        let (graph, remarks) = read.map_err(|error| GraphError::new_err(error.to_string()))?;
        for remark in remarks {
            PyErr::warn(
                py,
                &py.get_type::<PyUserWarning>(),
                &CString::new(remark)?,
                1,
            )?;
        }
        Ok(graph)
    }

    /// The graph of a file that was read or written by the core: every end of an edge is a node.
    pub fn from_file(file: &GraphFile) -> Self {
        let ids: Vec<i64> = file.nodes.iter().map(|node| node.id).collect();
        let mut problem = Problem::new();
        for GraphNode { pose, fixed, .. } in &file.nodes {
            let [x, y, theta] = *pose;
            let node = problem.add_pose(SE2::new(x, y, theta));
            if *fixed {
                problem.fix(node);
            }
        }
        let nodes = ids.iter().enumerate();
        let at: HashMap<i64, usize> = nodes.map(|(node, &id)| (id, node)).collect();
        for edge in &file.edges {
            let [x, y, theta] = edge.measurement;
            let [xx, xy, xt, yy, yt, tt] = edge.information;
            problem.add_factor(Between {
                from: at[&edge.from],
                to: at[&edge.to],
                measurement: SE2::new(x, y, theta),
                information: Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt),
            });
        }
        Self {
            inner: Mutex::new(Graph { problem, ids }),
        }
    }
}

impl Graph {
    /// The node with that number.
    fn node(&self, number: f64) -> PyResult<usize> {
        index("node", number, "the graph", self.problem.node_count())
    }

    fn file(&self) -> GraphFile {
        let poses = self.problem.poses().iter().zip(self.problem.fixed());
        let nodes = self.ids.iter().zip(poses);
        let edges = self.problem.factors().iter();
        GraphFile {
            nodes: nodes
                .map(|(&id, (pose, &fixed))| GraphNode {
                    id,
                    pose: pose.to_array(),
                    fixed,
                })
                .collect(),
            edges: edges
                .map(|edge| {
                    let i = &edge.information;
                    GraphEdge {
                        from: self.ids[edge.from],
                        to: self.ids[edge.to],
                        measurement: edge.measurement.to_array(),
                        information: [i.m11, i.m12, i.m13, i.m22, i.m23, i.m33],
                    }
                })
                .collect(),
        }
    }
}

/// Without this check the solver's ridge would keep a loose node at its pose.
fn check_tied(problem: &Problem) -> PyResult<()> {
    match problem.first_loose_node() {
        None => Ok(()),
        Some(node) => Err(OptimizeError::new_err(format!(
            "no chain of edges ties node {node} to a fixed node; give one node fixed=True"
        ))),
    }
}

/// The solver's error, with the node by its number.
fn py_error(error: pr_optim::OptimizeError) -> PyErr {
    OptimizeError::new_err(error.to_string())
}

#[pymethods]
impl PoseGraph {
    #[new]
    fn new() -> Self {
        Self::from_file(&GraphFile::default())
    }

    /// Reads a file of g2o, TORO or JSON; the content decides the format. What it changes or leaves out, such as landmarks,
    /// is a UserWarning.
    ///
    /// Raises OSError if the file cannot be read, GraphError with the line that is wrong.
    #[staticmethod]
    fn read_g2o(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let bytes = py.detach(|| std::fs::read(&path));
        let bytes = bytes.map_err(|error| os_error(&path, &error))?;
        Self::read(py, &bytes, &path.display().to_string())
    }

    /// Parses the text of such a file.
    ///
    /// Raises GraphError with the line that is wrong.
    #[staticmethod]
    fn from_g2o(py: Python<'_>, text: &str) -> PyResult<Self> {
        Self::read(py, text.as_bytes(), "the text")
    }

    /// The graph as text of g2o; numbers read back to the same bits.
    fn to_g2o(&self, py: Python<'_>) -> String {
        py.detach(|| self.lock().file().to_g2o())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(slf.py());
        keywords.set_item("text", slf.get().to_g2o(slf.py()))?;
        reduced::by_keywords("PoseGraph", keywords)
    }

    /// Writes the graph as a file of g2o.
    fn write_g2o(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| {
            let text = self.lock().file().to_g2o();
            std::fs::write(&path, text).map_err(|error| os_error(&path, &error))
        })
    }

    /// Adds a node at a pose world_from_body of shape (3,) and returns its number.
    ///
    /// fixed: the solver does not move it; one such node fixes the gauge.
    #[pyo3(signature = (pose, *, fixed=false))]
    fn add_node(&self, pose: &Bound<'_, PyAny>, fixed: bool) -> PyResult<usize> {
        let pose = arrays::pose("pose", pose)?;
        let mut graph = self.lock();
        let node = graph.problem.add_pose(pose);
        if fixed {
            graph.problem.fix(node);
        }
        let next = graph.ids.iter().max().map_or(0, |id| id + 1);
        graph.ids.push(next);
        Ok(node)
    }

    /// Adds the measurement that `to` is at `measurement` in the frame of `from_`, and returns the edge's number.
    ///
    /// measurement: shape (3,), m, m, rad.
    /// information: inverse covariance of the residual, shape (3, 3), order x, y, θ.
    ///
    /// Raises NumberError for a node that does not exist, GraphError for an edge from a node to itself or for an
    /// information matrix with a negative eigenvalue.
    fn add_edge(
        &self,
        from_: f64,
        to: f64,
        measurement: &Bound<'_, PyAny>,
        information: &Bound<'_, PyAny>,
    ) -> PyResult<usize> {
        let measurement = arrays::pose("measurement", measurement)?;
        let information = arrays::symmetric("information", information)?;
        let eigenvalues = information.symmetric_eigenvalues();
        // Rounding of the eigenvalues.
        if eigenvalues.min() < -1e-9 * eigenvalues.amax() {
            return Err(GraphError::new_err(
                "the information matrix is not positive semi-definite",
            ));
        }
        let mut graph = self.lock();
        let (from, to) = (graph.node(from_)?, graph.node(to)?);
        if from == to {
            return Err(GraphError::new_err(format!(
                "an edge from node {to} to itself"
            )));
        }
        graph.problem.add_factor(Between {
            from,
            to,
            measurement,
            information,
        });
        Ok(graph.problem.factors().len() - 1)
    }

    /// Moves the poses to the minimum of χ², or of its robust version.
    ///
    /// method: "gn" for Gauss–Newton, "lm" for Levenberg–Marquardt.
    /// start: "given", "spanning-tree", "chordal", or "auto", which takes the best of them.
    /// huber: Mahalanobis norm beyond which an edge pulls less.
    /// dcs: squared norm beyond which dynamic covariance scaling switches an edge off.
    /// tolerance: it stops if less than this share of χ² is estimated to be left to win.
    ///
    /// Raises OptimizeError if the equations cannot be solved; the poses stay.
    #[pyo3(signature = (*, method="gn", start="auto", huber=None, dcs=None, max_iterations=100.0, tolerance=1e-8),
        text_signature = "($self, *, method='gn', start='auto', huber=None, dcs=None, max_iterations=100, tolerance=1e-8)")]
    // The keywords of Python.
    #[expect(clippy::too_many_arguments)]
    fn optimize(
        &self,
        py: Python<'_>,
        method: &str,
        start: &str,
        huber: Option<f64>,
        dcs: Option<f64>,
        max_iterations: f64,
        tolerance: f64,
    ) -> PyResult<OptimizeReport> {
        let found = STARTS.iter().find(|(name, _)| *name == start);
        let (_, start) = found.ok_or_else(|| no_choice("start", start, &STARTS.map(|s| s.0)))?;
        let kernel = match (huber, dcs) {
            (None, None) => RobustKernel::None,
            (Some(width), None) => RobustKernel::Huber {
                width: within("huber", width, 1e-9, 1e9, "")?,
            },
            (None, Some(phi)) => RobustKernel::Dcs {
                phi: within("dcs", phi, 1e-9, 1e9, "")?,
            },
            (Some(_), Some(_)) => {
                return Err(ChoiceError::new_err("huber and dcs exclude each other"));
            }
        };
        let settings = Settings {
            method: match method {
                "gn" => Method::GaussNewton,
                "lm" => Method::LevenbergMarquardt {
                    initial_damping: INITIAL_DAMPING,
                },
                _ => return Err(no_choice("method", method, &["gn", "lm"])),
            },
            jacobians: JacobianModel::Exact,
            kernel,
            max_iterations: count("max_iterations", max_iterations)?,
            step_tolerance: STEP_TOLERANCE,
            decrease_tolerance: within("tolerance", tolerance, 0.0, 1.0, "")?,
            ..Settings::default()
        };
        py.detach(|| {
            let mut graph = self.lock();
            check_tied(&graph.problem)?;
            let chi2_initial = graph.problem.chi2();
            let mut solved = graph.problem.clone();
            let mut optimizer = Optimizer::new(settings);
            let mut session =
                SolveSession::new(&mut optimizer, &mut solved, *start).map_err(py_error)?;
            let mut listener = Listener::default();
            while session.step() {
                listener.listen()?;
            }
            let outcome = session.finish();
            if let StopReason::Failed { error } = outcome.report.stop {
                return Err(py_error(error));
            }
            if !outcome.report.chi2.is_finite() {
                return Err(py_error(pr_optim::OptimizeError::NotFinite));
            }
            graph.problem = solved;
            Ok(OptimizeReport {
                chi2_initial,
                chi2: outcome.report.chi2,
                cost: outcome.report.cost,
                iterations: outcome.total_iterations,
                start: match outcome.start {
                    Start::Auto => "auto",
                    Start::Given => "given",
                    Start::SpanningTree => "spanning-tree",
                    Start::Chordal => "chordal",
                    Start::LeastSquares => "least-squares",
                }
                .to_owned(),
                converged: outcome.report.stop.is_converged(),
                stop: outcome.report.stop.to_string(),
            })
        })
    }

    /// Covariance of every pose against the fixed ones at the present poses, shape (n, 3, 3), zero for those.
    ///
    /// Of perturbations on the right of the pose, order x, y, θ: m², m·rad, rad². It is exact to first order.
    /// Raises OptimizeError if the measurements leave a pose free.
    fn marginals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let covariances = py.detach(|| {
            let marginals = Optimizer::default().marginals(&self.tied()?);
            marginals.map_err(py_error)
        });
        arrays::of_matrices(py, &covariances?)
    }

    /// Covariance of the relative pose Tᵢ⁻¹ Tⱼ as all edges together know it, shape (3, 3).
    ///
    /// Raises NumberError for a node that does not exist, OptimizeError if the measurements leave a pose free.
    fn relative_covariance<'py>(
        &self,
        py: Python<'py>,
        i: f64,
        j: f64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let covariance = py.detach(|| {
            let (i, j) = {
                let graph = self.lock();
                (graph.node(i)?, graph.node(j)?)
            };
            let problem = self.tied()?;
            let joint = Optimizer::default().joint_covariance(&problem, i, j);
            let poses = problem.poses();
            Ok::<_, PyErr>(joint.map_err(py_error)?.relative(&poses[i], &poses[j]))
        });
        arrays::of_matrix(py, &covariance?)
    }

    /// Which edges are inliers if each loop may be false, shape (edges,), bool: loops along the path, then graduated
    /// non-convexity. Edges between neighbours in time always are.
    ///
    /// Raises OptimizeError if no start leads to equations that can be solved.
    fn inlier_edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let selection = py.detach(|| {
            let problem = self.tied()?;
            let trusted: Vec<bool> = problem.factors().iter().map(is_sequential).collect();
            let solver = Settings {
                jacobians: JacobianModel::Exact,
                ..Settings::default()
            };
            select_inliers(&problem, &trusted, solver, &GncSettings::default()).map_err(py_error)
        });
        Ok(PyArray1::from_vec(py, selection?.inliers))
    }

    /// The same graph with only those edges that `keep` marks, shape (edges,).
    fn with_edges(&self, keep: Vec<bool>) -> PyResult<Self> {
        let Graph { problem, ids } = self.lock().clone();
        let edges = problem.factors().len();
        if keep.len() != edges {
            return Err(ArrayError::new_err(format!(
                "keep has to have the shape ({edges},), not ({},)",
                keep.len()
            )));
        }
        let problem = pr_optim::robust::with_factors(&problem, |edge| keep[edge]);
        Ok(Self {
            inner: Mutex::new(Graph { problem, ids }),
        })
    }

    /// The poses world_from_body, shape (n, 3): x and y in m, θ in rad.
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::of_poses(py, self.lock().problem.poses().iter().copied())
    }

    /// Moves all nodes, for an initial guess: shape (n, 3).
    #[setter]
    fn set_poses(&self, poses: &Bound<'_, PyAny>) -> PyResult<()> {
        let poses = arrays::poses("poses", poses)?;
        let mut graph = self.lock();
        let count = graph.problem.node_count();
        if poses.len() != count {
            return Err(ArrayError::new_err(format!(
                "poses has to have the shape ({count}, 3), not ({}, 3)",
                poses.len()
            )));
        }
        graph.problem.poses_mut().copy_from_slice(&poses);
        Ok(())
    }

    /// The nodes' ids in the file, shape (n,); without a file their numbers.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_vec(py, self.lock().ids.clone())
    }

    /// The ends of the edges, shape (edges, 2): numbers of nodes.
    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let graph = self.lock();
        let edges = graph.problem.factors();
        let ends = edges
            .iter()
            .flat_map(|edge| [edge.from as i64, edge.to as i64]);
        PyArray1::from_vec(py, ends.collect()).reshape([edges.len(), 2])
    }

    /// The measured motions of the edges, shape (edges, 3): m, m, rad.
    #[getter]
    fn measurements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let graph = self.lock();
        let edges = graph.problem.factors().iter();
        arrays::of_poses(py, edges.map(|edge| edge.measurement))
    }

    /// The information matrices of the edges, shape (edges, 3, 3).
    #[getter]
    fn informations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let graph = self.lock();
        let edges = graph.problem.factors().iter();
        let matrices: Vec<_> = edges.map(|edge| edge.information).collect();
        arrays::of_matrices(py, &matrices)
    }

    /// χ² = Σ eᵀΩe at the present poses: no kernel, no factor ½.
    #[getter]
    fn chi2(&self) -> f64 {
        self.lock().problem.chi2()
    }

    /// eᵀΩe of every edge, shape (edges,).
    #[getter]
    fn edge_chi2<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let graph = self.lock();
        let edges = 0..graph.problem.factors().len();
        let chi2 = edges.map(|edge| graph.problem.factor_chi2(edge));
        PyArray1::from_vec(py, chi2.collect())
    }

    /// Number of nodes.
    fn __len__(&self) -> usize {
        self.lock().problem.node_count()
    }

    fn __repr__(&self) -> String {
        let graph = self.lock();
        format!(
            "PoseGraph({} nodes, {} edges, chi2={:.6})",
            graph.problem.node_count(),
            graph.problem.factors().len(),
            graph.problem.chi2()
        )
    }
}

/// The threshold that the squared innovation of a right loop lies below with this probability: χ² of three degrees of
/// freedom.
///
/// quantile: 1e-6 to 0.999999; the chapter's gate, 7.815, is that of 0.95.
#[pyfunction]
#[pyo3(signature = (quantile=0.95))]
pub fn chi2_gate(quantile: f64) -> PyResult<f64> {
    Ok(quantile3(within(
        "quantile", quantile, 1e-6, 0.999_999, "",
    )?))
}
